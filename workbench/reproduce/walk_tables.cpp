// What a walk says: tables, and sentences on the paper's claims.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <span>

#include "workbench/reproduce/draw_calls.hpp"

namespace sightline::reproduce {

report::Table heights_table(const LevelWalk& walk) {
  report::Table table;
  table.header = {"mean fps"};
  for (int height = 1; height <= 6; ++height) table.header.push_back("height " + std::to_string(height));
  table.header.emplace_back("best");
  for (const auto structure : kWalkStructures) {
    for (const auto variant : kWalkVariants) {
      const std::string name = fmt::format("{}-{}", variant, structure);
      std::vector<std::string> line{name};
      for (int height = 1; height <= 6; ++height)
        line.push_back(fmt::format("{:.0f}", walk.row(fmt::format("{}?height={}", name, height)).fps()));
      line.push_back(std::to_string(walk.best_height(name)));
      table.rows.push_back(std::move(line));
    }
  }
  return table;
}

namespace {

/// A structure's three variants at one height.
struct Rivals {
  const WalkRow &simple, &wise, &zhang;

  Rivals(const LevelWalk& walk, std::string_view structure, int height)
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

}  // namespace

report::Table calls_table(const LevelWalk& walk) {
  report::Table table;
  const std::string small = fmt::format("frame at {}x{}", kSmallWidth, kSmallHeight);
  table.header = {"simple / drawcall-wise",
                  "simple's calls",
                  "drawcall-wise's",
                  "ratio",
                  "CPU",
                  "frame",
                  "were calls free",
                  small,
                  "triangles zhang / wise"};
  for (const auto structure : kWalkStructures) {
    const int best = walk.best_height(fmt::format("drawcall-wise-{}", structure));
    for (int height = 1; height <= 6; ++height) {
      const Rivals r(walk, structure, height);
      table.rows.push_back(
          {fmt::format("{}, height {}{}", structure, height, height == best ? " (best)" : ""),
           report::format_count(std::round(r.simple.draw_calls)),
           report::format_count(std::round(r.wise.draw_calls)), fmt::format("{:.1f}", r.calls()),
           fmt::format("{:.2f}", r.recording()), fmt::format("{:.2f}", r.frames()),
           fmt::format("{:.2f}", r.limit()), fmt::format("{:.2f}", r.small_frames()),
           fmt::format("{:.2f}", r.triangles())});
    }
  }
  return table;
}

namespace {

std::vector<std::string> method_line(const WalkRow& row, double none_ms) {
  return {row.method,
          std::string(to_string(row.submission)),
          fmt::format("{:.0f}", row.fps()),
          fmt::format("{:.2f}", none_ms / row.frame_ms),
          report::format_ms(row.frame_ms),
          report::format_ms(row.cull_ms),
          report::format_ms(row.record_ms),
          report::format_count(std::round(row.draw_calls)),
          report::format_count(std::round(row.triangles)),
          fmt::format("{:.1f}", static_cast<double>(row.bytes) / 1e6),
          report::format_count(static_cast<double>(row.lost_pixels))};
}

}  // namespace

report::Table methods_table(const LevelWalk& walk) {
  report::Table table;
  table.text_columns = 2;
  table.header = {"method",    "submission", "fps",       "× none", "frame ms",   "cull ms",
                  "record ms", "draw calls", "triangles", "MB",     "lost pixels"};
  const double none_ms = walk.row("none").frame_ms;
  std::map<std::string, const WalkRow*> best;
  std::vector<std::string> order;
  for (const WalkRow& row : walk.rows) {
    if (row.height == 0 || row.submission != Submission::calls ||
        row.method.find("printed") != std::string::npos) {
      order.push_back(row.method);
      best[row.method] = &row;
      continue;
    }
    const WalkRow*& held = best[row.family];
    if (!held) order.push_back(row.family);
    if (!held || row.frame_ms < held->frame_ms) held = &row;
  }
  for (const std::string& name : order) {
    const WalkRow& row = *best[name];
    if (row.height == 0 || row.submission == Submission::calls)
      table.rows.push_back(method_line(row, none_ms));
  }
  return table;
}

report::Table submission_table(const LevelWalk& walk) {
  report::Table table;
  table.header = {"height 4",        "calls",    "frame ms",  "as multi-draw", "frame ms",
                  "as merged calls", "frame ms", "triangles", "when merged"};
  const auto add = [&](const std::string& name, const std::string& calls, const std::string& multi,
                       const std::string& merged) {
    const WalkRow &a = walk.row(calls), &b = walk.row(multi), &c = walk.row(merged);
    table.rows.push_back({name, report::format_count(std::round(a.draw_calls)), report::format_ms(a.frame_ms),
                          report::format_count(b.draw_calls), report::format_ms(b.frame_ms),
                          report::format_count(std::round(c.draw_calls)), report::format_ms(c.frame_ms),
                          report::format_count(std::round(a.triangles)),
                          report::format_count(std::round(c.triangles))});
  };
  for (const auto structure : kWalkStructures) {
    for (const auto variant : kWalkVariants) {
      const std::string at = fmt::format("{}-{}?height=4", variant, structure);
      add(fmt::format("{}-{}", variant, structure), at, at + "&submission=multi-draw",
          at + "&submission=merged");
    }
  }
  add("cluster-cone", "cluster-cone?submission=calls", "cluster-cone?submission=multi-draw",
      "cluster-cone?submission=merged");
  return table;
}

namespace {

std::string final_line(const LevelWalk& walk) {
  std::vector<const WalkRow*> finalists;
  for (const WalkRow& row : walk.rows) {
    if (row.final_ms > 0) finalists.push_back(&row);
  }
  std::ranges::sort(finalists, {}, &WalkRow::final_ms);
  std::string line = fmt::format("Final among the quickest over {} views, ms a frame:", walk.final_views);
  for (const WalkRow* row : finalists) line += fmt::format(" {} {:.3f};", row->method, row->final_ms);
  line.back() = '.';
  return line + '\n';
}

/// "1.10 to 1.30": the least and the greatest over the structures.
template <class Ratio>
std::string range_of(std::span<const Rivals> rivals, Ratio ratio, int digits = 2) {
  const auto [least, most] = std::ranges::minmax(rivals | std::views::transform(ratio));
  return fmt::format("{:.{}f} to {:.{}f}", least, digits, most, digits);
}

std::string compared(const std::string& where, std::span<const Rivals> rivals) {
  return fmt::format(
      "{} simple makes {} × the calls of drawcall-wise; its frames take {} × as long (at most {} ×, were "
      "drawcall-wise's calls free; {} × in a picture of {}x{}), its recording on the CPU {} ×. zhang submits "
      "{} × the triangles of drawcall-wise.\n",
      where, range_of(rivals, &Rivals::calls, 1), range_of(rivals, &Rivals::frames),
      range_of(rivals, &Rivals::limit), range_of(rivals, &Rivals::small_frames), kSmallWidth, kSmallHeight,
      range_of(rivals, &Rivals::recording), range_of(rivals, &Rivals::triangles));
}

}  // namespace

std::string findings(const LevelWalk& walk) {
  std::vector<Rivals> fourth, best;
  std::string heights;
  for (const auto structure : kWalkStructures) {
    const int height = walk.best_height(fmt::format("drawcall-wise-{}", structure));
    heights += fmt::format("{}{} {}", heights.empty() ? "" : ", ", structure, height);
    fourth.emplace_back(walk, structure, 4);
    best.emplace_back(walk, structure, height);
  }
  std::string out = compared("At height 4, the paper's best,", fourth) +
                    compared(fmt::format("Where drawcall-wise is quickest (height of {})", heights), best);
  std::array<double, 7> by_height{};
  for (const WalkRow& row : walk.rows) {
    if (row.height > 0 && row.submission == Submission::calls) by_height[row.height] += 1 / row.frame_ms;
  }
  const auto winner = std::max_element(by_height.begin(), by_height.end()) - by_height.begin();
  const WalkRow &quickest = walk.best(), &adaptive = walk.row("adaptive");
  out += fmt::format(
      "cluster-cone submits {:.2f} × the triangles of zhang-octree.\n",
      walk.row("cluster-cone?submission=merged").triangles / walk.row("zhang-octree?height=4").triangles);
  out += fmt::format(
      "Fitted to the frames, a call costs {:.2f} µs, a command of a multi-draw {:.2f} µs, and a triangle "
      "with its "
      "pixels {:.0f} ns.\n",
      walk.costs.call_ns / 1000, walk.costs.command_ns / 1000, walk.costs.triangle_ns);
  out += final_line(walk);
  out += fmt::format(
      "Quickest: {} ({:.0f} fps); the height that did best over all methods: "
      "{}.\n",
      quickest.method, 1000 / quickest.final_ms, winner);
  out += fmt::format(
      "adaptive {} {} in {} frames; in the final it takes {:.3f} × the frame time of the quickest.\n",
      walk.adaptive_settled ? "settled on" : "had not settled, and used", walk.adaptive_way,
      walk.learning_frames, adaptive.final_ms / quickest.final_ms);
  const WalkRow &nothing = walk.row("nothing"), &none = walk.row("none");
  out += fmt::format(
      "An empty frame takes {:.2f} ms ({:.2f} in the small picture), everything in one call {:.2f} "
      "({:.2f}).\n",
      nothing.frame_ms, nothing.small_frame_ms, none.frame_ms, none.small_frame_ms);
  out += fmt::format("The printed facing rule lost {} pixels in {} views.\n",
                     walk.row("zhang-octree?height=4&facing=printed").lost_pixels, walk.views);
  return out;
}

}  // namespace sightline::reproduce
