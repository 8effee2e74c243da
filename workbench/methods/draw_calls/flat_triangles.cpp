#include "workbench/methods/draw_calls/flat_triangles.hpp"

#include <algorithm>

namespace sightline::methods {

FlatTriangles flatten(const Scene& scene) {
  FlatTriangles flat;
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
    for (std::uint32_t i = 0; i < mesh.index_count; ++i)
      flat.indices.push_back(base + scene.indices[mesh.first_index + i]);
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
