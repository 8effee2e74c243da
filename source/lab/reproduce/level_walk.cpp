#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>

#include <sightline/error.hpp>
#include <sightline/io.hpp>

#include "lab/reproduce/draw_calls.hpp"
#include "lab/triangle_judge.hpp"
#include "vulkan/triangle_draws.hpp"

namespace sightline::lab {

namespace {

constexpr std::array kLevels{
    LevelChoice{"pak1-maps.pk3:maps/aggressor.bsp", "small, in doors"},
    LevelChoice{"pak1-maps.pk3:maps/islandctf.bsp", "middle, out of doors"},
    LevelChoice{"pak1-maps.pk3:maps/ctf_inyard.bsp", "large, in and out of doors"},
};
constexpr std::array<std::string_view, 3> kVariants{"simple", "drawcall-wise", "zhang"};
constexpr std::array<std::string_view, 3> kStructures{"grid", "octree", "kd-tree"};

/// A method with its triangles on the device.
struct Walker {
  WalkRow row;
  std::unique_ptr<Method> method;
  bool everything = false;  ///< "none": all triangles, one call
  std::unique_ptr<vulkan::TriangleDraws> draws;
  Frame frame;
  std::vector<double> frame_ms, cull_ms, record_ms;  ///< of the view at hand
  double quickest_ms = 0;
};

Walker make_walker(vulkan::Renderer& renderer, const std::string& specification) {
  Walker walker;
  walker.everything = specification == "none";
  walker.row.method = specification;
  walker.row.family = std::string(specified_name(specification));
  const std::size_t at = specification.find("height=");
  walker.row.height = at == std::string::npos ? 0 : static_cast<std::uint32_t>(specification[at + 7] - '0');
  walker.method =
      or_throw(create_method(walker.everything ? "simple-grid?height=1" : specification, renderer.scene()));
  const TriangleGeometry& geometry = *walker.method->geometry();
  walker.row.submission = geometry.submission;
  walker.row.bytes = geometry.bytes;
  walker.draws = std::make_unique<vulkan::TriangleDraws>(renderer, geometry);
  return walker;
}

void draw_view(Walker& walker, vulkan::Renderer& renderer, const View& view, bool counts) {
  double cull_ms = 0;
  const vulkan::FrameTimes times = renderer.frame(view, [&](vulkan::Recorder& recorder) {
    const auto begin = std::chrono::steady_clock::now();
    if (walker.everything) {
      const auto count = static_cast<std::uint32_t>(walker.method->geometry()->objects.size());
      walker.frame.clear();
      walker.frame.draws.push_back({3 * count, 1, 0, 0, 0});
      walker.frame.stats.draw_calls = 1, walker.frame.stats.triangles = count;
    } else {
      walker.method->cull(view, walker.frame);
    }
    cull_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    walker.draws->draw(recorder, walker.frame.draws, walker.row.submission);
  });
  if (!counts) return;
  walker.frame_ms.push_back(times.frame_ms);
  walker.cull_ms.push_back(cull_ms);
  walker.record_ms.push_back(times.record_ms);
}

/// All walkers in one view, by turns that rotate; then sums of what they did.
void draw_all(std::vector<Walker>& walkers, vulkan::Renderer& renderer, const View& view, std::size_t turn,
              std::size_t repeats) {
  for (std::size_t repeat = 0; repeat <= repeats; ++repeat) {
    for (std::size_t k = 0; k < walkers.size(); ++k)
      draw_view(walkers[(k + turn + repeat) % walkers.size()], renderer, view, repeat > 0);
  }
  for (Walker& walker : walkers) {
    const Timing frame = timing_of(walker.frame_ms);
    walker.row.frame_ms_by_view.push_back(frame.median);
    walker.row.frame_ms += frame.median;
    walker.quickest_ms = frame.min;
    walker.row.record_ms += timing_of(walker.record_ms).median;
    walker.row.cull_ms += timing_of(walker.cull_ms).median;
    walker.row.draw_calls += static_cast<double>(walker.frame.stats.draw_calls);
    walker.row.ranges += static_cast<double>(walker.frame.draws.size());
    walker.row.triangles += static_cast<double>(walker.frame.stats.triangles);
    walker.frame_ms.clear(), walker.cull_ms.clear(), walker.record_ms.clear();
  }
}

/// Least squares of frame time over calls, multi-draw commands and triangles. What a view costs by itself
/// (its pixels) is taken out by looking at differences from the view's mean.
class CostFit {
public:
  void add_view(const std::vector<Walker>& walkers) {
    std::vector<std::array<double, 4>> samples;
    std::array<double, 4> mean{};
    for (const Walker& walker : walkers) {
      const bool multi = walker.row.submission == Submission::multi_draw;
      const auto ranges = static_cast<double>(walker.frame.draws.size());
      samples.push_back({multi ? 0 : ranges, multi ? ranges : 0,
                         static_cast<double>(walker.frame.stats.triangles),
                         walker.row.frame_ms_by_view.back()});
      for (std::size_t i = 0; i < 4; ++i) mean[i] += samples.back()[i] / static_cast<double>(walkers.size());
    }
    for (auto& sample : samples) {
      for (std::size_t i = 0; i < 4; ++i) sample[i] -= mean[i];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) sums_[i][j] += sample[i] * sample[j];
      }
    }
  }

