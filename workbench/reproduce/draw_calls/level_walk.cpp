#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "workbench/methods/draw_calls/adaptive.hpp"
#include "workbench/oracle/triangle_judge.hpp"
#include "workbench/reproduce/draw_calls/least_squares.hpp"
#include "workbench/reproduce/draw_calls/walker.hpp"

namespace sightline::reproduce {

namespace {

/// How much of each part is measured.
struct Effort {
  std::size_t turn, steps, rounds;            ///< of the walk that all take
  std::size_t line_turn, line_steps;          ///< of the dense one
  std::size_t final_views = 0, final_rounds;  ///< none: no final, and nothing that learns
};
constexpr Effort kQuick{2, 4, 2, 12, 24, 0, 0}, kWhole{6, 18, 4, 36, 84, 24, 24};

/// Frame time over calls, multi-draw commands and triangles. What a view costs by itself (its pixels) is
/// taken out by looking at differences from the view's mean.
class CostFit {
public:
  void add_view(std::span<const std::unique_ptr<Walker>> walkers) {
    std::vector<std::array<double, 4>> samples;
    std::array<double, 4> mean{};
    const auto all = static_cast<double>(walkers.size() - 1);
    for (const auto& walker : walkers) {
      if (walker->row.method == "nothing") continue;
      const bool multi = walker->method().geometry()->submission == Submission::multi_draw;
      const auto ranges = static_cast<double>(walker->frame().draws.size());
      samples.push_back({multi ? 0 : ranges, multi ? ranges : 0,
                         static_cast<double>(walker->frame().stats.triangles),
                         walker->row.frame_ms_by_view.back()});
      for (std::size_t i = 0; i < 4; ++i) mean[i] += samples.back()[i] / all;
    }
    for (auto& sample : samples) {
      for (std::size_t i = 0; i < 4; ++i) sample[i] -= mean[i];
      fit_.add(std::span(sample).first(3), sample[3]);
    }
  }

  [[nodiscard]] DrawCosts solve() const {
    const std::vector<double> ms = fit_.solve();
    const auto ns = [&](std::size_t i) { return std::max(0.0, 1e6 * ms[i]); };
    return {ns(0), ns(1), ns(2)};
  }

private:
  LeastSquares fit_{3};
};

std::vector<std::string> specifications(bool whole) {
  std::vector<std::string> out{"nothing", "none"};
  for (const auto variant : kWalkVariants) {
    for (const auto structure : kWalkStructures) {
      for (std::uint32_t height = 1; height <= kHighest; ++height) {
        out.push_back(fmt::format("{}-{}?height={}", variant, structure, height));
        if (whole || height == 4) out.push_back(with_tight_cells(out.back()));
      }
      if (!whole) continue;
      for (const char* submission : {"multi-draw", "merged"}) {
        out.push_back(with_tight_cells(fmt::format("{}-{}?height=4", variant, structure)) +
                      "&submission=" + submission);
      }
    }
  }
  for (const auto structure : kWalkStructures) {
    out.push_back(fmt::format("drawcall-wise-{}?height=4&occlusion=masked", structure));
    for (const char* planes : {"xy", "both"})
      out.push_back(fmt::format("zhang-{}?height=4&planes={}", structure, planes));
  }
  out.emplace_back("zhang-octree?height=4&facing=printed");
  out.emplace_back("cluster-cone?submission=merged");
  if (!whole) return out;
  for (const char* submission : {"calls", "multi-draw"})
    out.push_back(fmt::format("cluster-cone?submission={}", submission));
  for (const char* size : {"64", "256"}) out.push_back(fmt::format("cluster-cone?size={}", size));
  out.emplace_back("adaptive");
  return out;
}

/// The walk at hand: level, path, walkers.
class Walk {
public:
  Walk(device::Device& device, Scene& scene, const DrawCallOptions& options, LevelWalk& out)
      : options_(options),
        effort_(options.quick ? kQuick : kWhole),
        scene_(scene),
        renderer_(device, scene),
        judge_(scene),
        path_(turn_and_walk(scene, effort_.turn, effort_.steps)),
        out_(out) {
    out.views = path_.cameras.size();
    for (const std::string& specification : specifications(!options.quick))
      walkers_.push_back(std::make_unique<Walker>(renderer_, specification));
    for (const auto& walker : walkers_) {
      everybody_.push_back(walker.get());
      const bool rival = walker->row.is_of_the_paper() && !walker->row.family.starts_with("zhang-");
      if (!walker->culls() || rival) rivals_.push_back(walker.get());
    }
  }

