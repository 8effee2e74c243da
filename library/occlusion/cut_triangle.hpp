// What a buffer in which a pixel's margin counts must know of triangles that the near plane cuts, in double
// precision.
#pragma once

#include <array>
#include <optional>

#include "library/occlusion/near_clip.hpp"

namespace sightline::occlusion {

/// Corners about the eye.
using ExactCorners = std::array<glm::dvec3, 3>;

glm::dvec3 about_eye(const EyeProjection& projection, const Vec3& point) noexcept;

struct CutTriangle {
  /// Whether the mesh goes on in it: no pixel can reach across what is left of it, whichever edge it enters
  /// by.
  bool counts = false;
  float slant = 0;  ///< how much its nearness changes over a pixel at most
};
CutTriangle cut_triangle(const DepthTiles& tiles, const ExactCorners& corners) noexcept;

/// A segment on the image, in pixels.
struct ImageSegment {
  std::array<float, 2> from, to;
  float play = 0;  ///< how far it may lie from there besides
};
/// What is before the near plane of a segment, and no farther beyond the image than that is wide or high;
/// nothing where all of it lies elsewhere.
std::optional<ImageSegment> in_view(const DepthTiles& tiles, const glm::dvec3& a,
                                    const glm::dvec3& b) noexcept;
/// Where the near plane cuts the triangle.
std::optional<ImageSegment> near_edge(const DepthTiles& tiles, const ExactCorners& corners) noexcept;

}  // namespace sightline::occlusion
