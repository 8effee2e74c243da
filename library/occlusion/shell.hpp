// Closed surfaces of few triangles that lie inside a solid, or mostly so: proposals, which Solid::holds
// judges triangle by triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "library/occlusion/solid.hpp"
#include "library/occlusion/solid_grid.hpp"

namespace sightline::occlusion {

/// Triangles turn counter-clockwise as seen from outside.
struct Shell {
  std::vector<glm::dvec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  [[nodiscard]] Corners3 corners(std::size_t t) const {
    return {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
  }
};

/// The convex hull of some of the solid's points, the outermost ones, a little smaller than it is: inside a
/// convex solid, and close to it. Points that lie so close to the lid of a solid are not among them.
Shell convex_shell(const Solid& solid, std::size_t most_triangles, double from_lid = 0);

/// The surface a little below the solid's, as the grid sees it: thousands of triangles.
Shell grid_shell(const SolidGrid& grid);

/// Collapses edges until `most_triangles` are left or no more can go without leaving the solid (Garland &
/// Heckbert 1997, with new points that stay inside), then moves points outwards as far as they can go.
void simplify(const Solid& solid, double step, std::size_t most_triangles, Shell& shell);

}  // namespace sightline::occlusion
