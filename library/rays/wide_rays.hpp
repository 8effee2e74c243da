// The nearest box of each ray down the wide tree, eight boxes at once, nearest nodes first.
#pragma once

#include <span>

#include <sightline/jobs.hpp>
#include <sightline/rays.hpp>

#include "library/rays/ray_grid.hpp"
#include "library/rays/ray_hits.hpp"
#include "library/rays/wide_bvh.hpp"

namespace sightline::rays {

/// Waiting nodes, and which rays of a packet they wait for; reused, so that casting allocates nothing once it
/// has grown. One a thread.
struct WideStack {
  std::vector<std::uint64_t> entries;
  std::vector<std::uint32_t> rays;
  std::vector<std::uint32_t> alone;  ///< rays that nobody goes along with
};

/// Casts the rays whose indices stand in `order`, or all as they stand where it is empty; neighbours in that
/// order share their way down. Writes object[r] and distance[r] for each ray r with the meaning of RayHits,
/// and adds to `stats`. The same hits to the bit as testing every box, in any order.
void cast_wide(const rays::WideBvh& bvh, std::span<const PreparedRay> rays,
               std::span<const std::uint32_t> order, std::span<ObjectId> object, std::span<float> distance,
               WideStack& stack, RayStats& stats);

/// A whole grid, tile by tile, into a result that is reset first.
void cast_wide(const rays::WideBvh& bvh, const RayGrid& grid, WideStack& stack, RayHits& hits);

/// All rays in some order, shared out over at most jobs.threads jobs, one for each of `stacks` (at least
/// one): the same hits and statistics for any number of them.
void cast_wide(const rays::WideBvh& bvh, std::span<const PreparedRay> rays,
               std::span<const std::uint32_t> order, const JobSystem& jobs, std::span<WideStack> stacks,
               std::span<ObjectId> object, std::span<float> distance, RayStats& stats);

/// The same of a grid, into a result that is reset first.
void cast_wide(const rays::WideBvh& bvh, const RayGrid& grid, const JobSystem& jobs,
               std::span<WideStack> stacks, RayHits& hits);

}  // namespace sightline::rays
