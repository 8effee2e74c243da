// A still chunk map as snapshots have it, and back.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <sightline/status.hpp>

#include "library/world/chunk_map.hpp"
#include "library/world/snapshot_format.hpp"

namespace sightline::world {

struct WorldState;

/// A sector on its way in: nothing of it depends on the world.
struct SectorPiece {
  std::unique_ptr<ChunkMap> map;    ///< has neither locations nor columns yet
  std::vector<std::uint32_t> rows;  ///< of each chunk, SnapshotRows' rows one after another
};

/// The way of snapshots to what a chunk map holds.
struct ChunkMapParts {
  using Chunk = ChunkMap::Chunk;
  using Split = ChunkMap::Split;

  /// Whether it is as the format has it: no movers, no holes, bounds tight and splits that lead to objects.
  static bool is_still(const ChunkMap& map) noexcept { return !map.loosely_; }
  /// The number in the format of each chunk, by its number in the map.
  static std::vector<std::uint32_t> order(const ChunkMap& map);
  /// Appends all words but the objects'; fills the entry's counts and root.
  static void write_shape(const ChunkMap& map, SectorEntry& entry, std::vector<std::uint32_t>& words);
  /// Calls with each chunk in the format's order.
  template <class Take>
  static void for_each_chunk(const ChunkMap& map, const Take& take) {
    for (const std::uint32_t g : map.nodes_[0].groups)
      for (std::uint32_t i = 0; i < map.groups_[g].count; ++i)
        take(map.groups_[g].chunks[i], map.chunk(map.groups_[g].chunks[i]));
  }

  /// Reads a sector whose checksum is right and whose entry is sound.
  static Status read(const SnapshotDirectory& directory, std::size_t sector, SectorPiece& piece);
  /// The map that was read becomes one of a world that holds its objects.
  static void join(ChunkMap& map, WorldState& state) noexcept;
  /// What a map takes of memory when it is read, and its columns; no more than 20 times its bytes.
  static std::size_t memory(const SectorEntry& entry, std::uint32_t columns) noexcept;

private:
  class Reader;
};

}  // namespace sightline::world
