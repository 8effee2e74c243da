// The nearest box of each ray down the wide tree, eight boxes at once, nearest nodes first.
#pragma once

#include <span>

#include <sightline/ray.hpp>

#include "partition/wide_bvh.hpp"
#include "pvs/ray_hits.hpp"

namespace sightline::pvs {

/// Waiting nodes of one ray; reused, so that casting allocates nothing once it has grown. One a thread.
struct WideStack {
  std::vector<std::uint64_t> entries;
};

/// Writes object and distance of each ray, as many as there are rays, with the meaning of RayHits. Adds to
/// `stats`. The same hits to the bit as testing every box.
void cast_wide(const partition::WideBvh& bvh, std::span<const PreparedRay> rays, std::span<ObjectId> object,
               std::span<float> distance, WideStack& stack, RayStats& stats);

/// The same into a result that is reset first.
void cast_wide(const partition::WideBvh& bvh, std::span<const PreparedRay> rays, WideStack& stack,
               RayHits& hits);

}  // namespace sightline::pvs
