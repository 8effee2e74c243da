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

/// Distance along the ray to the box, 0 where the ray starts inside, -1 for a miss. Slab test (Kay & Kajiya
/// 1986) without NaNs: a ray along a face, in the face's plane, hits.
float intersect(const Ray& ray, const Box& box) noexcept;

}  // namespace sightline
