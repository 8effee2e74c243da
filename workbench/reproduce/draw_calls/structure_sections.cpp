// Calls: simple against drawcall-wise, as printed and by rules of ours; what occlusion and other planes
// leave; and what goes beyond the paper.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"

namespace sightline::reproduce {

namespace {

std::string whole_number(double value) {
  return report::format_count(std::round(value));
}

/// A structure's three variants at one height.
struct Rivals {
  const WalkRow &simple, &wise, &zhang;

  Rivals(const LevelWalk& walk, std::string_view structure, std::uint32_t height)
      : simple(walk.row(fmt::format("simple-{}?height={}", structure, height))),
        wise(walk.row(fmt::format("drawcall-wise-{}?height={}", structure, height))),
        zhang(walk.row(fmt::format("zhang-{}?height={}", structure, height))) {}

  [[nodiscard]] double calls() const { return simple.draw_calls / std::max(1.0, wise.draw_calls); }
  [[nodiscard]] double frames() const { return simple.frame_ms / wise.frame_ms; }
  [[nodiscard]] double small_frames() const { return simple.small_frame_ms / wise.small_frame_ms; }
  /// The frames' ratio were drawcall-wise's calls free. Both draw the same triangles cell by cell, so what
  /// their frames differ by is what simple's further calls cost.
  [[nodiscard]] double limit() const {
    const double call =
        (simple.frame_ms - wise.frame_ms) / std::max(1.0, simple.draw_calls - wise.draw_calls);
    return simple.frame_ms / (wise.frame_ms - std::max(0.0, call) * wise.draw_calls);
  }
  [[nodiscard]] double recording() const { return simple.record_ms / wise.record_ms; }
  [[nodiscard]] double triangles() const { return zhang.triangles / wise.triangles; }
};

std::vector<std::string> method_line(const std::string& level, const WalkRow& row, double none_ms) {
  return {level,
          row.method,
          fmt::format("{:.0f}", row.fps()),
          report::format_ratio(none_ms, row.frame_ms, 2),
          report::format_ms(row.cull_ms),
          report::format_ms(row.record_ms),
          whole_number(row.draw_calls),
          whole_number(row.triangles),
          fmt::format("{:.1f}", static_cast<double>(row.bytes) / 1e6),
          report::format_count(static_cast<double>(row.lost_pixels)),
          row.final_ms > 0 ? fmt::format("{:.3f}", row.final_ms) : "–"};
}

/// Of a family by one rule of cells its quickest height, whoever was in the final, and what has no height.
bool is_shown(const LevelWalk& walk, const WalkRow& row) {
  const auto is_quicker = [&, tight = with_tight_cells("")](const WalkRow& other) {
    return other.family == row.family && other.frame_ms < row.frame_ms &&
           other.is_of_the_paper() == row.is_of_the_paper() &&
           other.method.ends_with(tight) == row.method.ends_with(tight);
  };
  const bool of_a_family = row.is_of_the_paper() || row.method.ends_with(with_tight_cells(""));
  return !of_a_family || row.final_ms > 0 || std::ranges::none_of(walk.rows, is_quicker);
}

}  // namespace

std::string range_text(const std::vector<double>& values, int digits) {
  if (values.empty()) return "–";
  const auto [least, most] = std::ranges::minmax(values);
  return fmt::format("{:.{}f} to {:.{}f}", least, digits, most, digits);
}

RivalRatios rival_ratios(const LevelWalks& walks, std::uint32_t height) {
  RivalRatios out;
  for (const LevelWalk& walk : walks) {
    for (const auto structure : kWalkStructures) {
      const Rivals rivals(walk, structure, height);
      out.calls.push_back(rivals.calls()), out.frames.push_back(rivals.frames());
      out.small_frames.push_back(rivals.small_frames()), out.recording.push_back(rivals.recording());
    }
  }
  return out;
}

PaperSection rivals_section(const LevelWalks& walks) {
  PaperSection section{
      "text: simple against drawcall-wise", "calls, recording and frames at every height", {}, {}, {}};
  report::Table table;
  table.text_columns = 2;
  table.header = {"level",
                  "structure",
                  "height",
                  "simple's calls",
                  "drawcall-wise's",
                  "calls",
                  "CPU",
                  "frame",
                  "were calls free",
                  fmt::format("frame at {}x{}", kSmallWidth, kSmallHeight),
                  "triangles zhang / wise"};
  for (const LevelWalk& walk : walks) {
    for (const auto structure : kWalkStructures) {
      for (std::uint32_t height = 1; height <= kHighest; ++height) {
        const Rivals r(walk, structure, height);
        table.rows.push_back({short_level(walk), std::string(structure), std::to_string(height),
                              whole_number(r.simple.draw_calls), whole_number(r.wise.draw_calls),
                              fmt::format("{:.1f}", r.calls()), fmt::format("{:.2f}", r.recording()),
                              fmt::format("{:.2f}", r.frames()), fmt::format("{:.2f}", r.limit()),
                              fmt::format("{:.2f}", r.small_frames()), fmt::format("{:.2f}", r.triangles())});
      }
    }
  }
  section.tables.push_back(std::move(table));
  section.note = "Ratios are simple / drawcall-wise unless the heading says otherwise.";
  return section;
}

PaperSection structures_section(const LevelWalks& walks) {
  PaperSection section{
      "text: structures", "cells, nodes and calls as printed and by rules of ours", {}, {}, {}};
  report::Table table;
  table.text_columns = 3;
  table.header = {"level",         "structure",      "rules",           "height", "cells possible", "made",
                  "nodes visited", "simple's calls", "drawcall-wise's", "ratio",  "triangles"};
  for (const LevelWalk& walk : walks) {
    Chart lines{"structures-" + short_level(walk),
                "height, " + short_level(walk),
                "calls, simple / drawcall-wise",
                {},
                {}};
    for (std::uint32_t height = 1; height <= kHighest; ++height)
      lines.labels.push_back(std::to_string(height));
    for (const StructureCount& one : walk.counts) {
      const std::string rules = one.rules == kPrintedCells ? "printed" : one.rules;
      table.rows.push_back({short_level(walk), one.structure, rules, std::to_string(one.height),
                            whole_number(one.possible), whole_number(one.made), whole_number(one.visited),
                            whole_number(one.simple_calls), whole_number(one.wise_calls),
                            fmt::format("{:.1f}", one.ratio()), whole_number(one.wise_triangles)});
      const std::string name = one.structure + ", " + rules;
      auto series = std::ranges::find(lines.series, name, &Series::name);
      if (series == lines.series.end()) series = lines.series.insert(series, {name, {}});
      series->values.push_back(one.ratio());
    }
    lines.logarithmic = true;
    section.html += chart(lines);
  }
  section.tables.push_back(std::move(table));
  section.note =
      "As printed every node is split to the height, and cells are regions, equal ones, those of a grid as "
      "high as the level. cells=tight takes the boxes around what shows in them; least=11 leaves a node "
      "whole where a split cannot gain what its calls may cost.";
  return section;
}

PaperSection future_work_section(const LevelWalks& walks) {
  PaperSection section{
      "text: future work", "occlusion after visible cells, and parts on other planes", {}, {}, {}};
  report::Table table;
  table.text_columns = 2;
  table.header = {"level",   "method",           "calls", "of those without", "triangles", "of those without",
                  "objects", "of those without", "fps",   "lost pixels"};
  std::vector<double> objects, triangles, calls;
  for (const LevelWalk& walk : walks) {
    for (const WalkRow& row : walk.rows) {
      const std::size_t more = std::min(row.method.find("&occlusion"), row.method.find("&planes"));
      if (more == std::string::npos) continue;
      const WalkRow& without = walk.row(row.method.substr(0, more));
      table.rows.push_back(
          {short_level(walk), row.method, whole_number(row.draw_calls),
           report::format_ratio(row.draw_calls, without.draw_calls, 2), whole_number(row.triangles),
           report::format_ratio(row.triangles, without.triangles, 2), whole_number(row.objects),
           report::format_ratio(row.objects, without.objects, 2), fmt::format("{:.0f}", row.fps()),
           report::format_count(static_cast<double>(row.lost_pixels))});
      if (row.method.find("&occlusion") == std::string::npos) continue;
      objects.push_back(row.objects / without.objects);
      calls.push_back(row.draw_calls / without.draw_calls);
      triangles.push_back(row.triangles / without.triangles);
    }
  }
  section.tables.push_back(std::move(table));
  section.note = fmt::format(
      "With occlusion=masked {} of the objects and {} of the triangles are left, in {} times the calls.",
      range_text(objects), range_text(triangles), range_text(calls));
  return section;
}

PaperSection beyond_section(const LevelWalks& walks) {
  PaperSection section{
      "beyond the paper", "submission, clusters, and a structure that picks itself", {}, {}, {}};
  report::Table table;
  table.text_columns = 2;
  table.header = {"level", "method",    "fps", "× none",      "cull ms", "record ms",
                  "calls", "triangles", "MB",  "lost pixels", "final ms"};
  for (const LevelWalk& walk : walks) {
    const double none_ms = walk.row("none").frame_ms;
    for (const WalkRow& row : walk.rows) {
      if (is_shown(walk, row)) table.rows.push_back(method_line(short_level(walk), row, none_ms));
    }
  }
  section.tables.push_back(std::move(table));
  section.note =
      "Of the nine families, as printed and with tight cells, those at their best height, and who was among "
      "the quickest; \"final\" is a run of many rounds among those.";
  return section;
}

PaperSection outcomes_section(const LevelWalks& walks) {
  PaperSection section{"beyond the paper, by level", "what was quickest, and what things cost", {}, {}, {}};
  report::Table table;
  table.text_columns = 3;
  table.header = {"level",
                  "quickest without occlusion",
                  "adaptive settled on",
                  "after frames",
                  "adaptive / quickest",
                  "triangles cluster-cone / zhang-octree, tight",
                  "pixels lost by the printed rule",
                  "views",
                  "µs a call",
                  "µs a command",
                  "ns a triangle"};
  for (const LevelWalk& walk : walks) {
    const WalkRow* adaptive = walk.find("adaptive");
    const double cone = walk.row("cluster-cone?submission=merged").triangles;
    table.rows.push_back(
        {short_level(walk), walk.best().method, adaptive ? walk.adaptive_way : "–",
         adaptive && walk.adaptive_settled ? std::to_string(walk.learning_frames) : "–",
         adaptive ? fmt::format("{:.3f}", adaptive->final_ms / walk.best().final_ms) : "–",
         report::format_ratio(cone, walk.row(with_tight_cells("zhang-octree?height=4")).triangles, 2),
         std::to_string(walk.row("zhang-octree?height=4&facing=printed").lost_pixels),
         std::to_string(walk.views), fmt::format("{:.2f}", walk.costs.call_ns / 1000),
         walk.costs.command_ns > 0 ? fmt::format("{:.2f}", walk.costs.command_ns / 1000) : "–",
         fmt::format("{:.0f}", walk.costs.triangle_ns)});
  }
  section.tables.push_back(std::move(table));
  section.note =
      "Costs are fitted to the frames of all methods: a call, a command of a multi-draw, a triangle with its "
      "pixels. "
      "--quick leaves out adaptive, multi-draws and the final.";
  return section;
}

}  // namespace sightline::reproduce
