// The report of the draw-call reproduction: tables, charts along the walks, levels from above with their
// cells.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <system_error>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "workbench/io/text_file.hpp"
#include "workbench/measure/machine.hpp"
#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/report/assets.hpp"
#include "workbench/report/canvas.hpp"
#include "workbench/report/page.hpp"
#include "workbench/reproduce/draw_calls.hpp"

namespace sightline::reproduce {

namespace {

using report::Canvas;
using report::Colour;
using report::escape;

constexpr const char* kChartCode = R"(
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
const palette = ["#7f8791", "#1f77c8", "#e09a22", "#2a9d6e", "#b04fc0", "#d9553f", "#18a0b0", "#8a6d3b"];
for (const chart of JSON.parse(document.getElementById("data").textContent)) {
  new Chart(document.getElementById(chart.id), {
    type: "line",
    data: { labels: chart.views, datasets: chart.series.map((s, i) => ({
      label: s.name, data: s.fps, borderColor: palette[i % palette.length], backgroundColor: palette[i % palette.length],
      borderWidth: 1.75, pointRadius: chart.views.length < 8 ? 3 : 0, tension: 0.15 })) },
    options: { interaction: { mode: "index", intersect: false },
      plugins: { legend: { position: "bottom", labels: { boxWidth: 22, boxHeight: 2 } } },
      scales: { x: { title: { display: true, text: "view along the walk" }, grid: { display: false } },
                y: { title: { display: true, text: "frames per second" }, beginAtZero: true } } } });
})";

constexpr const char* kStyle = R"(
main > h3 { margin: 1.6rem 0 .6rem; }
th, td { padding: .4rem .55rem; } table { font-size: .86rem; }
table.numbers th:nth-child(2), table.numbers td:nth-child(2) { text-align: right; }
.verdict ul { margin: 0; padding: 0 0 0 1.1rem; } .verdict li + li { margin-top: .45rem; }
)";