  /// adaptive goes ahead alone, round the walk in small steps as a player would, until it has settled.
  void let_adaptive_learn() {
    Walker& walker = *walkers_.back();
    if (walker.row.family != "adaptive") return;
    const auto& adaptive = static_cast<const methods::Adaptive&>(walker.method());
    constexpr std::size_t kSteps = 500, kMost = 14 * kSteps;
    const camera::CameraPath path = camera::make_path(scene_, "walk", kSteps);
    for (std::size_t step = 0; step < kMost && !adaptive.settled(); ++step, ++out_.learning_frames)
      walker.draw(renderer_, view_of(path.cameras[step % path.cameras.size()]));
    out_.adaptive_settled = adaptive.settled();
    out_.adaptive_way = adaptive.in_use();
  }

  void look(std::size_t v) {
    const View view = view_of(path_.cameras[v]);
    const auto medians = draw_by_turns(everybody_, renderer_, view, v, effort_.rounds);
    for (std::size_t w = 0; w < walkers_.size(); ++w) {
      WalkRow& row = walkers_[w]->row;
      const Frame& frame = walkers_[w]->frame();
      row.frame_ms_by_view.push_back(medians[w].frame_ms);
      row.frame_ms += medians[w].frame_ms / views();
      row.cull_ms += medians[w].cull_ms / views();
      row.record_ms += medians[w].record_ms / views();
      row.draw_calls += static_cast<double>(frame.stats.draw_calls) / views();
      row.triangles += static_cast<double>(frame.stats.triangles) / views();
      row.nodes_visited += static_cast<double>(frame.stats.nodes_visited) / views();
      row.objects += static_cast<double>(frame.visible.size()) / views();
      if (walkers_[w]->culls())
        row.lost_pixels += judge_.judge(view, *walkers_[w]->method().geometry(), frame).loss.lost_pixels;
    }
    fit_.add_view(walkers_);
    const View small = or_throw(make_view(path_.cameras[v], kSmallWidth, kSmallHeight));
    const auto small_medians = draw_by_turns(rivals_, renderer_, small, v, effort_.rounds);
    for (std::size_t w = 0; w < rivals_.size(); ++w)
      rivals_[w]->row.small_frame_ms += small_medians[w].frame_ms / views();
  }

  /// Whoever was among the quickest by few views and rounds, and adaptive, once more by many: the quickest of
  /// 80 noisy figures is too good to be true.
  void hold_final() {
    if (effort_.final_views == 0) return;
    constexpr std::size_t kFinalists = 8;
    std::vector<Walker*> finalists;
    for (Walker* walker : everybody_) {
      if (walker->row.may_be_best()) finalists.push_back(walker);
    }
    std::ranges::sort(finalists, {}, [](const Walker* walker) { return walker->row.frame_ms; });
    finalists.resize(std::min(finalists.size(), kFinalists));
    finalists.push_back(walkers_.back().get());
    const camera::CameraPath path = camera::make_path(scene_, "walk", effort_.final_views);
    out_.final_views = path.cameras.size();
    for (std::size_t v = 0; v < out_.final_views; ++v) {
      const auto times =
          draw_by_turns(finalists, renderer_, view_of(path.cameras[v]), v, effort_.final_rounds);
      for (std::size_t w = 0; w < finalists.size(); ++w)
        finalists[w]->row.final_ms += times[w].typical_ms / static_cast<double>(out_.final_views);
    }
  }

  /// All families at their best height, and none, step by step.
  void draw_lines() {
    out_.turn = effort_.line_turn;
    out_.path = turn_and_walk(scene_, effort_.line_turn, effort_.line_steps);
    std::vector<Walker*> walkers;
    for (Walker* walker : everybody_) {
      const WalkRow& row = walker->row;
      if (row.family == "none" || (row.is_of_the_paper() && row.height == out_.best_height(row.family)))
        walkers.push_back(walker);
    }
    for (const Walker* walker : walkers) out_.lines.push_back({walker->row.method, {}});
    for (std::size_t v = 0; v < out_.path.cameras.size(); ++v) {
      const auto times = draw_by_turns(walkers, renderer_, view_of(out_.path.cameras[v]), v, effort_.rounds);
      for (std::size_t w = 0; w < walkers.size(); ++w) out_.lines[w].fps.push_back(1000 / times[w].frame_ms);
    }
  }

  void finish() {
    out_.costs = fit_.solve();
    for (const auto& walker : walkers_) out_.rows.push_back(walker->row);
    draw_lines();
    std::vector<View> views;
    for (const Camera& camera : path_.cameras) views.push_back(view_of(camera));
    out_.counts = count_structures(scene_, views);
  }

private:
  [[nodiscard]] View view_of(const Camera& camera) const {
    return or_throw(make_view(camera, options_.width, options_.height));
  }
  [[nodiscard]] double views() const noexcept { return static_cast<double>(out_.views); }

