#include "workbench/oracle/embree_layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <sightline/workbench/error.hpp>

namespace sightline::oracle {
namespace {

void* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t item,
                 std::size_t count) {
  void* memory = rtcSetNewGeometryBuffer(geometry, type, 0, format, item, count);
  if (memory == nullptr)
    throw Error("item buffer: Embree has no memory for " + std::to_string(count) + " items");
  return memory;
}

std::uint32_t* index_buffer(RTCGeometry geometry, std::size_t triangles) {
  return static_cast<std::uint32_t*>(
      new_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles));
}

Vec3* vertex_buffer(RTCGeometry geometry, std::size_t vertices) {
  return static_cast<Vec3*>(
      new_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3), vertices));
}

}  // namespace

bool can_instance(const Affine& transform) noexcept {
  double scale = 0;
  for (const Vec4& row : transform.rows) {
    scale = std::max({scale, std::fabs(double{row.x}), std::fabs(double{row.y}), std::fabs(double{row.z})});
  }
  return std::fabs(determinant(transform)) > 1e-4 * scale * scale * scale;
}

std::vector<RTCScene> build_mesh_scenes(RTCDevice device, const Scene& scene) {
  std::vector<std::uint32_t> uses(scene.meshes.size());
  for (ObjectId object = 0; object < scene.size(); ++object) {
    if (can_instance(scene.transform[object])) ++uses[scene.mesh[object]];
  }
  std::vector<RTCScene> built(scene.meshes.size(), nullptr);
  for (std::size_t m = 0; m < built.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (uses[m] < 2 || mesh.index_count == 0) continue;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::copy_n(scene.positions.data() + mesh.first_vertex, mesh.vertex_count,
                vertex_buffer(geometry, mesh.vertex_count));
    std::copy_n(scene.indices.data() + mesh.first_index, mesh.index_count,
                index_buffer(geometry, mesh.index_count / 3));
    rtcCommitGeometry(geometry);
    built[m] = rtcNewScene(device);
    rtcSetSceneFlags(built[m], RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcAttachGeometry(built[m], geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(built[m]);
  }
  return built;
}

EmbreeLayer::EmbreeLayer(RTCDevice device, const Scene& scene, std::span<const ObjectId> objects,
                         std::span<const RTCScene> mesh_scenes)
    : scene_(scene), top_(rtcNewScene(device)), mirrored_(scene.size()), places_(scene.size()) {
  rtcSetSceneFlags(top_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  std::vector<ObjectId> single;
  for (const ObjectId object : objects) {
    has_sides_ |= scene.sides[object] == Sides::front;
    if (scene.meshes[scene.mesh[object]].index_count == 0) continue;
    RTCScene mesh_scene = mesh_scenes[scene.mesh[object]];
    if (mesh_scene != nullptr && can_instance(scene.transform[object])) {
      add_instance(device, object, mesh_scene);
    } else {
      single.push_back(object);
    }
  }
  if (!single.empty()) add_triangles(device, single);
  rtcCommitScene(top_);
}

EmbreeLayer::~EmbreeLayer() {
  for (RTCGeometry instance : instances_) rtcReleaseGeometry(instance);
  if (triangles_ != nullptr) rtcReleaseGeometry(triangles_);
  rtcReleaseScene(top_);
}

void EmbreeLayer::add_triangles(RTCDevice device, std::span<const ObjectId> objects) {
  std::size_t vertices = 0, triangles = 0;
  for (const ObjectId object : objects) {
    vertices += scene_.meshes[scene_.mesh[object]].vertex_count;
    triangles += scene_.triangles(object);
  }
  triangles_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  vertices_ = vertex_buffer(triangles_, vertices);
  std::uint32_t* index = index_buffer(triangles_, triangles);
  triangle_object_.reserve(triangles);
  std::uint32_t first_vertex = 0;
  for (const ObjectId object : objects) {
    const Mesh& mesh = scene_.meshes[scene_.mesh[object]];
    places_[object] = {first_vertex, RTC_INVALID_GEOMETRY_ID, true};
    place(object);
    for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
      *index++ = scene_.indices[mesh.first_index + i] + first_vertex;
    }
    triangle_object_.insert(triangle_object_.end(), mesh.index_count / 3, object);
    first_vertex += mesh.vertex_count;
  }
  rtcCommitGeometry(triangles_);
  rtcAttachGeometryByID(top_, triangles_, 0);
}

void EmbreeLayer::add_instance(RTCDevice device, ObjectId object, RTCScene mesh_scene) {
  RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, mesh_scene);
  instances_.push_back(instance);
  instance_object_.push_back(object);
  const auto id = static_cast<unsigned>(instances_.size());  // 0 is the world triangles'
  places_[object] = {0, id, true};
  place(object);
  rtcAttachGeometryByID(top_, instance, id);
}

// Writes an object's transform where Embree reads it.
void EmbreeLayer::place(ObjectId object) {
  const Affine& transform = scene_.transform[object];
  const Place& at = places_[object];
  mirrored_[object] = mirrors(transform);
  if (at.instance == RTC_INVALID_GEOMETRY_ID) {
    const Mesh& mesh = scene_.meshes[scene_.mesh[object]];
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      vertices_[at.first_vertex + v] = transform_point(transform, scene_.positions[mesh.first_vertex + v]);
    }
    return;
  }
  std::array<float, 12> rows;
  std::memcpy(rows.data(), transform.rows.data(), sizeof rows);
  RTCGeometry instance = instances_[at.instance - 1];
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows.data());
  rtcCommitGeometry(instance);
}

void EmbreeLayer::move(std::span<const ObjectId> objects) {
  bool moved = false, triangles_moved = false;
  for (const ObjectId object : objects) {
    if (!places_[object].here) continue;
    if (places_[object].instance != RTC_INVALID_GEOMETRY_ID && !can_instance(scene_.transform[object])) {
      throw Error("item buffer: object " + std::to_string(object) +
                  " was moved by a singular transform, expected one that can be inverted");
    }
    place(object);
    moved = true;
    triangles_moved |= places_[object].instance == RTC_INVALID_GEOMETRY_ID;
  }
  if (triangles_moved) {
    rtcUpdateGeometryBuffer(triangles_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(triangles_);
  }
  if (moved) rtcCommitScene(top_);
}

}  // namespace sightline::oracle
