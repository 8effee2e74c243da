#include <sightline/workbench/scene.hpp>

#include <algorithm>
#include <limits>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/held_scene.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/scene/materials.hpp"
#include "workbench/scene/vertex_normals.hpp"

namespace sightline {

using namespace geometry;

Sphere Scene::sphere(ObjectId object) const noexcept {
  const Box box = bounds[object];
  return {{0.5f * (box.min.x + box.max.x), 0.5f * (box.min.y + box.max.y), 0.5f * (box.min.z + box.max.z)},
          radius[object]};
}

std::uint32_t Scene::add_mesh(std::span<const Vec3> mesh_positions, std::span<const Vec3> mesh_normals,
                              std::span<const std::uint32_t> mesh_indices,
                              std::span<const TextureCoordinate> mesh_coordinates) {
  const auto require_one_each = [&](std::size_t count, const char* of) {
    if (count == 0 || count == mesh_positions.size()) return;
    throw Error("scene '" + name + "': mesh " + std::to_string(meshes.size()) + ": " + std::to_string(count) +
                " " + of + " for " + std::to_string(mesh_positions.size()) +
                " positions, expected one each or none at all");
  };
  require_one_each(mesh_normals.size(), "normals");
  require_one_each(mesh_coordinates.size(), "texture coordinates");
  std::vector<Vec3> computed;
  if (mesh_normals.empty()) {
    computed = scene::vertex_normals(mesh_positions, mesh_indices);
    mesh_normals = computed;
  }
  Mesh added;
  added.first_index = static_cast<std::uint32_t>(indices.size());
  added.index_count = static_cast<std::uint32_t>(mesh_indices.size());
  added.first_vertex = static_cast<std::uint32_t>(positions.size());
  added.vertex_count = static_cast<std::uint32_t>(mesh_positions.size());
  positions.insert(positions.end(), mesh_positions.begin(), mesh_positions.end());
  normals.insert(normals.end(), mesh_normals.begin(), mesh_normals.end());
  indices.insert(indices.end(), mesh_indices.begin(), mesh_indices.end());
  if (!texture_coordinates.empty() || !mesh_coordinates.empty()) {
    texture_coordinates.resize(added.first_vertex);
    texture_coordinates.insert(texture_coordinates.end(), mesh_coordinates.begin(), mesh_coordinates.end());
    texture_coordinates.resize(positions.size());
  }
  meshes.push_back(added);
  return static_cast<std::uint32_t>(meshes.size() - 1);
}

std::uint32_t Scene::add_alpha_image(AlphaImage image) {
  alpha_images.push_back(std::move(image));
  return static_cast<std::uint32_t>(alpha_images.size() - 1);
}

ObjectId Scene::add_object(std::uint32_t mesh_index, const Affine& object_transform, const Material& look) {
  if (mesh_index >= meshes.size()) {
    throw Error("scene '" + name + "': object " + std::to_string(size()) + ": shows mesh " +
                std::to_string(mesh_index) + ", but there are " + std::to_string(meshes.size()));
  }
  if (look.alpha_image != kNoAlphaImage && look.alpha_image >= alpha_images.size()) {
    throw Error("scene '" + name + "': object " + std::to_string(size()) + ": shows alpha image " +
                std::to_string(look.alpha_image) + ", but there are " + std::to_string(alpha_images.size()));
  }
  const auto object = static_cast<ObjectId>(size());
  bounds.push_back({});
  radius.push_back(0);
  mesh.push_back(mesh_index);
  transform.push_back(object_transform);
  surface.push_back(look.surface);
  sides.push_back(scene::drawn_sides(look.sides, raster_state));
  material_sides.push_back(look.sides);
  alpha_image.push_back(look.alpha_image);
  alpha_cutoff.push_back(look.alpha_cutoff);
  layers.push_back(kAllLayers);
  move_object(object, object_transform);
  return object;
}

void Scene::move_object(ObjectId object, const Affine& moved) {
  if (object >= size()) {
    throw Error("scene '" + name + "': object " + std::to_string(object) + ": cannot move, there are " +
                std::to_string(size()));
  }
  transform[object] = moved;
  const Mesh& shown = meshes[mesh[object]];
  const std::span<const Vec3> vertices(positions.data() + shown.first_vertex, shown.vertex_count);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const Vec3& vertex : vertices) {
    const Vec3 p = transform_point(moved, vertex);
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  bounds.set(object, box);
  const Vec3 centre = sphere(object).centre;
  float squared = 0;
  for (const Vec3& vertex : vertices) {
    const glm::vec3 offset = to_glm(transform_point(moved, vertex)) - to_glm(centre);
    squared = std::max(squared, glm::dot(offset, offset));
  }
  constexpr float kRounding = 1 + 4 * std::numeric_limits<float>::epsilon();
  radius[object] = std::sqrt(squared) * kRounding;
}

Box extent(const Scene& scene) noexcept {
  if (scene.empty()) return {};
  const auto smallest = [](const auto& v) { return *std::min_element(v.begin(), v.end()); };
  const auto greatest = [](const auto& v) { return *std::max_element(v.begin(), v.end()); };
  const Boxes& b = scene.bounds;
  return {{smallest(b.min_x), smallest(b.min_y), smallest(b.min_z)},
          {greatest(b.max_x), greatest(b.max_y), greatest(b.max_z)}};
}

std::uint64_t triangle_count(const Scene& scene) noexcept {
  std::uint64_t sum = 0;
  for (ObjectId object = 0; object < scene.size(); ++object) sum += scene.triangles(object);
  return sum;
}

namespace {

[[noreturn]] void refuse_object(const Scene& scene, std::size_t object, const char* expected) {
  throw Error("scene '" + scene.name + "': object " + std::to_string(object) + ": " + expected);
}

void check_geometry(const Scene& s) {
  const std::string scene = "scene '" + s.name + "': ";
  if (s.normals.size() != s.positions.size()) throw Error(scene + "expected one normal a position");
  for (std::size_t m = 0; m < s.meshes.size(); ++m) {
    const Mesh& mesh = s.meshes[m];
    const std::string name = scene + "mesh " + std::to_string(m);
    if (std::uint64_t{mesh.first_index} + mesh.index_count > s.indices.size() ||
        std::uint64_t{mesh.first_vertex} + mesh.vertex_count > s.positions.size()) {
      throw Error(name + ": its range ends beyond the scene's arrays");
    }
    if (mesh.index_count % 3 != 0) throw Error(name + ": expected three indices a triangle");
    if (mesh.vertex_count == 0) throw Error(name + ": has no vertex");
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      if (!is_finite(s.positions[mesh.first_vertex + v])) {
        throw Error(name + ": position " + std::to_string(v) + " is not finite");
      }
    }
    for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
      if (s.indices[mesh.first_index + i] >= mesh.vertex_count) {
        throw Error(name + ": an index is out of range");
      }
    }
  }
}

}  // namespace