  [[nodiscard]] DrawCosts solve() const {
    auto m = sums_;
    for (std::size_t i = 0; i < 3; ++i) {
      m[i][i] += 1e-9;  // no sample, no cost
      for (std::size_t r = 0; r < 3; ++r) {
        if (r == i) continue;
        const double factor = m[r][i] / m[i][i];
        for (std::size_t c = 0; c < 4; ++c) m[r][c] -= factor * m[i][c];
      }
    }
    const auto ns = [&](std::size_t i) { return std::max(1.0, 1e6 * m[i][3] / m[i][i]); };
    return {ns(0), ns(1), ns(2)};
  }

private:
  std::array<std::array<double, 4>, 3> sums_{};
};

DrawCosts measure_costs(vulkan::Renderer& renderer, const CameraPath& path, const DrawCallOptions& options) {
  std::vector<Walker> walkers;
  for (const char* name :
       {"none", "simple-octree", "simple-grid", "simple-octree?submission=multi-draw",
        "simple-grid?submission=multi-draw", "drawcall-wise-grid", "drawcall-wise-octree?height=6",
        "drawcall-wise-octree?height=6&submission=multi-draw", "zhang-octree",
        "zhang-octree?submission=multi-draw", "zhang-kd-tree?height=6", "drawcall-wise-kd-tree?height=2",
        "cluster-cone", "cluster-cone?submission=multi-draw"}) {
    walkers.push_back(make_walker(renderer, name));
  }
  CostFit fit;
  const std::size_t views = std::min<std::size_t>(path.cameras.size(), options.quick ? 4 : 10);
  for (std::size_t v = 0; v < views; ++v) {
    const Camera& camera = path.cameras[v * path.cameras.size() / views];
    draw_all(walkers, renderer, or_throw(make_view(camera, options.width, options.height)), v, 5);
    fit.add_view(walkers);
  }
  return fit.solve();
}

std::vector<std::string> specifications(const DrawCosts& costs) {
  std::vector<std::string> out{"none"};
  for (const auto variant : kVariants) {
    for (const auto structure : kStructures) {
      for (int height = 1; height <= 6; ++height)
        out.push_back(fmt::format("{}-{}?height={}", variant, structure, height));
      for (const char* submission : {"multi-draw", "merged"})
        out.push_back(fmt::format("{}-{}?height=4&submission={}", variant, structure, submission));
    }
  }
  out.emplace_back("zhang-octree?height=4&facing=printed");
  for (const char* submission : {"calls", "multi-draw", "merged"})
    out.push_back(fmt::format("cluster-cone?submission={}", submission));
  for (const char* size : {"64", "256"}) out.push_back(fmt::format("cluster-cone?size={}", size));
  out.push_back(fmt::format("adaptive?call-ns={:.0f}&command-ns={:.0f}&triangle-ns={:.0f}", costs.call_ns,
                            costs.command_ns, costs.triangle_ns));
  return out;
}

}  // namespace

