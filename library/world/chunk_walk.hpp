// From the whole ground down to the chunks that a frustum does not miss.
#pragma once

#include <cstdint>
#include <vector>

#include "library/world/chunk_map.hpp"

namespace sightline::world {

/// What a walk of the regions leaves, reused frame after frame.
struct ChunkWalk {
  std::vector<std::uint32_t> inside;    ///< chunks wholly in the frustum
  std::vector<std::uint32_t> crossing;  ///< chunks whose bounds cross it
  std::uint64_t nodes_visited = 0;      ///< regions, groups and chunks looked at

  void clear() noexcept {
    inside.clear();
    crossing.clear();
    nodes_visited = 0;
  }
};

/// Walks the regions from the whole ground down and drops what the frustum misses; the same chunks in the
/// same order for the same history of the map. Fills `out` anew.
void walk(const ChunkMap& map, const Frustum& frustum, ChunkWalk& out);

}  // namespace sightline::world
