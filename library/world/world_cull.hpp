// The inner passes of culling a world: groups -> chunks -> objects, in SIMD.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/world.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/levels.hpp"

namespace sightline::world {

/// Bit p: the box crosses plane p of the view's frustum. No bit: it is inside. kOutside: the view misses it.
using PlaneSet = std::uint8_t;
inline constexpr PlaneSet kAllPlanes = 0x3f;
inline constexpr PlaneSet kOutside = 0x80;

struct CasterView;

/// One view as a sector sees it: relative to the sector's origin.
struct SectorView {
  std::array<Plane, Frustum::sides> planes;
  /// For each plane the sides of a box (as ChunkMap::Group orders them) farthest along its normal, and their
  /// opposites.
  std::array<std::array<std::uint8_t, 3>, Frustum::sides> near_side{}, far_side{};
  Vec3 eye;
  float area_scale = 0;  ///< π·(pixels per metre)² / min_area; 0: contribution is not tested
  bool orthographic = false;
  const occlusion::DepthTiles* occluders = nullptr;  ///< null: occlusion is not tested
  occlusion::EyeProjection projection;               ///< of the occluders' view, about the sector's origin
  std::uint32_t layers = kAllLayers;
  Vec3 distance_eye;  ///< from which distances are measured
  float distance_scale = 1;
  const CasterView* casters = nullptr;  ///< of every view, where one of them has casters
};

/// A bit an object of a chunk. Whole words are kept in registers and stored once: loads that gather what
/// several narrow stores have just written make processors wait.
struct alignas(16) ObjectBits {
  std::array<std::uint64_t, 2> words{};

  [[nodiscard]] bool at(std::size_t i) const { return words[i / 64] >> (i % 64) & 1; }
  void drop(std::size_t i) { words[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
  void keep(const ObjectBits& others) { words[0] &= others.words[0], words[1] &= others.words[1]; }
  void add(const ObjectBits& others) { words[0] |= others.words[0], words[1] |= others.words[1]; }
};
static_assert(ChunkMap::kCapacity <= 128);

[[nodiscard]] inline geometry::BoxSpan boxes_of(const ChunkMap::Group& group) noexcept {
  return geometry::span_of(group.bounds, group.count);
}

/// Of a group's chunks, a bit each: those of which a view may see an object by the columns, and of these
/// those of which it sees all.
struct ColumnBits {
  std::uint32_t some = 0, all = 0;
};

/// What layers and distances say. A world hands them to its cullers once it has such a column, so that who
/// has none need not link them.
struct ColumnTests {
  ColumnBits (*chunks)(const ChunkMap& map, std::uint32_t group, const SectorView& view);
  /// Of a chunk's objects those that the view sees; bits from its count on mean nothing.
  ObjectBits (*objects)(const ChunkMap& map, const ChunkMap::Group& group, const ChunkMap::ChunkView& chunk,
                        const SectorView& view);
};
extern const ColumnTests kLayerTests;     ///< of worlds that have no distances
extern const ColumnTests kDistanceTests;  ///< of both, where there are any

/// A group that some view may see.
struct GroupEntry {
  std::uint32_t sector = 0, group = 0;  ///< the sector as PassInput counts them
  std::array<PlaneSet, kMaxViews> planes{};
};

struct PassCounts {
  std::size_t written = 0;
  std::uint64_t tested = 0, chunks = 0, occluded = 0;
};

/// The maps and the views of a cull, of the sectors that some view may see; views lie sector by sector.
struct PassInput {
  std::span<const ChunkMap* const> maps;  ///< one a sector
  std::span<const SectorView> views;      ///< sectors × view_count
  std::size_t view_count = 1;
  /// Of each view, the bits of a mask: several where the caller's views are the same.
  std::array<std::uint8_t, kMaxViews> bits{};
  /// Of each entry and each of its views the chunks that are known to be hidden, a bit each; or none.
  std::span<const std::uint32_t> hidden = {};
  const ColumnTests* columns = nullptr;  ///< null: the world has none that say who is seen
  LevelNotes* levels = nullptr;          ///< null: nobody asks for levels of detail
};

/// What asking for chunks found.
struct ChunkTally {
  std::uint64_t asked = 0;   ///< chunks
  std::uint64_t hidden = 0;  ///< chunks
  std::uint64_t saved =
      0;  ///< objects that the views surely saw otherwise, once for each of the caller's views
  std::uint64_t left = 0;  ///< objects of chunks that are left, once for each view
};

/// Sorts the groups of a node: adds those that some view may see to `entries`. `views` are the sector's,
/// `planes` what each has still to be tested against.
void find_groups(const ChunkMap::Node& node, std::span<const SectorView> views,
                 std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                 std::vector<GroupEntry>& entries) noexcept;

/// Writes the visible objects of the entries; `out` and, where masks are wanted, `masks` have room for all
/// objects of the entries' groups and kCullPadding more.
PassCounts cull_groups(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* out,
                       std::uint8_t* masks) noexcept;
/// The same with all tests; cull_groups() calls it where some view has more than a frustum.
PassCounts cull_filtered_groups(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* out,
                                std::uint8_t* masks) noexcept;

/// Asks the views' occluders for the chunks of all entries, before any of their objects: writes PassInput's
/// `hidden`. A view without occluders hides nothing.
ChunkTally find_hidden_chunks(const PassInput& input, std::span<const GroupEntry> entries,
                              std::uint32_t* hidden) noexcept;

}  // namespace sightline::world
