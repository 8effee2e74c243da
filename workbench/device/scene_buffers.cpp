#include "workbench/device/scene_buffers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <sightline/workbench/error.hpp>

#include "workbench/submission/draw_state.hpp"

namespace sightline::device {

namespace {

using submission::draw_state;
using submission::DrawState;

std::uint32_t look_of(const Scene& scene, ObjectId object) {
  std::uint32_t look = std::uint32_t{scene.alpha_cutoff[object]} << shared::kCutoffShift;
  if (scene.sides[object] == Sides::front) look |= shared::kFrontOnly;
  if (mirrors(scene.transform[object])) look |= shared::kMirrored;
  if (scene.surface[object] == Surface::cut_out) look |= shared::kCutOut;
  if (!submission::is_solid(draw_state(scene, object))) look |= shared::kSeeThrough;
  return look;
}

}  // namespace

shared::ObjectData SceneBuffers::data_of(const Scene& scene, ObjectId object) const {
  const Affine& transform = scene.transform[object];
  return {{transform.rows[0], transform.rows[1], transform.rows[2]},
          batch_count() + 1 + scene.mesh[object],
          colour_of(object, scene.surface[object]),
          look_of(scene, object),
          scene.alpha_image[object]};
}

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
    : objects(static_cast<std::uint32_t>(scene.size())), slots_(scene.size()), batch_of_(scene.size()) {
  std::vector<Vec3> interleaved;
  interleaved.reserve(2 * scene.positions.size());
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    interleaved.push_back(scene.positions[i]);
    interleaved.push_back(scene.normals[i]);
  }
  vertices = upload(device, interleaved, "vertices");
  indices = upload(device, scene.indices, "indices");

  const std::vector<ObjectId> order = sort_objects(scene);
  mesh_data = upload(device, make_table(scene, order), "meshes");
  slot_objects = upload(device, order, "the order of drawing");
  object_slots = upload(device, slots_, "places in the order of drawing");

  std::vector<shared::ObjectData> data(objects);
  std::vector<shared::BoxData> boxes(objects);
  for (ObjectId object = 0; object < objects; ++object) {
    data[object] = data_of(scene, object);
    boxes[object] = device::box_data(scene, object);
  }
  object_data = upload(device, data, "objects");
  box_data = upload(device, boxes, "bounding boxes");
  upload_looks(device, scene);
}

std::vector<ObjectId> SceneBuffers::sort_objects(const Scene& scene) {
  std::vector<ObjectId> order(objects);
  std::iota(order.begin(), order.end(), ObjectId{0});
  const auto key = [&](ObjectId object) {
    const DrawState state = draw_state(scene, object);
    return std::pair(state, state == DrawState::blended ? 0 : scene.mesh[object]);
  };
  std::ranges::stable_sort(order, {}, key);
  for (std::uint32_t slot = 0; slot < objects; ++slot) {
    const DrawState state = draw_state(scene, order[slot]);
    slots_[order[slot]] = slot;
    states_.push_back(draw_state(scene, slot));
    solid += submission::is_solid(state);
    ordered += state < DrawState::blended;
    if (state == DrawState::blended) transparent_ids.push_back(order[slot]);
  }
  return order;
}

std::vector<shared::MeshData> SceneBuffers::make_table(const Scene& scene, std::span<const ObjectId> order) {
  std::vector<shared::MeshData> table;
  const auto add = [&](const Mesh& mesh, std::uint32_t slot) {
    table.push_back({mesh.first_index, mesh.index_count, static_cast<std::int32_t>(mesh.first_vertex), slot});
  };
  for (std::uint32_t slot = 0; slot < ordered; ++slot) {
    const ObjectId object = order[slot];
    const DrawState state = draw_state(scene, object);
    const bool same = slot > 0 && scene.mesh[order[slot - 1]] == scene.mesh[object] &&
                      draw_state(scene, order[slot - 1]) == state;
    if (!same) {
      add(scene.meshes[scene.mesh[object]], slot);
      ++batches[static_cast<std::size_t>(state)];
    }
    batch_of_[object] = static_cast<std::uint32_t>(table.size() - 1);
  }
  add({}, ordered);
  for (const Mesh& mesh : scene.meshes) add(mesh, 0);
  return table;
}

void SceneBuffers::upload_looks(Device& device, const Scene& scene) {
  std::vector<shared::ImageData> table;
  std::vector<std::uint8_t> texels;
  for (const AlphaImage& image : scene.alpha_images) {
    table.push_back({static_cast<std::uint32_t>(texels.size()), image.width, image.height});
    texels.insert(texels.end(), image.alpha.begin(), image.alpha.end());
  }
  if (texels.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error("renderer: the alpha images of '" + scene.name + "' hold more than 2^32 texels");
  texels.resize((texels.size() + 3) / 4 * 4);
  images = upload(device, table, "alpha images");
  alpha = upload(device, texels, "alpha images");
  coordinates = upload(device, scene.texture_coordinates, "texture coordinates");
  looks = upload(device,
                 std::vector{object_data.address(), coordinates.address(), images.address(), alpha.address()},
                 "what cut-outs are tested by");
}

void SceneBuffers::update(Device& device, const Scene& scene, std::span<const ObjectId> moved) {
  if (moved.empty()) return;
  for (const ObjectId object : moved) {
    if (states_[object] != draw_state(scene, object))
      throw Error("renderer: object " + std::to_string(object) +
                  " was mirrored by its new transform, expected one that does not turn its triangles");
  }
  constexpr std::size_t kEach = sizeof(shared::ObjectData) + sizeof(shared::BoxData);
  if (staging_.size() < moved.size() * kEach)
    staging_ = Buffer(device, moved.size() * kEach, Memory::upload, "moved objects");
  auto* data = staging_.mapped<shared::ObjectData>();
  auto* boxes = reinterpret_cast<shared::BoxData*>(data + moved.size());
  std::vector<vk::BufferCopy> data_regions, box_regions;
  data_regions.reserve(moved.size());
  box_regions.reserve(moved.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    data[i] = data_of(scene, moved[i]);
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