std::string as_list(const std::string& sentences) {
  std::string out = "<ul>";
  for (std::size_t at = 0; at < sentences.size();) {
    const std::size_t end = std::min(sentences.find('\n', at), sentences.size());
    out += "<li>" + report::escape(sentences.substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return out + "</ul>";
}

// Every structure × variant at the height that was best for it, and what goes beyond them.
nlohmann::ordered_json chart_data(const LevelWalk& walk, const std::string& id) {
  nlohmann::ordered_json chart{{"id", id}, {"views", nlohmann::ordered_json::array()}, {"series", {}}};
  for (std::size_t v = 0; v < walk.views; ++v) chart["views"].push_back(v);
  const auto add = [&](const WalkRow& row) {
    nlohmann::ordered_json fps = nlohmann::ordered_json::array();
    for (const double ms : row.frame_ms_by_view) fps.push_back(ms > 0 ? std::round(10000 / ms) / 10 : 0);
    chart["series"].push_back({{"name", row.method}, {"fps", std::move(fps)}});
  };
  add(walk.row("none"));
  for (const char* name :
       {"simple-octree?height=4", "drawcall-wise-octree?height=4", "drawcall-wise-kd-tree?height=4",
        "zhang-octree?height=4", "cluster-cone?submission=merged", "adaptive"}) {
    add(walk.row(name));
  }
  return chart;
}

// x to the right, z down: cells outlined, the walk on top.
void draw_top_view(const Scene& scene, const LevelWalk& walk, partition::Structure structure,
                   const std::filesystem::path& file) {
  methods::DrawCallPlan plan;
  plan.structure = structure;
  const methods::DrawCallMethod method(scene, plan);
  const Box all = extent(scene);
  constexpr float kWidth = 1400, kMargin = 20;
  const float scale = (kWidth - 2 * kMargin) / std::max(all.max.x - all.min.x, all.max.z - all.min.z);
  const auto x = [&](float at) { return kMargin + (at - all.min.x) * scale; };
  const auto z = [&](float at) { return kMargin + (at - all.min.z) * scale; };
  report::Canvas canvas(static_cast<std::uint32_t>(x(all.max.x) + kMargin),
                        static_cast<std::uint32_t>(z(all.max.z) + kMargin));
  canvas.fill_rectangle(0, 0, static_cast<float>(canvas.width()), static_cast<float>(canvas.height()),
                        {250, 250, 248});
  for (std::size_t object = 0; object < scene.size(); ++object) {
    const Box b = scene.bounds[object];
    canvas.fill_rectangle(x(b.min.x), z(b.min.z), x(b.max.x), z(b.max.z), {90, 110, 130, 18});
  }
  for (const Box& cell : method.cells())
    canvas.outline_rectangle(x(cell.min.x), z(cell.min.z), x(cell.max.x), z(cell.max.z), 2,
                             {31, 119, 200, 110});
  const auto& cameras = walk.path.cameras;
  for (std::size_t c = 1; c < cameras.size(); ++c) {
    canvas.line(x(cameras[c - 1].eye.x), z(cameras[c - 1].eye.z), x(cameras[c].eye.x), z(cameras[c].eye.z), 4,
                {217, 85, 63});
  }
  for (const Camera& camera : cameras) canvas.disc(x(camera.eye.x), z(camera.eye.z), 7, {217, 85, 63});
  canvas.halved().write_png(file);
}

}  // namespace

void write_draw_call_report(const std::filesystem::path& folder, const std::string& device,
                            const CallGrid& grid, const std::vector<LevelWalk>& walks) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error(folder.string() + ": no folder for the report could be made there: " + failed.message());
  const measure::Machine machine = measure::this_machine();
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Draw calls – Sightline</title>\n<style>\n";
  page.append(report::kPageStyle)
      .append(kStyle)
      .append("</style></head>\n<body><main>\n<header><h1>Culling that counts draw calls</h1>");
  page += fmt::format(
      "<p>Serpa, Serpa &amp; Rodrigues, measured again on {} ({}, {} hardware threads)</p></header>\n",
      report::escape(device), report::escape(machine.cpu), machine.cores);
  page += "<h2>Table 1: triangles × draw calls</h2>\n" + report::html(table_of(grid));
  page += "<div class=\"verdict\">" + as_list(findings(grid)) + "</div>\n";
  nlohmann::ordered_json data = nlohmann::ordered_json::array();
  constexpr std::array kNames{"grid", "octree", "kd-tree"};
  for (std::size_t w = 0; w < walks.size(); ++w) {
    const LevelWalk& walk = walks[w];
    const std::string id = "walk-" + std::to_string(w + 1);
    page += fmt::format("<h2>{}</h2>\n<p>{}, {} triangles, {} views.</p>\n", report::escape(walk.level),
                        report::escape(walk.kind), report::format_count(static_cast<double>(walk.triangles)),
                        walk.views);
    page += "<div class=\"verdict\">" + as_list(findings(walk)) + "</div>\n";
    page += "<h3>Frames per second along the walk</h3>\n<figure><div class=\"chart\"><canvas id=\"" + id +
            "\" role=\"img\" aria-label=\"Frames per second along the walk\"></canvas></div></figure>\n";
    page += "<h3>Every structure, variant and height</h3>\n" + report::html(heights_table(walk)) +
            "<h3>simple against drawcall-wise</h3>\n" + report::html(calls_table(walk)) +
            "<h3>Methods, each at its best height</h3>\n" + report::html(methods_table(walk)) +
            "<h3>Three ways of submission</h3>\n" + report::html(submission_table(walk));
    page += "<h3>From above, with the cells at height 4</h3>\n<div class=\"outcomes\">\n";
    const Scene scene = load_scene(walk.level);
    for (std::size_t s = 0; s < kNames.size(); ++s) {
      const std::string file = id + "-" + kNames[s] + ".png";
      draw_top_view(scene, walk, static_cast<partition::Structure>(s), folder / file);
      page += fmt::format(
          "<figure><h3>{0}</h3><img src=\"{1}\" alt=\"The level from above with the cells of the {0}\">"
          "</figure>\n",
          kNames[s], file);
    }
    page += "</div>\n";
    data.push_back(chart_data(walk, id));
  }
  page +=
      "<footer><p>Frame times are means over the views of medians; methods take turns in one process, back "
      "faces culled for all. Lost pixels: "
      "rays through pixel centres meet a triangle that was not submitted. Ratios within one run are the "
      "result; absolute times belong to the machine "
      "above.</p></footer>\n</main>\n";
  page += "<script type=\"application/json\" id=\"data\">";
  for (const char c : data.dump()) page += c == '<' ? std::string("\\u003c") : std::string(1, c);
  page.append("</script>\n<script>\n").append(report::kChartScript).append("\n</script>\n<script>\n");
  page.append(kChartCode).append("</script></body></html>\n");
  io::write_file(folder / "index.html", page);
}

}  // namespace sightline::reproduce
