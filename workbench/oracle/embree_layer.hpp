// One Embree scene over some of the objects, and whom a hit belongs to.
#pragma once

#include <embree3/rtcore.h>

#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::oracle {

/// Meshes shown once go in as their world triangles, shared ones as instances.
class EmbreeLayer {
public:
  EmbreeLayer(RTCDevice device, const Scene& scene, std::span<const ObjectId> objects,
              std::span<const RTCScene> mesh_scenes);
  ~EmbreeLayer();
  EmbreeLayer(const EmbreeLayer&) = delete;
  EmbreeLayer& operator=(const EmbreeLayer&) = delete;

  [[nodiscard]] RTCScene handle() const noexcept { return top_; }
  [[nodiscard]] bool empty() const noexcept { return triangle_object_.empty() && instance_object_.empty(); }
  [[nodiscard]] ObjectId object_of(unsigned instance, unsigned triangle) const noexcept {
    return instance == RTC_INVALID_GEOMETRY_ID ? triangle_object_[triangle] : instance_object_[instance - 1];
  }
  /// Whether some object of the layer is drawn from its front alone.
  [[nodiscard]] bool has_sides() const noexcept { return has_sides_; }
  /// Whether a triangle of the object is drawn where its normal, as Embree tells it, has that product with
  /// the ray: an instance's triangles are met in mesh space, the rest in world space, where a mirror turns
  /// them.
  [[nodiscard]] bool is_drawn(ObjectId object, unsigned instance, float along) const noexcept {
    if (scene_.sides[object] == Sides::both) return true;
    const bool turned = instance == RTC_INVALID_GEOMETRY_ID && mirrored_[object] != 0;
    return turned ? along > 0 : along < 0;
  }

  /// Takes over the new transforms of those objects that are in this layer.
  void move(std::span<const ObjectId> objects);

private:
  void add_triangles(RTCDevice device, std::span<const ObjectId> objects);
  void add_instance(RTCDevice device, ObjectId object, RTCScene mesh_scene);
  void place(ObjectId object);

  struct Place {
    std::uint32_t first_vertex = 0;  ///< in the world triangles
    unsigned instance = RTC_INVALID_GEOMETRY_ID;
    bool here = false;
  };

  const Scene& scene_;
  RTCScene top_ = nullptr;
  RTCGeometry triangles_ = nullptr;
  Vec3* vertices_ = nullptr;
  std::vector<ObjectId> triangle_object_, instance_object_;
  std::vector<std::uint8_t> mirrored_;  ///< one an object of the whole scene
  bool has_sides_ = false;
  std::vector<RTCGeometry> instances_;
  std::vector<Place> places_;  ///< one an object of the whole scene
};

/// Whether a transform can carry an instance: Embree inverts it in single precision.
bool can_instance(const Affine& transform) noexcept;

/// An Embree scene of each mesh that more than one object shows, null for the rest.
std::vector<RTCScene> build_mesh_scenes(RTCDevice device, const Scene& scene);

}  // namespace sightline::oracle
