// A flat region in few triangles.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace sightline::occlusion {

/// A region of a plane, as the triangles that it is made of and the edges that bound it: it lies to their
/// left.
struct Outline2 {
  std::vector<std::uint32_t> vertex;  ///< the caller's number of each point
  std::vector<glm::dvec2> points;
  std::vector<double> heights;                                 ///< of the points, off the plane
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< of points
  std::vector<std::array<glm::dvec2, 3>> triangles;
};

/// Counter-clockwise triangles of its points that cover nothing but the region, but for twice the `rounding`
/// of its points, and all of it but for corners that stand out of straight edges by `tolerance`; empty where
/// its edges do not make simple outlines.
std::vector<std::array<std::uint32_t, 3>> triangulate(const Outline2& outline, double tolerance,
                                                      double rounding);

}  // namespace sightline::occlusion
