#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "workbench/methods/draw_calls/adaptive.hpp"
#include "workbench/oracle/triangle_judge.hpp"
#include "workbench/reproduce/walker.hpp"

namespace sightline::reproduce {

namespace {

/// Least squares of frame time over calls, multi-draw commands and triangles. What a view costs by itself
/// (its pixels) is taken out by looking at differences from the view's mean.
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
    const auto ns = [&](std::size_t i) { return std::max(0.0, 1e6 * m[i][3] / m[i][i]); };
    return {ns(0), ns(1), ns(2)};
  }

private:
  std::array<std::array<double, 4>, 3> sums_{};
};

std::vector<std::string> specifications() {
  std::vector<std::string> out{"nothing", "none"};
  for (const auto variant : kWalkVariants) {
    for (const auto structure : kWalkStructures) {
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
  out.emplace_back("adaptive");
  return out;
}

/// The walk at hand: level, path, walkers.
class Walk {
public:
  Walk(device::Device& device, Scene& scene, const DrawCallOptions& options, LevelWalk& out)
      : options_(options), scene_(scene), renderer_(device, scene), judge_(scene), out_(out) {
    for (const std::string& specification : specifications())
      walkers_.push_back(std::make_unique<Walker>(renderer_, specification));
    for (const auto& walker : walkers_) {
      everybody_.push_back(walker.get());
      const std::string& family = walker->row.family;
      if (!walker->culls() || (walker->row.submission == Submission::calls &&
                               (family.starts_with("simple-") || family.starts_with("drawcall-wise-")))) {
        paper_.push_back(walker.get());
      }
    }
  }

  /// adaptive goes ahead alone, round the walk in small steps as a player would, until it has settled.
  void let_adaptive_learn() {
    Walker& walker = *walkers_.back();
    const auto& adaptive = static_cast<const methods::Adaptive&>(walker.method());
    constexpr std::size_t kSteps = 500, kMost = 14 * kSteps;
    const camera::CameraPath path = camera::make_path(scene_, "walk", kSteps);
    for (std::size_t step = 0; step < kMost && !adaptive.settled(); ++step, ++out_.learning_frames)
      walker.draw(renderer_, view_of(path.cameras[step % path.cameras.size()]));
    out_.adaptive_settled = adaptive.settled();
    out_.adaptive_way = adaptive.in_use();
  }

  void look(std::size_t v) {
    const View view = view_of(out_.path.cameras[v]);
    const auto medians = draw_by_turns(everybody_, renderer_, view, v, options_.quick ? 3 : 5);
    for (std::size_t w = 0; w < walkers_.size(); ++w) {
      WalkRow& row = walkers_[w]->row;
      const Frame& frame = walkers_[w]->frame();
      row.frame_ms_by_view.push_back(medians[w].frame_ms);
      row.frame_ms += medians[w].frame_ms / views();
      row.cull_ms += medians[w].cull_ms / views();
      row.record_ms += medians[w].record_ms / views();
      row.draw_calls += static_cast<double>(frame.stats.draw_calls) / views();
      row.ranges += static_cast<double>(frame.draws.size()) / views();
      row.triangles += static_cast<double>(frame.stats.triangles) / views();
      if (walkers_[w]->culls())
        row.lost_pixels += judge_.judge(view, *walkers_[w]->method().geometry(), frame).loss.lost_pixels;
    }
    fit_.add_view(walkers_);
    const View small = or_throw(make_view(out_.path.cameras[v], kSmallWidth, kSmallHeight));
    const auto small_medians = draw_by_turns(paper_, renderer_, small, v, options_.quick ? 3 : 5);
    for (std::size_t w = 0; w < paper_.size(); ++w)
      paper_[w]->row.small_frame_ms += small_medians[w].frame_ms / views();
  }

  /// Whoever was among the quickest by few views and rounds, and adaptive, once more by many: the quickest of
  /// 80 noisy figures is too good to be true.
  void hold_final() {
    constexpr std::size_t kFinalists = 8;
    std::vector<Walker*> finalists;
    for (Walker* walker : everybody_) {
      if (walker->row.may_be_best()) finalists.push_back(walker);
    }
    std::ranges::sort(finalists, {}, [](const Walker* walker) { return walker->row.frame_ms; });
    finalists.resize(std::min(finalists.size(), kFinalists));
    finalists.push_back(walkers_.back().get());
    const camera::CameraPath path = camera::make_path(scene_, "walk", options_.quick ? 24 : 40);
    out_.final_views = path.cameras.size();
    for (std::size_t v = 0; v < out_.final_views; ++v) {
      const auto times =
          draw_by_turns(finalists, renderer_, view_of(path.cameras[v]), v, options_.quick ? 24 : 40);
      for (std::size_t w = 0; w < finalists.size(); ++w)
        finalists[w]->row.final_ms += times[w].typical_ms / static_cast<double>(out_.final_views);
    }
  }

  void finish() {
    out_.costs = fit_.solve();
    for (auto& walker : walkers_) out_.rows.push_back(std::move(walker->row));
  }

private:
  [[nodiscard]] View view_of(const Camera& camera) const {
    return or_throw(make_view(camera, options_.width, options_.height));
  }
  [[nodiscard]] double views() const noexcept { return static_cast<double>(out_.views); }

  const DrawCallOptions& options_;
  const Scene& scene_;
  device::Renderer renderer_;
  oracle::TriangleJudge judge_;
  LevelWalk& out_;
  std::vector<std::unique_ptr<Walker>> walkers_;
  std::vector<Walker*> everybody_, paper_;
  CostFit fit_;
};

}  // namespace

bool WalkRow::may_be_best() const noexcept {
  return family != "adaptive" && family != "none" && family != "nothing" && lost_pixels == 0;
}

const WalkRow& LevelWalk::row(std::string_view method) const {
  const auto found = std::ranges::find(rows, method, &WalkRow::method);
  if (found == rows.end()) throw Error("walk through " + level + ": no method " + std::string(method));
  return *found;
}

const WalkRow& LevelWalk::best() const {
  const WalkRow* best = nullptr;
  for (const WalkRow& row : rows) {
    if (row.may_be_best() && row.final_ms > 0 && (!best || row.final_ms < best->final_ms)) best = &row;
  }
  return best ? *best : rows.front();
}

int LevelWalk::best_height(std::string_view family) const {
  int best = 1;
  for (int height = 2; height <= 6; ++height) {
    if (row(fmt::format("{}?height={}", family, height)).frame_ms <
        row(fmt::format("{}?height={}", family, best)).frame_ms)
      best = height;
  }
  return best;
}

LevelWalk walk_level(device::Device& device, const LevelChoice& level, const DrawCallOptions& options,
                     const Progress& progress) {
  Scene scene = load_scene(level.specification);
  std::ranges::fill(scene.surface, Surface::opaque);
  set_raster_state(scene, RasterState::front_faces);  // as the paper draws
  LevelWalk out;
  out.level = scene.name, out.kind = level.kind;
  out.triangles = triangle_count(scene);
  out.path = camera::make_path(scene, "walk", options.quick ? 6 : 40);
  out.views = out.path.cameras.size();
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
