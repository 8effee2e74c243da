// The nearest box of each ray, as Ye et al. 2023 find it: TOCA, BOCA, and the parts of the GPU methods that
// can run on any processor. All give the same hits to the bit: they share one slab test, and a tie goes to
// the lower id.
#pragma once

#include <span>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/rays.hpp>

#include "library/rays/bvh.hpp"
#include "library/rays/ray_hits.hpp"

namespace sightline::methods {

/// TOCA: every ray against every box.
void cast_at_all_boxes(const Boxes& boxes, std::span<const PreparedRay> rays, rays::RayHits& hits);

/// BOCA, section 2.3: every ray down the tree, to every leaf whose bounds it meets.
void cast_down_bvh(const rays::Bvh& bvh, std::span<const PreparedRay> rays, rays::RayHits& hits);

/// SAA, section 3.4.3, on the CPU: no stack; a hit goes to i + 1, a miss to i + 1 + descendants of i.
void cast_by_skip_counts(std::span<const rays::BvhNode> nodes, std::span<const PreparedRay> rays,
                         rays::RayHits& hits);

/// BVHA's first half: for each ray, the objects of the leaves that it meets. Those of ray r are
/// objects[first[r]] … objects[first[r + 1]).
struct Candidates {
  std::vector<std::uint32_t> first;
  std::vector<ObjectId> objects;
  std::uint64_t nodes = 0;  ///< tested
};
void collect_candidates(const rays::Bvh& bvh, std::span<const PreparedRay> rays, Candidates& candidates);

/// BVHA's second half: the nearest of each ray's candidates.
void cast_at_candidates(const Boxes& boxes, const Candidates& candidates, std::span<const PreparedRay> rays,
                        rays::RayHits& hits);

}  // namespace sightline::methods
