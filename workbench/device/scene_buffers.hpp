// A scene on the device: meshes, objects, boxes, and the one order in which opaque objects are drawn.
#pragma once

#include <span>

#include <sightline/workbench/scene.hpp>

#include "workbench/device/buffer.hpp"
#include "workbench/device/shared.h"

namespace sightline::device {

/// Opaque objects have slots 0 … opaque - 1, grouped by mesh and ascending by id within one; transparent
/// objects have the slots after them. The order depends on the scene alone, so that images in which equal
/// depths meet are equal too, whatever subset is drawn.
struct SceneBuffers {
  std::uint32_t objects = 0, opaque = 0, meshes = 0;
  std::vector<ObjectId> transparent_ids;
  Buffer vertices, indices;
  Buffer object_data, box_data, mesh_data;  ///< by object, by object, by mesh (and one after the last)
  Buffer slot_objects;                      ///< object of each slot

  SceneBuffers(Device& device, const Scene& scene);
  /// Sends what a move changes.
  void update(Device& device, const Scene& scene, std::span<const ObjectId> moved);

private:
  std::vector<std::uint32_t> slots_;
  Buffer staging_;
};

/// What an object is painted with: RGBA, 8 bits each, red lowest.
std::uint32_t colour_of(ObjectId object, Surface surface) noexcept;

/// The box with half extents rounded up, so that it still holds what it held.
shared::BoxData box_data(const Box& box, float radius) noexcept;
shared::BoxData box_data(const Scene& scene, ObjectId object) noexcept;

}  // namespace sightline::device
