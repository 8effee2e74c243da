// What an inspection asks of a group of chunks, in SIMD.
#pragma once

#include <array>
#include <cstdint>

#include <sightline/inspect.hpp>

#include "library/world/columns.hpp"
#include "library/world/world_cull.hpp"

namespace sightline::world {

/// Of a group's chunks, a bit each: those of which a view may see something, and those of which it sees all.
struct ChunkSight {
  std::uint32_t seen = 0, whole = 0;
};

/// Adds to the stats what view `view` of the input does with the entry.
ChunkSight inspect_group(const PassInput& input, const Columns& columns, const GroupEntry& entry,
                         std::size_t view, ViewStats& stats) noexcept;

}  // namespace sightline::world
