// Le Hoang Minh et al. 2022, table 2: grid-cell against object-frustum on one square kilometre of 30,000
// trees.
#pragma once

#include <string>
#include <vector>

#include "workbench/measure/compare.hpp"
#include "workbench/report/table.hpp"

namespace sightline::reproduce {

/// The paper's figures (GTX 1080 Ti, means of ten runs).
struct ObjectFrustumPublished {
  double cpu_ms, gpu_ms, fps;
};
inline constexpr ObjectFrustumPublished kPublishedGridCell{36.1, 18.1, 27.7};
inline constexpr ObjectFrustumPublished kPublishedObjectFrustum{24.9, 9.2, 40.2};

struct ObjectFrustumReproduction {
  measure::Comparison
      comparison;        ///< ten views: the camera in the middle at 8.9 m, level, turned by a tenth each run
  report::Table runs;    ///< kept, tested and culling time of both methods, a line a run, then the means
  report::Table ratios;  ///< ours beside the published
  double tested_share =
      0;  ///< of all objects, those that object-frustum tested one by one: the crossing cells'
};

/// The scene the paper describes.
Scene object_frustum_scene();

/// The ten views.
camera::CameraPath object_frustum_path(const Scene& scene);

/// The two methods, grid-cell first.
inline const std::vector<std::string> kObjectFrustumMethods{"grid-cell", "object-frustum"};

/// Ten runs of those on the bench, which is on the CPU; `quick` repeats each less often. Throws Error as
/// compare() does.
ObjectFrustumReproduction reproduce_object_frustum(measure::Bench& bench, bool quick,
                                                   const Progress& progress = {});

}  // namespace sightline::reproduce
