#include "workbench/reproduce/object_frustum.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

namespace sightline::reproduce {

namespace {

constexpr int kRuns = 10;

}  // namespace

camera::CameraPath object_frustum_path(const Scene& scene) {
  camera::CameraPath path{"ten headings from the middle", {}};
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

// A line of the runs' table from sums over `runs` runs.
struct Sums {
  double grid_kept = 0, grid_ms = 0, kept = 0, tested = 0, ms = 0;

  void add(const measure::Row& grid, const measure::Row& fine) {
    grid_kept += static_cast<double>(grid.kept), grid_ms += grid.cull.median;
    kept += static_cast<double>(fine.kept), tested += static_cast<double>(fine.stats.tested),
        ms += fine.cull.median;
  }
  [[nodiscard]] std::vector<std::string> line(std::string name, double runs, double objects) const {
    return {std::move(name),
            report::format_count(grid_kept / runs),
            report::format_ms(grid_ms / runs),
            report::format_count(kept / runs),
            report::format_count(tested / runs),
            fmt::format("{:.1f} %", 100 * tested / runs / objects),
            report::format_ms(ms / runs),
            report::format_ratio(grid_ms, ms, 2)};
  }
};

}  // namespace

Scene object_frustum_scene() {
  return generate_world("forest?trees=30000&size=1000");
}

ObjectFrustumReproduction reproduce_object_frustum(measure::Bench& bench, bool quick,
                                                   const Progress& progress) {
  ObjectFrustumReproduction out;
  measure::MeasureOptions options;
  options.repeats = quick ? 11 : 101;
  out.comparison = measure::compare(bench, object_frustum_path(bench.scene()), options, progress);

  const double objects = static_cast<double>(bench.scene().size());
  out.runs.header = {"run",    "grid-cell kept", "ms", "object-frustum kept",
                     "tested", "share tested",   "ms", "ms ratio"};
  Sums all;
  for (int run = 0; run < kRuns; ++run) {
    const measure::Row& grid = out.comparison.rows[2 * static_cast<std::size_t>(run)];
    const measure::Row& fine = out.comparison.rows[2 * static_cast<std::size_t>(run) + 1];
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
      {"CPU time of a frame / culling time",
       report::format_ratio(published_grid.cpu_ms, published_fine.cpu_ms, 2),
       report::format_ratio(all.grid_ms, all.ms, 2)},
      {"GPU time of a frame / objects drawn",
       report::format_ratio(published_grid.gpu_ms, published_fine.gpu_ms, 2),
       report::format_ratio(all.grid_kept, all.kept, 2)},
  };
  return out;
}

}  // namespace sightline::reproduce
