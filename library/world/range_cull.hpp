// The inner passes of culling a world into ranges: groups -> chunks -> runs of objects, in SIMD.
#pragma once

#include <cstdint>
#include <span>

#include <sightline/ranges.hpp>

#include "library/world/world_cull.hpp"

namespace sightline::world {

/// What the passes read besides a cull's own input.
struct RangeInput {
  PassInput pass;
  /// Of each of its maps the slots of object 0, by chunk.
  std::span<const std::uint32_t* const> first_slots;
  bool whole_chunks = false;
};

struct RangeCounts {
  std::size_t written = 0;  ///< ranges
  std::uint64_t objects = 0, tested = 0, chunks = 0, occluded = 0;
};

/// Writes the visible ranges of the entries, no two of which could be one, and their masks where `masks` is
/// not null; both have room for all objects of the entries' groups.
RangeCounts cull_ranges(const RangeInput& input, std::span<const GroupEntry> entries, SlotRange* out,
                        std::uint8_t* masks) noexcept;

}  // namespace sightline::world
