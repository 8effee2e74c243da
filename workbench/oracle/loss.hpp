// What a method lost and what it kept in vain, measured against the item buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/view.hpp>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/item_buffer.hpp"

namespace sightline::oracle {

struct Loss {
  std::vector<ObjectId> lost;    ///< visible in truth, not in the method's set; ascending
  std::vector<ObjectId> excess;  ///< kept though no pixel shows it; ascending
  std::uint64_t lost_pixels = 0;
};

/// Compares a method's visible set with the truth. Throws Error where the set names an object twice or one
/// that is not in the scene, which no method may.
Loss compare_to_truth(const ItemBuffer& truth, std::span<const ObjectId> visible);

/// The same, counting as lost only objects that a second look at the view sees, too, and of their pixels no
/// more than it does.
Loss confirmed_loss(const ItemBuffer& truth, const ItemBuffer& again, std::span<const ObjectId> visible);

/// The same, counting as lost only pixels that double precision confirms (EmbreeJudge::confirmed_pixels).
Loss confirmed_loss(const EmbreeJudge& judge, const View& view, const ItemBuffer& truth,
                    std::span<const ObjectId> visible);

}  // namespace sightline::oracle
