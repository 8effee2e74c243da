#include "lab/reproduce/object_frustum.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include <sightline/error.hpp>
#include <sightline/worlds.hpp>

namespace sightline::lab {

namespace {

constexpr int kRuns = 10;

}  // namespace

CameraPath object_frustum_path(const Scene& scene) {
  CameraPath path{"ten headings from the middle", {}};
  for (int run = 0; run < kRuns; ++run) {
    const float heading = 2 * std::numbers::pi_v<float> * static_cast<float>(run) / kRuns;
    Camera camera;
    camera.eye = scene.viewpoints.front().eye;
    camera.forward = {std::sin(heading), 0, -std::cos(heading)};
    path.cameras.push_back(camera);
  }
  return path;
}

namespace {

std::string ratio(double of, double to) {
  return to > 0 ? fmt::format("{:.2f}", of / to) : "-";
}

// A line of the runs' table from sums over `runs` runs.
struct Sums {
  double grid_kept = 0, grid_ms = 0, kept = 0, tested = 0, ms = 0;

  void add(const Row& grid, const Row& fine) {
    grid_kept += static_cast<double>(grid.kept), grid_ms += grid.cull.median;
    kept += static_cast<double>(fine.kept), tested += static_cast<double>(fine.stats.tested),
        ms += fine.cull.median;
  }
  [[nodiscard]] std::vector<std::string> line(std::string name, double runs, double objects) const {
    return {std::move(name),
            format_count(grid_kept / runs),
            format_ms(grid_ms / runs),
            format_count(kept / runs),
            format_count(tested / runs),
            fmt::format("{:.1f} %", 100 * tested / runs / objects),
            format_ms(ms / runs),
            ratio(grid_ms, ms)};
  }
};

}  // namespace

Scene object_frustum_scene() {
  return or_throw(generate_world("forest?trees=30000&size=1000"));
}

std::vector<Contestant> object_frustum_contestants(const Scene& scene) {
  const std::array<std::string, 2> names{"grid-cell", "object-frustum"};
  return make_contestants(scene, names);
}

ObjectFrustumReproduction reproduce_object_frustum(const Scene& scene, const EmbreeJudge& judge,
                                                   std::span<const Contestant> contestants, bool quick,
                                                   const Progress& progress) {
  ObjectFrustumReproduction out;
  MeasureOptions options;
  options.repeats = quick ? 11 : 101;
  out.comparison = compare(scene, judge, contestants, object_frustum_path(scene), options, progress);

  const double objects = static_cast<double>(scene.size());
  out.runs.header = {"run",    "grid-cell kept", "ms", "object-frustum kept",
                     "tested", "share tested",   "ms", "ms ratio"};
  Sums all;
  for (int run = 0; run < kRuns; ++run) {
    const Row& grid = out.comparison.rows[2 * static_cast<std::size_t>(run)];
    const Row& fine = out.comparison.rows[2 * static_cast<std::size_t>(run) + 1];
    Sums one;
    one.add(grid, fine);
    all.add(grid, fine);
    out.runs.rows.push_back(one.line(std::to_string(run + 1), 1, objects));
  }
  out.runs.rows.push_back(all.line("mean", kRuns, objects));
  out.tested_share = all.tested / kRuns / objects;

  const auto& published_grid = kPublishedGridCell;
  const auto& published_fine = kPublishedObjectFrustum;
  out.ratios.header = {"grid-cell / object-frustum", "published", "ours"};
  out.ratios.rows = {
      {"CPU time of a frame / culling time", ratio(published_grid.cpu_ms, published_fine.cpu_ms),
       ratio(all.grid_ms, all.ms)},
      {"GPU time of a frame / objects drawn", ratio(published_grid.gpu_ms, published_fine.gpu_ms),
       ratio(all.grid_kept, all.kept)},
  };
  return out;
}

}  // namespace sightline::lab