std::uint64_t fingerprint(const Scene& scene) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ at[i]) * 0x100000001b3u;
  };
  const std::uint64_t count = scene.size();
  add(&count, sizeof count);
  const Boxes& b = scene.bounds;
  for (const auto* array : {&b.min_x, &b.min_y, &b.min_z, &b.max_x, &b.max_y, &b.max_z}) {
    add(array->data(), array->size() * sizeof(float));
  }
  // What older scenes do not have is left out, so that what was baked for them stays theirs.
  if (scene.origin != WorldPoint{}) add(&scene.origin, sizeof scene.origin);
  if (std::ranges::count(scene.surface, Surface::cut_out) != 0) add(scene.surface.data(), count);
  if (std::ranges::count(scene.sides, Sides::front) != 0) add(scene.sides.data(), count);
  return hash;
}

void check(const Scene& s) {
  const std::size_t n = s.size();
  if (n == 0) throw Error("scene '" + s.name + "': it holds no object, expected at least one");
  if (n >= kNoObject) throw Error("scene '" + s.name + "': too many objects for 32-bit ids");
  const Boxes& b = s.bounds;
  for (const std::size_t size :
       {b.min_x.size(), b.min_y.size(), b.min_z.size(), b.max_x.size(), b.max_y.size(), b.max_z.size(),
        s.radius.size(), s.transform.size(), s.surface.size(), s.sides.size()}) {
    if (size != n) throw Error("scene '" + s.name + "': object arrays differ in length");
  }
  check_geometry(s);
  scene::check_materials(s);
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_valid(s.bounds[i])) refuse_object(s, i, "bounds must be finite with min <= max");
    const Vec3 reach = largest(s.bounds[i]);
    if (std::max({reach.x, reach.y, reach.z}) > kWorldReach)
      refuse_object(s, i, "it reaches farther than 1e11 m");
    if (!std::isfinite(s.radius[i]) || s.radius[i] < 0) refuse_object(s, i, "radius must be finite and >= 0");
    if (s.mesh[i] >= s.meshes.size()) refuse_object(s, i, "its mesh is out of range");
  }
  if (s.level) check(*s.level, n);
}

HeldScene::HeldScene(const Scene& scene, std::string holder)
    : scene_(scene), holder_(std::move(holder)), objects_(scene.size()), meshes_(scene.meshes.size()) {}

void HeldScene::require_same() const {
  if (scene_.size() == objects_ && scene_.meshes.size() == meshes_) return;
  const auto counts = [](std::size_t objects, std::size_t meshes) {
    return std::to_string(objects) + " objects of " + std::to_string(meshes) + " meshes";
  };
  throw Error("scene '" + scene_.name + "': holds " + counts(scene_.size(), scene_.meshes.size()) +
              ", but the " + holder_ + " was made for " + counts(objects_, meshes_) + ": make it anew");
}

void HeldScene::require_sound(std::span<const ObjectId> moved) const {
  require_same();
  for (const ObjectId object : moved) {
    if (object >= objects_)
      refuse_object(scene_, object, "is said to have moved, but there is no such object");
    if (!is_valid(scene_.bounds[object])) {
      refuse_object(scene_, object, "was moved to bounds that are not finite");
    }
  }
}

}  // namespace sightline