  const DrawCallOptions& options_;
  const Effort& effort_;
  const Scene& scene_;
  device::Renderer renderer_;
  oracle::TriangleJudge judge_;
  camera::CameraPath path_;
  LevelWalk& out_;
  std::vector<std::unique_ptr<Walker>> walkers_;
  std::vector<Walker*> everybody_, rivals_;
  CostFit fit_;
};

}  // namespace

std::string with_tight_cells(std::string_view method) {
  return fmt::format("{}&{}", method, methods::kTightCells);
}

bool WalkRow::is_of_the_paper() const noexcept {
  return height > 0 && method.find('&') == std::string::npos;
}

bool WalkRow::may_be_best() const noexcept {
  return family != "adaptive" && family != "none" && family != "nothing" && lost_pixels == 0 &&
         method.find("occlusion=") == std::string::npos;
}

const WalkRow* LevelWalk::find(std::string_view method) const noexcept {
  const auto found = std::ranges::find(rows, method, &WalkRow::method);
  return found == rows.end() ? nullptr : &*found;
}

const WalkRow& LevelWalk::row(std::string_view method) const {
  if (const WalkRow* found = find(method)) return *found;
  throw Error("walk through " + level + ": no method " + std::string(method));
}

const StructureCount& LevelWalk::count(std::string_view structure, std::uint32_t height,
                                       std::string_view rules) const {
  const auto found = std::ranges::find_if(counts, [&](const StructureCount& one) {
    return one.structure == structure && one.height == height && one.rules == rules;
  });
  if (found == counts.end()) throw Error("walk through " + level + ": no such structure was counted");
  return *found;
}

const WalkRow& LevelWalk::best() const {
  const auto time = [&](const WalkRow& row) { return final_views > 0 ? row.final_ms : row.frame_ms; };
  const WalkRow* best = nullptr;
  for (const WalkRow& row : rows) {
    if (row.may_be_best() && time(row) > 0 && (!best || time(row) < time(*best))) best = &row;
  }
  return best ? *best : rows.front();
}

const WalkRow& LevelWalk::best_of_the_paper() const {
  const WalkRow* best = nullptr;
  for (const WalkRow& row : rows) {
    if (row.is_of_the_paper() && (!best || row.frame_ms < best->frame_ms)) best = &row;
  }
  return best ? *best : rows.front();
}

std::uint32_t LevelWalk::best_height(std::string_view family) const {
  return at_best_height(family).height;
}

const WalkRow& LevelWalk::at_best_height(std::string_view family) const {
  const WalkRow* best = nullptr;
  for (std::uint32_t height = 1; height <= kHighest; ++height) {
    const WalkRow& here = row(fmt::format("{}?height={}", family, height));
    if (!best || here.frame_ms < best->frame_ms) best = &here;
  }
  return *best;
}

camera::CameraPath turn_and_walk(const Scene& scene, std::size_t turn, std::size_t steps) {
  camera::CameraPath walk = camera::make_path(scene, "walk", steps);
  camera::CameraPath out{walk.name, {}};
  for (std::size_t t = 0; t < turn; ++t) {
    Camera camera = walk.cameras.front();
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(t) / static_cast<float>(turn);
    const Vec3 ahead = camera.forward;
    camera.forward.x = ahead.x * std::cos(angle) - ahead.z * std::sin(angle);
    camera.forward.z = ahead.x * std::sin(angle) + ahead.z * std::cos(angle);
    out.cameras.push_back(camera);
  }
  out.cameras.insert(out.cameras.end(), walk.cameras.begin(), walk.cameras.end());
  return out;
}

LevelWalk walk_level(device::Device& device, const LevelChoice& level, const DrawCallOptions& options,
                     const Progress& progress) {
  Scene scene = load_scene(level.specification);
  std::ranges::fill(scene.surface, Surface::opaque);
  set_raster_state(scene, RasterState::front_faces);  // as the paper draws
  LevelWalk out;
  out.level = scene.name, out.kind = level.kind;
  out.triangles = triangle_count(scene);
  Walk walk(device, scene, options, out);
  walk.let_adaptive_learn();
  for (std::size_t v = 0; v < out.views; ++v) {
    walk.look(v);
    if (progress) progress(v + 1, out.views);
  }
  walk.hold_final();
  walk.finish();
  return out;
}

}  // namespace sightline::reproduce
