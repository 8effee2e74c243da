#include "workbench/device/scene_buffers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sightline::device {

namespace {

shared::ObjectData object_data_of(const Scene& scene, ObjectId object, std::uint32_t slot) {
  const Affine& transform = scene.transform[object];
  const Surface surface = scene.surface[object];
  return {{transform.rows[0], transform.rows[1], transform.rows[2]},
          scene.mesh[object],
          colour_of(object, surface),
          surface == Surface::transparent,
          slot};
}

}  // namespace

// Distinct calm colours: the golden ratio walks the hue, two bits of the id the lightness.
std::uint32_t colour_of(ObjectId object, Surface surface) noexcept {
  const float hue = 6 * std::fmod(0.618034f * static_cast<float>(object % 65536), 1.0f);
  const float value = 0.62f + 0.08f * static_cast<float>(object * 2654435761u >> 30);
  const auto channel = [&](float shift) {
    const float k = std::fmod(shift + hue, 6.0f);
    const float strength = 1 - 0.45f * std::clamp(std::min(k, 4 - k), 0.0f, 1.0f);
    return static_cast<std::uint32_t>(255 * value * strength);
  };
  const std::uint32_t alpha = surface == Surface::transparent ? 140 : 255;
  return channel(5) | channel(3) << 8 | channel(1) << 16 | alpha << 24;
}

shared::BoxData box_data(const Box& box, float radius) noexcept {
  const auto centre = [](float low, float high) { return 0.5f * low + 0.5f * high; };
  const auto half = [](float low, float middle, float high) {
    const float reach = std::max(high - middle, middle - low);
    return std::nextafter(reach, std::numeric_limits<float>::infinity());
  };
  const Vec3 c{centre(box.min.x, box.max.x), centre(box.min.y, box.max.y), centre(box.min.z, box.max.z)};
  return {
      {c.x, c.y, c.z, radius},
      {half(box.min.x, c.x, box.max.x), half(box.min.y, c.y, box.max.y), half(box.min.z, c.z, box.max.z), 0}};
}

shared::BoxData box_data(const Scene& scene, ObjectId object) noexcept {
  return box_data(scene.bounds[object], scene.radius[object]);
}

SceneBuffers::SceneBuffers(Device& device, const Scene& scene)
    : objects(static_cast<std::uint32_t>(scene.size())),
      meshes(static_cast<std::uint32_t>(scene.meshes.size())) {
  std::vector<Vec3> interleaved;
  interleaved.reserve(2 * scene.positions.size());
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    interleaved.push_back(scene.positions[i]);
    interleaved.push_back(scene.normals[i]);
  }
  vertices = upload(device, interleaved, "vertices");
  indices = upload(device, scene.indices, "indices");

  std::vector<ObjectId> order;
  order.reserve(objects);
  for (ObjectId object = 0; object < objects; ++object) {
    (scene.surface[object] == Surface::transparent ? transparent_ids : order).push_back(object);
  }
  opaque = static_cast<std::uint32_t>(order.size());
  std::ranges::stable_sort(order, {}, [&](ObjectId object) { return scene.mesh[object]; });

  std::vector<shared::MeshData> mesh_table(scene.meshes.size() + 1);
  for (std::size_t mesh = 0, slot = 0; mesh <= scene.meshes.size(); ++mesh) {
    mesh_table[mesh].first_slot = static_cast<std::uint32_t>(slot);
    if (mesh == scene.meshes.size()) break;
    const Mesh& from = scene.meshes[mesh];
    mesh_table[mesh].first_index = from.first_index;
    mesh_table[mesh].index_count = from.index_count;
    mesh_table[mesh].first_vertex = static_cast<std::int32_t>(from.first_vertex);
    while (slot < order.size() && scene.mesh[order[slot]] == mesh) ++slot;
  }
  order.insert(order.end(), transparent_ids.begin(), transparent_ids.end());
  slots_.resize(objects);
  for (std::uint32_t slot = 0; slot < objects; ++slot) slots_[order[slot]] = slot;

  std::vector<shared::ObjectData> data(objects);
  std::vector<shared::BoxData> boxes(objects);
  for (ObjectId object = 0; object < objects; ++object) {
    data[object] = object_data_of(scene, object, slots_[object]);
    boxes[object] = device::box_data(scene, object);
  }
  object_data = upload(device, data, "objects");
  box_data = upload(device, boxes, "bounding boxes");
  mesh_data = upload(device, mesh_table, "meshes");
  slot_objects = upload(device, order, "the order of drawing");
}

void SceneBuffers::update(Device& device, const Scene& scene, std::span<const ObjectId> moved) {
  if (moved.empty()) return;
  constexpr std::size_t kEach = sizeof(shared::ObjectData) + sizeof(shared::BoxData);
  if (staging_.size() < moved.size() * kEach)
    staging_ = Buffer(device, moved.size() * kEach, Memory::upload, "moved objects");
  auto* data = staging_.mapped<shared::ObjectData>();
  auto* boxes = reinterpret_cast<shared::BoxData*>(data + moved.size());
  std::vector<vk::BufferCopy> data_regions, box_regions;
  data_regions.reserve(moved.size());
  box_regions.reserve(moved.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    data[i] = object_data_of(scene, moved[i], slots_[moved[i]]);
    boxes[i] = device::box_data(scene, moved[i]);
    data_regions.push_back({i * sizeof *data, moved[i] * sizeof *data, sizeof *data});
    box_regions.push_back(
        {moved.size() * sizeof *data + i * sizeof *boxes, moved[i] * sizeof *boxes, sizeof *boxes});
  }
  device.run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(staging_.handle(), object_data.handle(), data_regions);
    commands.copyBuffer(staging_.handle(), box_data.handle(), box_regions);
    full_barrier(commands);
  });
}

}  // namespace sightline::device
