#include "workbench/scene/vertex_normals.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::scene {

bool normalise(std::array<double, 3>& v) noexcept {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 1e-30) || !std::isfinite(length)) return false;
  for (double& x : v) x /= length;
  return true;
}

std::vector<Vec3> vertex_normals(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
  std::vector<std::array<double, 3>> sums(positions.size(), {0, 0, 0});
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::span<const std::uint32_t> corners = indices.subspan(i, 3);
    if (*std::max_element(corners.begin(), corners.end()) >= positions.size()) continue;
    const Vec3 &a = positions[corners[0]], &b = positions[corners[1]], &c = positions[corners[2]];
    const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
    const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
    const std::array<double, 3> normal{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
    for (const std::uint32_t corner : corners) {
      for (std::size_t axis = 0; axis < 3; ++axis) sums[corner][axis] += normal[axis];
    }
  }
  std::vector<Vec3> normals(positions.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    std::array<double, 3>& n = sums[i];
    if (!normalise(n)) n = {0, 1, 0};
    normals[i] = {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
  }
  return normals;
}

}  // namespace sightline::scene
