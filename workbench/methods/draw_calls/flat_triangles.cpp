#include "workbench/methods/draw_calls/flat_triangles.hpp"

#include <algorithm>
#include <utility>

namespace sightline::methods {

void append_indices(const Scene& scene, ObjectId object, std::uint32_t base,
                    std::vector<std::uint32_t>& indices) {
  const Mesh& mesh = scene.meshes[scene.mesh[object]];
  const std::size_t first = indices.size();
  for (std::uint32_t i = 0; i < mesh.index_count; ++i)
    indices.push_back(base + scene.indices[mesh.first_index + i]);
  if (!mirrors(scene.transform[object])) return;
  for (std::size_t i = first; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
}

FlatTriangles flatten(const Scene& scene) {
  FlatTriangles flat;
  flat.sides = scene.sides;
  std::size_t vertices = 0;
  for (ObjectId object = 0; object < scene.size(); ++object)
    vertices += scene.meshes[scene.mesh[object]].vertex_count;
  const std::size_t triangles = triangle_count(scene);
  flat.positions.reserve(vertices);
  flat.indices.reserve(3 * triangles);
  flat.objects.reserve(triangles);
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Mesh& mesh = scene.meshes[scene.mesh[object]];
    const auto base = static_cast<std::uint32_t>(flat.positions.size());
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      flat.positions.push_back(
          transform_point(scene.transform[object], scene.positions[mesh.first_vertex + v]));
    }
    if (!scene.texture_coordinates.empty()) {
      const auto first = scene.texture_coordinates.begin() + mesh.first_vertex;
      flat.texture_coordinates.insert(flat.texture_coordinates.end(), first, first + mesh.vertex_count);
    }
    append_indices(scene, object, base, flat.indices);
    flat.objects.insert(flat.objects.end(), mesh.index_count / 3, object);
  }
  return flat;
}

bool can_flatten(const Scene& scene) {
  constexpr std::uint64_t kMostTriangles = 100'000'000, kAlwaysAllowed = 2'000'000;
  const std::uint64_t triangles = triangle_count(scene), held = scene.indices.size() / 3;
  std::uint64_t vertices = 0;
  for (ObjectId object = 0; object < scene.size(); ++object)
    vertices += scene.meshes[scene.mesh[object]].vertex_count;
  return triangles <= std::min(kMostTriangles, std::max(kAlwaysAllowed, 2 * held)) &&
         vertices <= 3 * kMostTriangles;
}

}  // namespace sightline::methods
