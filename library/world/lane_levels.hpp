// What a culler remembers of objects' levels: by the lanes in which they stand, so that a pass that reads a
// chunk's boxes reads its memory of them along with it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "library/geometry/aligned_vector.hpp"
#include "library/world/levels.hpp"
#include "library/world/world_cull.hpp"

namespace sightline::world {

inline constexpr std::size_t kLaneBlock = 16;

/// What a cull notes of the objects of 16 lanes, and reads of those whose levels cannot have changed.
struct LaneState {
  /// All that is written here holds until the eye has travelled as far, as the key measures its path.
  double still_until = 0;
  /// Of the options and tables with which it was chosen, and of the tables in LaneLimits; 0: none.
  std::uint32_t epoch = 0, edition = 0;
  std::uint16_t cull = 0;  ///< the last, as the key counts; 0: none
  std::uint16_t seen = 0;  ///< a bit a lane: in view at that
  std::array<std::uint8_t, kLaneBlock> level{}, fade{};
};

/// The limits by which they were chosen. All of it speaks of `ids`: of an object that has come to a lane
/// since, neither it nor the LaneState says anything.
struct alignas(64) LaneLimits {
  std::array<ObjectId, kLaneBlock> ids{};
  /// Of the table that an object had at `edition` the limits of its level: it is as large as the one, and
  /// less than the other.
  std::array<float, kLaneBlock> lower{}, upper{};
};

/// Both.
struct LaneBlock {
  LaneState& state;
  LaneLimits& limits;

  /// A level of a table.
  void set_level(std::size_t lane, const LevelTable& table, std::uint32_t level) const noexcept;
};

/// Gives an object another table, where the lane holds it; it keeps its level where it can.
void renew_table(const LaneBlock& block, std::size_t lane, ObjectId object, const LevelTable& table) noexcept;

/// Both, of the blocks from some lane on; null where nothing is remembered.
struct LaneBlocks {
  LaneState* states = nullptr;
  LaneLimits* limits = nullptr;
  bool unchanged = false;  ///< no object has come, gone or moved in their pool since the key's last cull

  [[nodiscard]] LaneBlocks from(std::size_t lane) const noexcept {
    return {states + lane / kLaneBlock, limits + lane / kLaneBlock, unchanged};
  }
};

/// A chunk that a pass has written.
struct NotedChunk {
  const ChunkMap::ChunkView& chunk;
  const SectorView* views;  ///< the sector's
  LaneBlocks blocks;        ///< of its lanes
  ObjectBits seen;          ///< those of its objects whose ids stand at `place`, in its order
  const ObjectId* place;
};

/// The level of an object that no longer stands where it was seen at a cull.
struct MovedLevel {
  std::uint16_t cull = 0;  ///< when that was; 0: never
  std::uint8_t level = 0;
};

/// One frame of one key: how levels are chosen.
struct LaneChoice {
  const WorldLevels* levels = nullptr;
  std::span<const MovedLevel> moved;  ///< one an id; or none, where nobody has moved since the last cull
  bool tables_changed = false;  ///< at this edition: then lanes may know old ones of whom they did not see
  std::uint32_t edition = 0;    ///< of the tables, never 0
  std::uint32_t epoch = 0;      ///< of the tables, and of all below but `travelled`; never 0
  /// This cull, and the one before it, if anything is remembered from there.
  std::uint16_t cull = 0, last = 0;
  LevelScale scale;
  float finer = 1, coarser = 1;  ///< times limits, for objects that were seen before
  double travelled = 0;          ///< the length in metres of the eye's path so far
};

/// What cull_groups() does, and tells the notes of it.
PassCounts cull_noted(LevelNotes& notes, const PassInput& input, std::span<const GroupEntry> entries,
                      ObjectId* ids, std::uint8_t* masks) noexcept;

/// Asks for what choose_levels() will read of the objects whose levels may change.
void expect_levels(const LaneChoice& choice, const ChunkMap::ChunkView& chunk,
                   const LaneBlocks& blocks) noexcept;

/// Chooses the levels of the objects. Writes behind `out` of each a level and, in the upper 8 bits, how far
/// it has faded, and whole vectors.
void choose_levels(const LaneChoice& choice, const NotedChunk& noted, const Vec3& eye,
                   std::uint16_t* out) noexcept;

}  // namespace sightline::world