std::span<const LevelChoice> draw_call_levels() noexcept {
  return kLevels;
}

const WalkRow& LevelWalk::row(std::string_view method) const {
  const auto found = std::ranges::find(rows, method, &WalkRow::method);
  if (found == rows.end()) throw Error("walk through " + level + ": no method " + std::string(method));
  return *found;
}

const WalkRow& LevelWalk::best() const {
  const WalkRow* best = nullptr;
  for (const WalkRow& row : rows) {
    const bool stands = row.family != "adaptive" && row.family != "none" && row.lost_pixels == 0;
    if (stands && (!best || row.frame_ms < best->frame_ms)) best = &row;
  }
  return best ? *best : rows.front();
}

LevelWalk walk_level(vulkan::Device& device, const LevelChoice& level, const DrawCallOptions& options,
                     const Progress& progress) {
  Scene scene = load_scene(level.specification);
  std::ranges::fill(scene.surface, Surface::opaque);
  LevelWalk walk;
  walk.level = scene.name, walk.kind = level.kind;
  walk.triangles = triangle_count(scene);
  walk.path = make_path(scene, "walk", options.quick ? 5 : 40);
  walk.views = walk.path.cameras.size();
  vulkan::Renderer renderer(device, scene);
  walk.costs = measure_costs(renderer, walk.path, options);
  std::vector<Walker> walkers;
  for (const std::string& specification : specifications(walk.costs))
    walkers.push_back(make_walker(renderer, specification));
  TriangleJudge judge(scene);
  for (std::size_t v = 0; v < walk.views; ++v) {
    const View view = or_throw(make_view(walk.path.cameras[v], options.width, options.height));
    draw_all(walkers, renderer, view, v, options.quick ? 3 : 5);
    for (Walker& walker : walkers) {
      if (!walker.everything)
        walker.row.lost_pixels +=
            judge.judge(view, *walker.method->geometry(), walker.frame).loss.lost_pixels;
    }
    if (progress) progress(v + 1, walk.views);
  }
  for (Walker& walker : walkers) {
    WalkRow& row = walker.row;
    const auto views = static_cast<double>(walk.views);
    for (double* mean :
         {&row.frame_ms, &row.cull_ms, &row.record_ms, &row.draw_calls, &row.ranges, &row.triangles})
      *mean /= views;
    if (row.family == "adaptive") {
      walk.adaptive_plan = row.method;
      row.method = "adaptive";
    }
    walk.rows.push_back(std::move(row));
  }
  return walk;
}

Table heights_table(const LevelWalk& walk) {
  Table table;
  table.header = {"mean fps"};
  for (int height = 1; height <= 6; ++height) table.header.push_back("height " + std::to_string(height));
  table.header.emplace_back("best");
  for (const auto structure : kStructures) {
    for (const auto variant : kVariants) {
      const std::string name = fmt::format("{}-{}", variant, structure);
      std::vector<std::string> line{name};
      int best = 1;
      for (int height = 1; height <= 6; ++height) {
        const double fps = walk.row(fmt::format("{}?height={}", name, height)).fps();
        line.push_back(fmt::format("{:.0f}", fps));
        if (fps > walk.row(fmt::format("{}?height={}", name, best)).fps()) best = height;
      }
      line.push_back(std::to_string(best));
      table.rows.push_back(std::move(line));
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
          format_ms(row.frame_ms),
          format_ms(row.cull_ms),
          format_ms(row.record_ms),
          format_count(std::round(row.draw_calls)),
          format_count(std::round(row.triangles)),
          fmt::format("{:.1f}", static_cast<double>(row.bytes) / 1e6),
          format_count(static_cast<double>(row.lost_pixels))};
}

}  // namespace

