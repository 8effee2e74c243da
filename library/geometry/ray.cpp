#include <sightline/rays.hpp>

#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"

namespace sightline {

PreparedRay::PreparedRay(const Ray& ray) noexcept : origin(ray.origin), max_distance(ray.max_distance) {
  // Below this the reciprocal would overflow.
  const auto invert = [](float d) { return std::fabs(d) < 1e-37f ? 0.0f : 1 / d; };
  inverse = {invert(ray.direction.x), invert(ray.direction.y), invert(ray.direction.z)};
  // A ray of no numbers, as an extreme view or a mesh shrunk to next to nothing may give, would meet what is
  // not there, even the empty lanes of a wide node: from infinity along nothing it meets nothing.
  if (geometry::is_finite(ray.origin) && geometry::is_finite(ray.direction)) return;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  origin = {kFar, kFar, kFar};
  inverse = {0, 0, 0};
}

float intersect(const Ray& ray, const Box& box) noexcept {
  return intersect(PreparedRay(ray), box);
}

}  // namespace sightline
