// What stands behind sightline::ShadowCasters, and a cull's way to it.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <sightline/shadows.hpp>
#include <sightline/world.hpp>

#include "library/world/camera_part.hpp"

namespace sightline::world {

struct CullerState;
struct DifferentViews;
struct ColumnTests;

/// What a culler keeps for views that have casters.
class Casting {
public:
  virtual ~Casting() = default;
  /// Prepares the state's views, which find_entries() has just made; returns what the passes are to ask of
  /// chunks and objects, the world's own columns with it.
  virtual const ColumnTests* prepare(CullerState& state, std::span<const CullView> views,
                                     const DifferentViews& different) = 0;
};

struct Casters;

/// Every ShadowCasters hands it to the culls it comes to, so that programs that have none need not link it.
struct CasterTools {
  Status (*check)(const Casters& casters, const WorldView& view, std::size_t index) noexcept;
  std::unique_ptr<Casting> (*make)();
};
extern const CasterTools kCasterTools;

struct Casters {
  /// A hexahedron and its extrusion have 12 faces; twice as many where rounding splits all.
  static constexpr std::size_t kMostPlanes = 24;

  const CasterTools* tools = &kCasterTools;
  WorldView shadow{{{}, {}, 1, 1}, {}}, camera;
  Depths depths;
  ShadowFilter filter;
  bool begun = false, receives = false;

  // About the shadow view's origin.
  std::array<WidePlane, kMostPlanes> planes;  ///< around the part, extruded: all casters reach into them
  std::size_t plane_count = 0;
  std::array<WidePlane, kMostPlanes> part_planes;  ///< around the part
  std::size_t part_plane_count = 0;
  glm::dvec3 part_min, part_max;

  /// At each pixel the nearness of the farthest receiver, as if that hid all behind it; +infinity where there
  /// is none.
  OcclusionBuffer mask;
  std::vector<float> of_objects, of_depth;
};

}  // namespace sightline::world

namespace sightline {

struct ShadowCasters::State : world::Casters {};

/// The way of the library's own to what casters hold.
struct ShadowAccess {
  static const world::Casters& casters(const ShadowCasters& casters) noexcept { return *casters.state_; }
};

}  // namespace sightline