Table methods_table(const LevelWalk& walk) {
  Table table;
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

Table submission_table(const LevelWalk& walk) {
  Table table;
  table.header = {"height 4",        "calls",    "frame ms",  "as multi-draw", "frame ms",
                  "as merged calls", "frame ms", "triangles", "when merged"};
  const auto add = [&](const std::string& name, const std::string& calls, const std::string& multi,
                       const std::string& merged) {
    const WalkRow &a = walk.row(calls), &b = walk.row(multi), &c = walk.row(merged);
    table.rows.push_back({name, format_count(std::round(a.draw_calls)), format_ms(a.frame_ms),
                          format_count(b.draw_calls), format_ms(b.frame_ms),
                          format_count(std::round(c.draw_calls)), format_ms(c.frame_ms),
                          format_count(std::round(a.triangles)), format_count(std::round(c.triangles))});
  };
  for (const auto structure : kStructures) {
    for (const auto variant : kVariants) {
      const std::string at = fmt::format("{}-{}?height=4", variant, structure);
      add(fmt::format("{}-{}", variant, structure), at, at + "&submission=multi-draw",
          at + "&submission=merged");
    }
  }
  add("cluster-cone", "cluster-cone?submission=calls", "cluster-cone?submission=multi-draw",
      "cluster-cone?submission=merged");
  return table;
}

std::string findings(const LevelWalk& walk) {
  std::string out;
  const auto at = [&](std::string_view variant, std::string_view structure) -> const WalkRow& {
    return walk.row(fmt::format("{}-{}?height=4", variant, structure));
  };
  for (const auto structure : kStructures) {
    const WalkRow &simple = at("simple", structure), &wise = at("drawcall-wise", structure),
                  &zhang = at("zhang", structure);
    out += fmt::format(
        "{}, height 4: simple makes {:.1f} × the calls of drawcall-wise, whose frames are {:.2f} × as fast "
        "and "
        "whose recording on the CPU is {:.2f} × as fast; zhang submits {:.2f} × the triangles of "
        "drawcall-wise.\n",
        structure, simple.draw_calls / std::max(1.0, wise.draw_calls), simple.frame_ms / wise.frame_ms,
        simple.record_ms / wise.record_ms, zhang.triangles / wise.triangles);
  }
  const WalkRow &zhang = at("zhang", "octree"), &cone = walk.row("cluster-cone?submission=merged"),
                &adaptive = walk.row("adaptive"), &best = walk.best();
  std::array<double, 7> by_height{};
  for (const WalkRow& row : walk.rows) {
    if (row.height > 0 && row.submission == Submission::calls) by_height[row.height] += 1 / row.frame_ms;
  }
  const auto winner = std::max_element(by_height.begin(), by_height.end()) - by_height.begin();
  out += fmt::format("cluster-cone submits {:.2f} × the triangles of zhang-octree.\n",
                     cone.triangles / zhang.triangles);
  out += fmt::format(
      "Measured on this device: a call {:.2f} µs, a command of a multi-draw {:.2f} µs, a triangle {:.0f} "
      "ns.\n",
      walk.costs.call_ns / 1000, walk.costs.command_ns / 1000, walk.costs.triangle_ns);
  out += fmt::format("Quickest: {} ({:.0f} fps); the height that did best over all methods: {}.\n",
                     best.method, best.fps(), winner);
  out += fmt::format("adaptive takes {:.3f} × the frame time of the quickest.\n",
                     adaptive.frame_ms / best.frame_ms);
  out += fmt::format("The printed facing rule lost {} pixels in {} views.\n",
                     walk.row("zhang-octree?height=4&facing=printed").lost_pixels, walk.views);
  return out;
}

}  // namespace sightline::lab
