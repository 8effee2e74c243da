// A primitive of a glTF mesh as a mesh of the scene.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/gltf_document.hpp"
#include "workbench/io/gltf_material.hpp"

namespace sightline::io::gltf {

inline constexpr std::uint32_t kNoMesh = 0xffffffffu;

/// Makes meshes of primitives, each distinct (mode, indices, positions, normals, texture coordinates as a
/// material moves them) once. Texture coordinates are read where a cut-out's image lies on them, and nowhere
/// else.
class MeshReader {
public:
  MeshReader(Document& document, const MaterialReader& materials, std::uint64_t file_bytes, Scene& scene);

  /// The scene's mesh for a primitive; kNoMesh where it has no triangle. Throws Error.
  std::uint32_t mesh_of(const Json& primitive);

private:
  struct Key {
    std::uint64_t mode, indices, positions, normals, coordinates, moved_by;
    auto operator<=>(const Key&) const = default;
  };
  /// A primitive's triangles, and the vertices of the file that they use, in order.
  struct Corners {
    std::vector<std::uint32_t> corners, used;
  };
  std::uint32_t make(const Key& key, const Look& look);
  Corners corners_of(const Key& key, std::uint64_t vertices);
  [[nodiscard]] std::uint64_t coordinates_of(const Json& attributes, const Look& look) const;
  const Accessor* vertex_data(std::uint64_t accessor, const char* what, const char* type,
                              std::uint64_t count);

  Document& document_;
  const MaterialReader& materials_;
  Scene& scene_;
  std::uint64_t budget_;  ///< vertices and indices that the file may still unfold to
  std::map<Key, std::uint32_t> made_;
  std::set<std::uint64_t> images_lie_on_;  ///< accessors of texture coordinates
};

}  // namespace sightline::io::gltf
