#include <sightline/ray.hpp>

#include <cmath>

namespace sightline {

PreparedRay::PreparedRay(const Ray& ray) noexcept : origin(ray.origin), max_distance(ray.max_distance) {
  // Below this the reciprocal would overflow.
  const auto invert = [](float d) { return std::fabs(d) < 1e-37f ? 0.0f : 1 / d; };
  inverse = {invert(ray.direction.x), invert(ray.direction.y), invert(ray.direction.z)};
}

float intersect(const Ray& ray, const Box& box) noexcept {
  return intersect(PreparedRay(ray), box);
}

}  // namespace sightline
