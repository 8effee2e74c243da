#include <sightline/ray.hpp>

#include <algorithm>

namespace sightline {

namespace {

// Narrows [entry, exit] by one slab; a ray parallel to it is inside or misses, and divides by nothing.
bool clip(float origin, float direction, float low, float high, float& entry, float& exit) {
  if (direction == 0) return origin >= low && origin <= high;
  const float a = (low - origin) / direction, b = (high - origin) / direction;
  entry = std::max(entry, std::min(a, b));
  exit = std::min(exit, std::max(a, b));
  return entry <= exit;
}

}  // namespace

float intersect(const Ray& ray, const Box& box) noexcept {
  float entry = 0, exit = ray.max_distance;
  if (!clip(ray.origin.x, ray.direction.x, box.min.x, box.max.x, entry, exit)) return -1;
  if (!clip(ray.origin.y, ray.direction.y, box.min.y, box.max.y, entry, exit)) return -1;
  if (!clip(ray.origin.z, ray.direction.z, box.min.z, box.max.z, entry, exit)) return -1;
  return entry;
}

}  // namespace sightline
