// The page of `reproduce vertex-chunk`: tables, figure 7 as charts, pictures.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include <sightline/workbench/error.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/report/assets.hpp"
#include "workbench/report/page.hpp"
#include "workbench/reproduce/vertex_chunk.hpp"

namespace sightline::reproduce {

namespace {

std::string chart(const VertexChunkWorld& world) {
  using Json = nlohmann::ordered_json;
  static constexpr std::array kColours{"#888888", "#e69f00", "#cc79a7", "#009e73",
                                       "#0072b2", "#d55e00", "#56b4e9"};
  Json data{{"labels", Json::array()}, {"datasets", Json::array()}};
  for (std::size_t i = 0; i < world.rising.cameras.size(); ++i) data["labels"].push_back(i + 1);
  for (std::size_t m = 0; m < world.rising.methods.size(); ++m) {
    const std::string& method = world.rising.methods[m];
    Json points = Json::array();
    for (const measure::Row& row : world.rising.rows) {
      if (row.method == method) points.push_back(row.frame->median > 0 ? 1000 / row.frame->median : 0);
    }
    data["datasets"].push_back(
        {{"label", method}, {"data", points}, {"borderColor", kColours[m % kColours.size()]}});
  }
  Json axes{{"x", {{"title", {{"display", true}, {"text", "scene number, the camera rising"}}}}},
            {"y", {{"type", "logarithmic"}, {"title", {{"display", true}, {"text", "frames/s"}}}}}};
  Json config{{"type", "line"}, {"data", data}, {"options", {{"scales", axes}, {"animation", false}}}};
  return fmt::format(
      "<canvas id=\"rising-{0}\"></canvas><script>new Chart(document.getElementById('rising-{0}'), "
      "{1});</script>\n",
      world.name, config.dump());
}

}  // namespace

void write_vertex_chunk_report(const std::string& folder, std::span<const VertexChunkWorld> worlds) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(fmt::format("{}: the folder cannot be made", folder));
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Vertex chunks</title><style>";
  page += report::kPageStyle;
  page += "</style><script>";
  page += report::kChartScript;
  page +=
      "</script><body><main><h1>Vertex chunks: Lee &amp; Shin 2023</h1>\n"
      "<p>Each cell: ours (its ratio to vertex-chunk / the published ratio).</p>\n";
  for (const VertexChunkWorld& world : worlds) {
    page += fmt::format("<h2>World: {}; {} objects on {}</h2>\n", world.name,
                        world.near.rows.front().stats.objects, report::escape(world.near.device));
    for (const report::Table& table : world.tables) page += report::html(table);
    page += "<h3>Figure 7</h3>\n" + chart(world) + report::html(world.rising_fps);
    for (const auto& picture : world.pictures) {
      save_png(picture.pixels, (std::filesystem::path(folder) / picture.file).string());
      page += fmt::format(
          "<figure><img src=\"{}\" alt=\"\" style=\"max-width:100%\"><figcaption>{}</figcaption></figure>\n",
          picture.file, report::escape(picture.caption));
    }
  }
  io::write_file(std::filesystem::path(folder) / "index.html", page + "</main></body></html>\n");
}

}  // namespace sightline::reproduce
