// Points beside views, in double precision and from the matrices alone.
#pragma once

#include <cmath>

#include <sightline/view.hpp>

#include "library/geometry/linear.hpp"

namespace sightline::test {

using geometry::to_double;

/// What the tests of shadows stand in.
inline constexpr Box kPlace{{-100, -20, -100}, {100, 20, 100}};

inline glm::dvec3 about(const WorldPoint& p, const WorldPoint& origin) {
  return {p.x - origin.x, p.y - origin.y, p.z - origin.z};
}

/// Where a point lies on the image: -1 … 1, y up, and its clip w in z; far outside for what is behind.
inline glm::dvec3 on_image(const WorldView& view, const WorldPoint& p) {
  const glm::dvec4 clip = to_double(view.view.eye_to_clip) * to_double(view.view.world_to_eye) *
                          glm::dvec4(about(p, view.origin), 1);
  if (!(clip.w > 0) || clip.z < 0 || clip.z > clip.w) return {9, 9, clip.w};
  return {clip.x / clip.w, clip.y / clip.w, clip.w};
}

inline bool is_seen(const WorldView& view, const WorldPoint& p) {
  const glm::dvec3 at = on_image(view, p);
  return std::fabs(at.x) <= 1 && std::fabs(at.y) <= 1;
}

/// Metres along the view.
inline double depth_along(const WorldView& view, const WorldPoint& p) {
  return -(to_double(view.view.world_to_eye) * glm::dvec4(about(p, view.origin), 1)).z;
}

}  // namespace sightline::test
