#include "workbench/partition/triangle_box.hpp"

#include <algorithm>

#include "library/geometry/linear.hpp"

namespace sightline::partition {

bool overlaps(const std::array<Vec3, 3>& triangle, const Box& box) noexcept {
  using geometry::to_double;
  const glm::dvec3 low = to_double(box.min), high = to_double(box.max);
  const glm::dvec3 centre = 0.5 * (low + high), half = 0.5 * (high - low);
  const std::array corners{to_double(triangle[0]) - centre, to_double(triangle[1]) - centre,
                           to_double(triangle[2]) - centre};
  const auto separates = [&](const glm::dvec3& axis) {
    const double a = glm::dot(axis, corners[0]), b = glm::dot(axis, corners[1]),
                 c = glm::dot(axis, corners[2]);
    const double reach = glm::dot(glm::abs(axis), half);
    // Products of a few rounded terms: far more room than they can lose.
    const double room = 1e-12 * (reach + std::max({std::fabs(a), std::fabs(b), std::fabs(c)}));
    return std::min({a, b, c}) > reach + room || std::max({a, b, c}) < -reach - room;
  };
  constexpr std::array kAxes{glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0}, glm::dvec3{0, 0, 1}};
  if (std::ranges::any_of(kAxes, separates)) return false;
  const std::array edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  if (separates(glm::cross(edges[0], edges[1]))) return false;
  for (const glm::dvec3& edge : edges) {
    for (const glm::dvec3& axis : kAxes) {
      if (separates(glm::cross(axis, edge))) return false;
    }
  }
  return true;
}

}  // namespace sightline::partition
