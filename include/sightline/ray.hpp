// Rays and the slab test.
#pragma once

#include <limits>

#include <sightline/types.hpp>

namespace sightline {

struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< any length but zero; distances are in units of it
  float max_distance = std::numeric_limits<float>::infinity();
};

/// A ray as the slab test wants it. The one division a coordinate needs is done here, once, so that the test
/// itself is made of operations that every processor rounds alike.
struct PreparedRay {
  PreparedRay() = default;
  explicit PreparedRay(const Ray& ray) noexcept;

  Vec3 origin;
  Vec3 inverse;  ///< 1 / direction; 0 on an axis that the ray is parallel to (|direction| < 1e-37)
  float max_distance = std::numeric_limits<float>::infinity();
};

namespace detail {

// Narrows [entry, exit] by one slab; a ray parallel to it is inside or misses.
inline bool clip(float origin, float inverse, float low, float high, float& entry, float& exit) noexcept {
  if (inverse == 0) return origin >= low && origin <= high;
  const float a = (low - origin) * inverse, b = (high - origin) * inverse;
  const float first = a < b ? a : b, last = a < b ? b : a;
  entry = first > entry ? first : entry;
  exit = last < exit ? last : exit;
  return entry <= exit;
}

}  // namespace detail

/// Distance along the ray to the box, 0 where the ray starts inside, -1 for a miss. Slab test (Kay & Kajiya
/// 1986) without NaNs: a ray along a face, in the face's plane, hits.
///
/// The one definition that every ray method shares, on CPU and GPU. It is monotonic to the bit: a box that
/// holds another is hit by every ray that hits the other, at no greater distance.
inline float intersect(const PreparedRay& ray, const Box& box) noexcept {
  float entry = 0, exit = ray.max_distance;
  if (!detail::clip(ray.origin.x, ray.inverse.x, box.min.x, box.max.x, entry, exit)) return -1;
  if (!detail::clip(ray.origin.y, ray.inverse.y, box.min.y, box.max.y, entry, exit)) return -1;
  if (!detail::clip(ray.origin.z, ray.inverse.z, box.min.z, box.max.z, entry, exit)) return -1;
  return entry;
}

float intersect(const Ray& ray, const Box& box) noexcept;

}  // namespace sightline
