// The page of a reproduction: three sentences, a chart a table with published and ours as ratios side by
// side, the table itself folded beneath, and the paper's figures.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include <sightline/workbench/error.hpp>

#include "workbench/io/text_file.hpp"
#include "workbench/report/assets.hpp"
#include "workbench/report/page.hpp"
#include "workbench/reproduce/published.hpp"
#include "workbench/reproduce/reproduction.hpp"

namespace sightline::reproduce {

namespace {

using Json = nlohmann::ordered_json;
using report::escape;

constexpr const char* kStyle = R"(
main > h3 { margin: 1.6rem 0 .6rem; }
th, td { padding: .35rem .5rem; white-space: normal; } table { font-size: .84rem; }
.verdict ul { margin: 0; padding: 0 0 0 1.1rem; } .verdict li + li { margin-top: .45rem; }
details { margin: .75rem 0 0; } summary { cursor: pointer; color: var(--accent); }
details .wide { margin-top: .6rem; }
p.note { max-width: 78ch; color: var(--quiet); }
figure + figure, .wide + .wide, .wide + figure { margin-top: 1.25rem; }
.slider { position: relative; } .slider img { width: 100%; }
.slider img + img { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--at, 50%)); }
.slider input { width: 100%; margin: .6rem 0 0; }
)";

constexpr const char* kScript = R"js(
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
const dark = matchMedia("(prefers-color-scheme: dark)").matches;
Chart.defaults.color = dark ? "#9aa3af" : "#5d6673";
Chart.defaults.borderColor = dark ? "#2d333b" : "#e2e4e8";
const palette = ["#7f8791", "#1f77c8", "#e09a22", "#2a9d6e", "#b04fc0", "#d9553f", "#18a0b0", "#8a6d3b", "#c2557f",
                 "#5b6bd0"];
for (const canvas of document.querySelectorAll("canvas[data-chart]")) {
  const chart = JSON.parse(canvas.dataset.chart);
  new Chart(canvas, {
    type: chart.bars ? "bar" : "line",
    data: {
      labels: chart.labels,
      datasets: chart.series.map((s, i) => ({
        label: s.name, data: s.values, borderColor: palette[i % palette.length],
        backgroundColor: palette[i % palette.length], borderWidth: chart.bars ? 0 : 1.75,
        pointRadius: chart.labels.length < 15 ? 3 : 0, tension: 0.15
      }))
    },
    options: {
      interaction: {mode: "index", intersect: false},
      plugins: {legend: {position: "bottom", labels: {boxWidth: 22, boxHeight: chart.bars ? 10 : 2}}},
      scales: {
        x: {title: {display: chart.x !== "", text: chart.x}, grid: {display: false}},
        y: {
          type: chart.logarithmic ? "logarithmic" : "linear", beginAtZero: !chart.logarithmic,
          title: {display: true, text: chart.y}
        }
      }
    }
  });
}
for (const slider of document.querySelectorAll(".slider input"))
  slider.addEventListener("input", () => slider.parentElement.style.setProperty("--at", slider.value + "%"));
)js";

std::string as_list(const std::vector<std::string>& sentences) {
  std::string out = "<ul>";
  for (const std::string& sentence : sentences) out += "<li>" + escape(sentence) + "</li>";
  return out + "</ul>";
}

std::string note_html(const std::string& note) {
  return note.empty() ? "" : "<p class=\"note\">" + escape(note) + "</p>\n";
}

std::string joined(const std::vector<std::string>& keys) {
  std::string out;
  for (const std::string& key : keys) {
    if (!key.empty()) out += (out.empty() ? "" : ", ") + key;
  }
  return out;
}

// Ratios where the table has a base, else what is printed; published and ours side by side.
std::string table_chart(const PaperTable& table, const std::string& id) {
  const bool ratios = table.base != PaperTable::Base::none;
  std::string out;
  Chart made;
  made.bars = true;
  made.y = ratios ? "ratio" : "";
  double least = 1e300, most = 0;
  Series published{"published", {}}, ours{"ours", {}};
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const Cell& cell = table.rows[r].cells[c];
      const auto theirs = ratios ? table.published_ratio(r, c) : number_of(cell.published);
      const auto mine = ratios ? table.our_ratio(r, c) : cell.ours;
      if (!theirs && !mine) continue;
      made.labels.push_back(joined(table.rows[r].keys) +
                            (table.columns.size() > 1 ? ": " + table.columns[c] : ""));
      published.values.push_back(theirs.value_or(0));
      ours.values.push_back(mine.value_or(0));
      for (const double value : {published.values.back(), ours.values.back()}) {
        if (value > 0) least = std::min(least, value), most = std::max(most, value);
      }
    }
  }
  if (made.labels.empty()) return "";
  made.id = id;
  made.logarithmic = most > 30 * least;
  made.series = {std::move(published), std::move(ours)};
  return chart(made);
}

}  // namespace

std::string chart(const Chart& chart) {
  Json data{
      {"labels", chart.labels},           {"x", chart.x},           {"y", chart.y}, {"bars", chart.bars},
      {"logarithmic", chart.logarithmic}, {"series", Json::array()}};
  for (const Series& series : chart.series)
    data["series"].push_back({{"name", series.name}, {"values", series.values}});
  return fmt::format(
      "<figure><div class=\"chart\"><canvas id=\"{}\" data-chart=\"{}\"></canvas></div></figure>\n",
      escape(chart.id), escape(data.dump()));
}

std::string picture(const std::string& file, const std::string& caption) {
  return fmt::format(
      "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"></a><figcaption>{1}</figcaption></figure>\n",
      escape(file), escape(caption));
}

std::string before_after(const std::string& before, const std::string& after, const std::string& caption) {
  return fmt::format(
      "<figure><div class=\"slider\"><img src=\"{0}\" alt=\"before\"><img src=\"{1}\" alt=\"after\"><input "
      "type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"before and "
      "after\"></div><figcaption>{2}</figcaption></figure>\n",
      escape(before), escape(after), escape(caption));
}

void write_reproduction(const std::string& folder, const Reproduction& reproduction) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(fmt::format("{}: the folder cannot be made", folder));
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>{}</title>\n<style>",
      escape(reproduction.title));
  page.append(report::kPageStyle).append(kStyle).append("</style></head>\n<body><main><header><h1>");
  page += escape(reproduction.title) + "</h1><p>" + escape(reproduction.machine) +
          "</p></header>\n<section class=\"verdict\">" + as_list(reproduction.sentences) + "</section>\n";
  for (std::size_t t = 0; t < reproduction.tables.size(); ++t) {
    const PaperTable& table = reproduction.tables[t];
    page += fmt::format("<h2>{}: {}</h2>\n", escape(table.name), escape(table.title));
    page += table_chart(table, fmt::format("table-{}", t)) + note_html(table.note);
    page += "<details><summary>The figures</summary>" + report::html(text_table(table)) + "</details>\n";
  }
  for (const PaperSection& section : reproduction.sections) {
    page += fmt::format("<h2>{}: {}</h2>\n", escape(section.name), escape(section.title));
    page += section.html + note_html(section.note);
    for (const report::Table& table : section.tables)
      page += "<details><summary>The figures</summary>" + report::html(table) + "</details>\n";
  }
  page.append("</main>\n<script>").append(report::kChartScript).append("</script>\n<script>");
  page.append(kScript).append("</script></body></html>\n");
  io::write_file(std::filesystem::path(folder) / "index.html", page);
}

}  // namespace sightline::reproduce
