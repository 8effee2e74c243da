// What a world's objects carry: occluders that they share, and triangles of their own.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/world.hpp>

#include "library/occlusion/depth_tiles.hpp"

namespace sightline::world {

inline constexpr std::uint32_t kNothing = 0xffffffffu;

/// An occluder that objects share, in its own space.
struct OccluderShape {
  OccluderMesh all;        ///< its triangles
  OccluderMesh own;        ///< those of them that do not lie inside, where others do
  OccluderMesh turned;     ///< its boxes as triangles, for placements that do not keep them along the axes
  std::vector<Box> boxes;  ///< drawn where there are no triangles
  std::vector<Sphere> spheres;
  Box bounds;
  bool some_inside = false;  ///< some of its triangles lie inside
  std::uint32_t carriers = 0;
  bool used = false;

  /// What objects show that the near plane cuts.
  [[nodiscard]] const OccluderMesh& shown() const noexcept { return some_inside ? own : all; }
};

/// What picking reads of a carrier: a sphere around its occluder, in metres.
struct CarrierBrief {
  WorldPoint centre;
  float radius = 0;
  OccluderId occluder = kNoOccluder;  ///< kNoOccluder: switched off
  ObjectId object = kNoObject;
  bool along_axes = false;  ///< whether the placement keeps boxes along the axes
};

/// An object that carries an occluder.
struct Carrier {
  ObjectId object = kNoObject;
  OccluderPlacement placement;
  WorldBox bounds;      ///< of the occluder as it is placed
  WorldBox object_box;  ///< as stored when it was placed
};

/// An object's triangles.
struct ObjectTriangles {
  std::vector<occlusion::TriangleBlock> blocks;
  std::uint32_t count = 0;
  Sides sides = Sides::both;  ///< from which each is seen
  WorldPoint origin;
  WorldBox bounds;
  WorldBox object_box;  ///< as stored when they were set
};

class Hiding;
struct WorldState;

/// A world has none before its first occluder or triangles. What a culler and a world without any call is
/// virtual, so that programs that never have any need not link it.
struct WorldOccluders {
  std::vector<OccluderShape> shapes;
  std::vector<std::uint32_t> free_shapes;
  std::vector<Carrier> carriers;
  std::vector<CarrierBrief> briefs;  ///< one a carrier
  std::vector<std::uint32_t> free_carriers;
  std::vector<std::uint32_t> carrier_of;  ///< by id, kNothing for none; ids beyond its end carry nothing
  std::vector<ObjectTriangles> triangles;
  std::vector<std::uint32_t> free_triangles;
  std::vector<std::uint32_t> triangles_of;  ///< the same
  std::uint64_t triangle_count = 0;         ///< of all objects

  [[nodiscard]] std::uint32_t carrier(ObjectId id) const noexcept {
    return id < carrier_of.size() ? carrier_of[id] : kNothing;
  }
  [[nodiscard]] std::uint32_t triangle_set(ObjectId id) const noexcept {
    return id < triangles_of.size() ? triangles_of[id] : kNothing;
  }
  virtual ~WorldOccluders();
  /// To be called of every object that is removed.
  virtual void forget(ObjectId id) noexcept;
  /// What a culler hides by what stands here.
  [[nodiscard]] virtual std::unique_ptr<Hiding> make_hiding() const;

  /// Whether some object carries an occluder.
  [[nodiscard]] bool any() const noexcept { return carriers.size() > free_carriers.size(); }

  void place(const WorldState& world, ObjectId id, const OccluderPlacement& placement);
  void take_away(ObjectId id) noexcept;
  void set_triangles(const WorldState& world, ObjectId id, std::span<const Vec3> corners,
                     const WorldPoint& origin, Sides sides);
  void take_triangles(ObjectId id) noexcept;
};

/// Whether what an object was given stands where the object does: it has not moved since, and what was placed
/// about `origin` within `bounds` lies in its box, but for what rounding may have done.
bool stands(const WorldBox& bounds, const WorldPoint& origin, const WorldBox& when_given,
            const WorldBox& box) noexcept;

}  // namespace sightline::world
