// A scene on the device: meshes, objects, boxes, and the one order in which objects are drawn.
#pragma once

#include <array>
#include <numeric>
#include <span>

#include <sightline/workbench/scene.hpp>

#include "workbench/device/buffer.hpp"
#include "workbench/device/shared.h"
#include "workbench/submission/draw_state.hpp"

namespace sightline::device {

/// Objects have slots in the order of drawing: state by state (submission::DrawState), in a state by mesh and
/// in a mesh by id; those that are blended, which are drawn far to near, come last. The order depends on the
/// scene alone, so that images in which equal depths meet are equal too, whatever subset is drawn. Objects of
/// one state and one mesh are a batch: one command draws them.
struct SceneBuffers {
  std::uint32_t objects = 0;
  std::uint32_t solid = 0, ordered = 0;    ///< slots of solid objects; of those and cut-outs
  std::array<std::uint32_t, 4> batches{};  ///< of each state but the last
  std::vector<ObjectId> transparent_ids;
  Buffer vertices, indices;
  Buffer object_data, box_data;              ///< by object
  Buffer mesh_data;                          ///< by batch, one after the last, then by mesh
  Buffer slot_objects, object_slots;         ///< object of each slot, slot of each object
  Buffer coordinates, images, alpha, looks;  ///< what cut-outs are tested by, and shared::LookBuffer

  SceneBuffers(Device& device, const Scene& scene);
  /// Sends what a move changes. Throws Error where a transform mirrors an object of front faces that it did
  /// not mirror before, or the reverse: it would have to be drawn among others.
  void update(Device& device, const Scene& scene, std::span<const ObjectId> moved);

  [[nodiscard]] std::uint32_t batch_count() const noexcept {
    return std::accumulate(batches.begin(), batches.end(), 0u);
  }
  [[nodiscard]] bool is_solid(ObjectId object) const noexcept { return slots_[object] < solid; }
  /// Below batch_count(); of an object that is not blended.
  [[nodiscard]] std::uint32_t batch_of(ObjectId object) const noexcept { return batch_of_[object]; }

private:
  std::vector<ObjectId> sort_objects(const Scene& scene);
  std::vector<shared::MeshData> make_table(const Scene& scene, std::span<const ObjectId> order);
  void upload_looks(Device& device, const Scene& scene);
  [[nodiscard]] shared::ObjectData data_of(const Scene& scene, ObjectId object) const;

  std::vector<std::uint32_t> slots_, batch_of_;
  std::vector<submission::DrawState> states_;  ///< by object
  Buffer staging_;
};

/// What an object is painted with: RGBA, 8 bits each, red lowest.
std::uint32_t colour_of(ObjectId object, Surface surface) noexcept;

/// The box with half extents rounded up, so that it still holds what it held.
shared::BoxData box_data(const Box& box, float radius) noexcept;
shared::BoxData box_data(const Scene& scene, ObjectId object) noexcept;

}  // namespace sightline::device
