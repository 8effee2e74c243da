// What rays met: one result type for every way of casting them.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/boxes.hpp>

namespace sightline::rays {

struct RayStats {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t nodes = 0;  ///< bounds of inner nodes tested, rays × nodes; eight at once count as eight
  std::uint64_t boxes = 0;  ///< objects' boxes tested, rays × boxes
};

struct RayHits {
  std::vector<ObjectId>
      object;  ///< one a ray: the nearest, of equally near the lowest id; kNoObject for a miss
  std::vector<float> distance;  ///< one a ray: to it, 0 where the ray starts inside; -1 for a miss
  RayStats stats;

  /// Everything missed so far.
  void reset(std::size_t rays) {
    object.assign(rays, kNoObject);
    distance.assign(rays, -1);
    stats = {};
    stats.rays = rays;
  }
};

/// The potentially visible set: every object that a ray met, ascending. `seen` is scratch, one byte an
/// object.
inline void collect_visible(const RayHits& hits, std::size_t objects, std::vector<std::uint8_t>& seen,
                            std::vector<ObjectId>& visible) {
  seen.assign(objects, 0);
  for (const ObjectId object : hits.object) {
    if (object != kNoObject) seen[object] = 1;
  }
  visible.clear();
  for (std::size_t object = 0; object < objects; ++object) {
    if (seen[object]) visible.push_back(static_cast<ObjectId>(object));
  }
}

}  // namespace sightline::rays
