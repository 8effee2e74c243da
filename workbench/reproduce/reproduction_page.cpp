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
#include "workbench/report/page_folder.hpp"
#include "workbench/reproduce/page_files.hpp"
#include "workbench/reproduce/published.hpp"
#include "workbench/reproduce/reproduction.hpp"

namespace sightline::reproduce {

namespace {

using Json = nlohmann::ordered_json;
using report::escape;

std::string as_list(const std::vector<std::string>& sentences) {
  std::string out = "<ul>";
  for (const std::string& sentence : sentences) out += "<li>" + escape(sentence) + "</li>";
  return out + "</ul>";
}

std::string note_html(const std::string& note) {
  return note.empty() ? "" : fmt::format("<p class=\"note\">{}</p>\n", escape(note));
}

// What tells the row from the others.
std::string row_label(const PaperTable& table, std::size_t row) {
  std::string out;
  for (std::size_t k = 0; k < table.keys.size(); ++k) {
    const std::string& key = table.rows[row].keys[k];
    const bool alike =
        std::ranges::all_of(table.rows, [&](const auto& other) { return other.keys[k] == key; });
    if (!alike && !key.empty()) out.append(out.empty() ? "" : ", ").append(key);
  }
  return out;
}

// Ratios where the table has a base, else what is printed; published and ours side by side. Columns of ours
// alone stand in the table, unless there are no others.
std::string table_chart(const PaperTable& table, const std::string& id) {
  if (!table.charted) return "";
  const bool ratios = table.base != PaperTable::Base::none;
  std::string out;
  Chart made;
  made.bars = true;
  made.y = ratios ? "ratio" : "";
  bool compared = false;
  for (std::size_t c = 0; c < table.columns.size(); ++c) compared = compared || table.has_published(c);
  double least = 1e300, most = 0;
  bool negative = false;
  Series published{"published", {}}, ours{"ours", {}};
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if ((ratios && !table.has_ratios(c)) || (compared && !table.has_published(c))) continue;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const Cell& cell = table.rows[r].cells[c];
      const auto theirs = ratios ? table.published_ratio(r, c) : number_of(cell.published);
      const auto mine = ratios ? table.our_ratio(r, c) : cell.ours;
      if (!theirs && !mine) continue;
      std::string label = row_label(table, r);
      if (table.columns.size() > 1) label.append(": ").append(table.columns[c]);
      made.labels.push_back(std::move(label));
      published.values.push_back(theirs.value_or(0));
      ours.values.push_back(mine.value_or(0));
      for (const double value : {published.values.back(), ours.values.back()}) {
        if (value > 0) least = std::min(least, value), most = std::max(most, value);
        negative = negative || value < 0;
      }
    }
  }
  if (made.labels.empty()) return "";
  made.id = id;
  made.logarithmic = most > 30 * least && !negative;
  // What is ours alone stands without the paper's empty side.
  if (std::ranges::any_of(published.values, [](double value) { return value != 0; }))
    made.series.push_back(std::move(published));
  made.series.push_back(std::move(ours));
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
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">{}<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>{}</title>\n<style>",
      report::kPageMark, escape(reproduction.title));
  page.append(report::kPageStyle)
      .append(kReproductionStyle)
      .append("</style></head>\n<body><main><header><h1>");
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
  page.append(report::kSharedScript).append(kReproductionScript).append("</script></body></html>\n");
  io::write_file(std::filesystem::path(folder) / "index.html", page);
}

}  // namespace sightline::reproduce
