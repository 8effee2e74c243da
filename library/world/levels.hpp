// Levels of detail: which table each object has, and what a cull's passes note of them.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <sightline/world.hpp>

#include "library/geometry/aligned_vector.hpp"
#include "library/world/chunk_map.hpp"

namespace sightline::world {

struct CullerState;
struct DifferentViews;
struct GroupEntry;
struct LaneBlocks;
struct NotedChunk;
struct PassCounts;
struct PassInput;
struct SectorView;

/// Has the passes tell it of the objects that they write, chunk by chunk.
class LevelNotes {
public:
  virtual ~LevelNotes() = default;
  /// What cull_groups() does: cull_noted(). Virtual, so that programs without levels need not link it.
  virtual PassCounts cull(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* ids,
                          std::uint8_t* masks) noexcept = 0;
  /// What is remembered of the lanes of a pool of the input's sector, if anything is.
  virtual LaneBlocks blocks_of(std::uint32_t sector, std::uint32_t pool) noexcept = 0;
  /// Asks for the memory that note() will need; `blocks` are of the chunk's lanes.
  virtual void expect(const ChunkMap::ChunkView& chunk, const LaneBlocks& blocks) noexcept = 0;
  virtual void note(const NotedChunk& chunk) noexcept = 0;
};

/// What a culler remembers of levels.
class LevelMemory {
public:
  virtual ~LevelMemory() = default;
};

/// A world has it once it has a table, so that programs without levels need not link it.
class Levels {
public:
  virtual ~Levels() = default;
  /// Of an id that is new or used again, takes away what its last object had.
  virtual void forget(ObjectId object) = 0;
  /// Before anything else: whether the options are sound for so many views.
  [[nodiscard]] virtual Status check(const LevelOptions& options, std::size_t views) const noexcept = 0;
  /// Before the passes: prepares the state's input.
  virtual void begin(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
                     const LevelOptions& options, const CullOutput& output) = 0;
  /// After them: writes what they noted of the output's first ids.
  virtual void write(const CullerState& state, std::size_t count,
                     const CullOutput& output) const noexcept = 0;
};

/// A table, ready for comparing.
struct LevelTable {
  std::array<float, kMaxLevels> sizes{};  ///< descending; behind the last one 0, which all objects reach
};

/// What stands behind World::add_levels() and set_levels().
class WorldLevels final : public Levels {
public:
  void forget(ObjectId object) override;
  [[nodiscard]] Status check(const LevelOptions& options, std::size_t views) const noexcept override;
  void begin(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
             const LevelOptions& options, const CullOutput& output) override;
  void write(const CullerState& state, std::size_t count, const CullOutput& output) const noexcept override;

  /// An object's.
  [[nodiscard]] const LevelTable& table(ObjectId object) const noexcept {
    return tables[object < table_of.size() ? table_of[object] : 0];
  }

  /// Gives an id a table.
  void set(ObjectId object, LevelTableId table);
  /// Unlike any other's at any time, as long as no id's table changes but those of changed().
  [[nodiscard]] std::uint64_t edition() const noexcept { return edition_; }
  /// The ids whose tables have changed since the edition came to be, in this order, and some twice.
  [[nodiscard]] std::span<const ObjectId> changed() const noexcept { return changed_; }

  /// The first has no levels but 0.
  std::vector<LevelTable> tables{LevelTable{}};
  geometry::LargeVector<std::uint16_t> table_of;  ///< one an id, or fewer: 0 behind

private:
  std::uint64_t edition_ = 0;
  std::vector<ObjectId> changed_;
};

/// How large objects are on the image that chooses levels, and how they fade.
struct LevelScale {
  bool orthographic = false;
  float squared = 0;  ///< (2 · pixels a metre · the options' scale)²
  float fade = 0;
  bool operator==(const LevelScale&) const = default;
};
LevelScale level_scale(const WorldView& view, const LevelOptions& options) noexcept;
/// Whether the options' view is one of so many, and their fade and scale are sound.
Status check_level_sizes(const LevelOptions& options, std::size_t views) noexcept;
/// From 0, above the band over a level's lower end, to 255 at it; 0 where there is no band.
std::uint8_t fade_at(float size, float end, float fade) noexcept;

/// The sizes in pixels of all of a chunk's objects, by their bounding spheres: the root of
/// scale.squared·(radius / distance)², in an orthographic view without the distance; infinite around the eye.
void find_sizes(const ChunkMap::ChunkView& chunk, const Vec3& eye, const LevelScale& scale,
                float* sizes) noexcept;
/// Asks for the memory that it reads of 16 objects from `first` on.
void expect_sizes(const ChunkMap::ChunkView& chunk, std::size_t first) noexcept;

}  // namespace sightline::world
