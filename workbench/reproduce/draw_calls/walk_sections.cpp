// Figures 8 to 10: the walks through the levels.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"
#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {

namespace {

std::vector<std::string> families() {
  std::vector<std::string> out;
  for (const auto structure : kWalkStructures) {
    for (const auto variant : kWalkVariants) out.push_back(fmt::format("{}-{}", variant, structure));
  }
  return out;
}

const std::string& said(std::string_view what) {
  return published("draw_calls_text").text({{"what", what}}, "value");
}

/// The paper's best height of a family, and the scene where it is another.
std::string published_height(std::string_view family) {
  std::string best = said("best height over all scenes");
  if (family.ends_with("octree")) best += fmt::format(" (Coaltown {})", said("best height octree Coaltown"));
  if (family == "zhang-grid")
    best += fmt::format(" (Coldfront {})", said("best height zhang grid Coldfront"));
  return best;
}

}  // namespace

std::string short_level(const LevelWalk& walk) {
  const std::string file = walk.level.substr(walk.level.find_last_of("/:") + 1);
  return file.substr(0, file.find('.'));
}

PaperSection figure_8(const LevelWalks& walks) {
  PaperSection section{"figure 8", "frames/s by structure and height", {}, {}, {}};
  for (const LevelWalk& walk : walks) {
    const std::string level = short_level(walk);
    report::Table table;
    Chart lines{"figure-8-" + level, "height, " + level, "frames/s", {}, {}};
    table.header = {"mean fps, " + level};
    for (std::uint32_t height = 1; height <= kHighest; ++height) {
      table.header.push_back(fmt::format("height {}", height));
      lines.labels.push_back(std::to_string(height));
    }
    table.header.insert(table.header.end(), {"best", "published best"});
    for (const std::string& family : families()) {
      std::vector<std::string> line{family};
      Series series{family, {}};
      for (std::uint32_t height = 1; height <= kHighest; ++height) {
        series.values.push_back(walk.row(fmt::format("{}?height={}", family, height)).fps());
        line.push_back(fmt::format("{:.0f}", series.values.back()));
      }
      line.push_back(std::to_string(walk.best_height(family)));
      line.push_back(published_height(family));
      table.rows.push_back(std::move(line));
      lines.series.push_back(std::move(series));
    }
    section.html += chart(lines);
    section.tables.push_back(std::move(table));
  }
  section.note =
      "Means over the views of each walk. The paper's bars are not printed as numbers; its best heights are.";
  return section;
}

PaperSection figure_9(const LevelWalks& walks) {
  PaperSection section{"figure 9", "frames/s and triangles, the best method and none", {}, {}, {}};
  report::Table table;
  table.header = {"level", "best", "fps", "none: fps", "ratio", "triangles", "none: triangles", "share"};
  table.text_columns = 2;
  Chart rates{"figure-9-fps", "", "frames/s", {}, {{"best", {}}, {"none", {}}}, true};
  Chart triangles{"figure-9-triangles", "", "triangles a frame", {}, {{"best", {}}, {"none", {}}}, true};
  for (const LevelWalk& walk : walks) {
    const WalkRow &best = walk.best_of_the_paper(), &none = walk.row("none");
    for (Chart* bars : {&rates, &triangles})
      bars->labels.push_back(fmt::format("{}: {}", short_level(walk), best.method));
    rates.series[0].values.push_back(best.fps()), rates.series[1].values.push_back(none.fps());
    triangles.series[0].values.push_back(best.triangles),
        triangles.series[1].values.push_back(none.triangles);
    table.rows.push_back({short_level(walk), best.method, fmt::format("{:.0f}", best.fps()),
                          fmt::format("{:.0f}", none.fps()), report::format_ratio(best.fps(), none.fps(), 2),
                          report::format_count(std::round(best.triangles)),
                          report::format_count(std::round(none.triangles)),
                          report::format_ratio(best.triangles, none.triangles, 3)});
  }
  if (!walks.empty()) section.html = chart(rates) + chart(triangles);
  section.tables.push_back(std::move(table));
  section.note = "The best of the nine families at its best height, by the frames of the walk.";
  return section;
}

PaperSection figure_10(const LevelWalks& walks) {
  PaperSection section{
      "figure 10", "frames/s along the walks, all nine families at their best height", {}, {}, {}};
  for (const LevelWalk& walk : walks) {
    const std::string level = short_level(walk);
    Chart lines{"figure-10-" + level,
                fmt::format("view along the walk, {}; the full turn is the first {}", level, walk.turn),
                "frames/s",
                {},
                {}};
    for (std::size_t v = 0; v < walk.path.cameras.size(); ++v) lines.labels.push_back(std::to_string(v + 1));
    report::Table table;
    table.header = {level, "fps, mean", "turn", "walk", "least", "most"};
    for (const WalkLine& line : walk.lines) {
      const auto mean = [&](std::size_t first, std::size_t end) {
        const auto from = line.fps.begin() + static_cast<std::ptrdiff_t>(first),
                   to = line.fps.begin() + static_cast<std::ptrdiff_t>(end);
        return fmt::format("{:.0f}", std::accumulate(from, to, 0.0) / static_cast<double>(end - first));
      };
      const auto [least, most] = std::ranges::minmax(line.fps);
      table.rows.push_back({line.method, mean(0, line.fps.size()), mean(0, walk.turn),
                            mean(walk.turn, line.fps.size()), fmt::format("{:.0f}", least),
                            fmt::format("{:.0f}", most)});
      lines.series.push_back({line.method, line.fps});
    }
    section.html += chart(lines);
    section.tables.push_back(std::move(table));
  }
  section.note =
      "The paper's curves are not printed as numbers. As on Coldfront, each walk begins with a full turn on "
      "the "
      "spot.";
  return section;
}

}  // namespace sightline::reproduce
