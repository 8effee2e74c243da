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
struct SectorView;

/// Told by the passes of the objects that they write, chunk by chunk.
class LevelNotes {
public:
  virtual ~LevelNotes() = default;
  /// `count` ids are some of the chunk's objects, in its order; `views` are the sector's.
  virtual void note(const ChunkMap::ChunkView& chunk, const SectorView* views, const ObjectId* ids,
                    std::size_t count) noexcept = 0;
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
  virtual void forget(ObjectId object) noexcept = 0;
  /// Before the passes: checks the options, and prepares the state's input.
  virtual Status begin(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
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
  void forget(ObjectId object) noexcept override;
  Status begin(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
               const LevelOptions& options, const CullOutput& output) override;
  void write(const CullerState& state, std::size_t count, const CullOutput& output) const noexcept override;

  /// An object's.
  [[nodiscard]] const LevelTable& table(ObjectId object) const noexcept {
    return tables[object < table_of.size() ? table_of[object] : 0];
  }

  /// The first has no levels but 0.
  std::vector<LevelTable> tables{LevelTable{}};
  geometry::LargeVector<std::uint16_t> table_of;  ///< one an id, or fewer: 0 behind
};

/// What a culler knows of an object's level.
struct KnownLevel {
  std::uint16_t cull = 0;  ///< when that was, as LevelMemory counts; 0: never
  std::uint8_t level = 0, fade = 0;
};

/// How large objects are on the image that chooses levels, and how they fade.
struct LevelScale {
  bool orthographic = false;
  float squared = 0;  ///< (2 · pixels a metre · the options' scale)²
  float fade = 0;
};
LevelScale level_scale(const WorldView& view, const LevelOptions& options) noexcept;
/// Whether the options' view is one of so many, and their fade and scale are sound.
Status check_level_sizes(const LevelOptions& options, std::size_t views) noexcept;
/// From 0, above the band over a level's lower end, to 255 at it; 0 where there is no band.
std::uint8_t fade_at(float size, float end, float fade) noexcept;

/// The sizes in pixels of all of a chunk's objects, by their bounding spheres: the root of
/// squared_scale·(radius / distance)², in an orthographic view without the distance; infinite around the eye.
void find_sizes(const ChunkMap::ChunkView& chunk, const Vec3& eye, bool orthographic, float squared_scale,
                float* sizes) noexcept;

}  // namespace sightline::world
