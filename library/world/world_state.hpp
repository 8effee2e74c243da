// What stands behind sightline::World: sectors, each a chunk map around a double-precision origin.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <unordered_map>
#include <vector>

#include <sightline/world.hpp>

#include "library/world/chunk_map.hpp"
#include "library/world/columns.hpp"
#include "library/world/levels.hpp"
#include "library/world/scattered_moves.hpp"
#include "library/world/world_occluders.hpp"

namespace sightline::world {

/// Metres. A float within half of it keeps 0.12 mm; and 10⁷ m are a whole number of sectors, as are all round
/// decimal distances from there on, so that a world shifted by one keeps its bits.
inline constexpr double kSectorSide = 3200;

// A sector is one region; methods on a device split the ground further.
inline constexpr auto kHalfSectorSide = static_cast<float>(kSectorSide / 2);
inline constexpr ChunkMapOptions kSectorMap{{{-kHalfSectorSide, -kHalfSectorSide, -kHalfSectorSide},
                                             {kHalfSectorSide, kHalfSectorSide, kHalfSectorSide}},
                                            0};

struct ColumnTests;

struct SectorCell {
  std::int64_t x = 0, y = 0, z = 0;
  bool operator==(const SectorCell&) const = default;
};

struct SectorCellHash {
  std::size_t operator()(const SectorCell& c) const noexcept {
    std::uint64_t h = 0;
    for (const std::int64_t v : {c.x, c.y, c.z}) {
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
};

struct Sector {
  WorldPoint origin;
  std::unique_ptr<ChunkMap> map;  ///< relative to the origin; null: the sector is free
  Box bounds;                     ///< the map's, kept here so that a cull need not fetch it from there
  bool touched = false;           ///< stands in WorldState::touched
  bool awake = false;             ///< stands in WorldState::awake
  /// The sector of a snapshot that this one is, unchanged since it came from there; or kNone.
  std::uint32_t snapshot = ChunkMap::kNone;
};

struct WorldState {
  std::vector<Sector> sectors;
  std::vector<std::uint32_t> free_sectors;
  std::unordered_map<SectorCell, std::uint32_t, SectorCellHash> sector_of_cell;
  /// One an id, shared by all sectors' maps; where the sector is kNone the id is free.
  ChunkMap::Locations objects;
  std::vector<ObjectId> free_ids;
  /// One an id, so that check_handles() reads little: the generation, but kUnknown of free ids and of greater
  /// ones; then `objects` is asked. Where there are no pages, none.
  geometry::LargeVector<std::uint8_t> generations;
  static constexpr std::uint8_t kUnknown = 0xff;
  Columns columns;
  const ColumnTests* column_tests = nullptr;  ///< null: no column says who is seen
  std::unique_ptr<WorldOccluders> occluders;  ///< null: never had any
  std::unique_ptr<Levels> levels;             ///< of detail; null: never had a table
  std::vector<std::uint32_t> touched;         ///< sectors that changed since tidy(), each once
  std::uint64_t tidied = 0;                   ///< how many sectors tidy() has looked at, ever
  std::uint64_t order_token = 0;              ///< of the ObjectOrder that followed last; 0: none did
  std::size_t size = 0;

  /// Whether anybody has culled since the last frame began: then the next change begins another.
  mutable std::atomic<bool> culled{false};
  std::uint16_t tick = 0;       ///< counts frames
  std::uint32_t allowance = 0;  ///< how many more objects may become movers in this frame for moving often
  std::vector<std::uint32_t> awake;  ///< sectors whose maps have something to rest, or had
  std::size_t awake_hand = 0;        ///< where let_rest() goes on
  static constexpr std::uint32_t kFewestAtRest = 64;

  std::unique_ptr<ScatteredMoves> scattered;  ///< null: moves always came in some order, or few

  /// Made if there are none.
  WorldOccluders& own_occluders();
  ScatteredMoves& scattered_moves();
  std::uint32_t sector_at(const SectorCell& cell);
  /// To be called of every sector whose objects change.
  void touch(std::uint32_t sector);
  /// To be called where its map alone does: what a snapshot holds of it stays true.
  void note_untidy(std::uint32_t sector);
  /// To be called of objects of which something changed that no map knows.
  void note_changed(const Strided<const Handle>& handles) noexcept;
  /// Shrinks bounds that changes left too large in the touched sectors, and frees those that they left empty;
  /// after insertions also puts chunks side by side.
  void tidy(bool after_insertions);
  /// To be called when a column that says who is seen has come to be, with an element for each id.
  void begin_column(const ColumnTests& tests);
  /// To be called when an object has come to be or is gone.
  void note_generation(ObjectId id);
  /// World::move, of what has been checked.
  void move(const Strided<const Handle>& handles, const BoxView& boxes);
  /// To be called by whoever culls: the next change begins a frame.
  void note_culled() const noexcept {
    if (!culled.load(std::memory_order_relaxed)) culled.store(true, std::memory_order_relaxed);
  }
  /// Counts frames; true where a new one begins.
  bool begin_frame();
  /// Lets some of the awake sectors' maps rest.
  void let_rest();
};

/// As many of the handles as there is room for copies, side by side: where they stand, or else copied.
std::span<const Handle> side_by_side(const Strided<const Handle>& handles, std::size_t first,
                                     std::span<Handle> copies) noexcept;
/// Whether all handles name objects of the world.
Status check_handles(const World& world, const Strided<const Handle>& handles) noexcept;
/// The object's box as stored.
WorldBox stored_box(const WorldState& state, ObjectId id) noexcept;

/// The sector that holds a box's centre.
SectorCell sector_cell(const WorldBox& box) noexcept;

}  // namespace sightline::world

namespace sightline {

struct World::State : world::WorldState {};

/// The way of the library's own to what a world holds.
struct WorldAccess {
  static const world::WorldState& state(const World& world) noexcept { return *world.state_; }
  static world::WorldState& state(World& world) noexcept { return *world.state_; }
};

}  // namespace sightline
