// A primitive of a glTF mesh as a mesh of the scene.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/gltf_document.hpp"

namespace sightline::io::gltf {

inline constexpr std::uint32_t kNoMesh = 0xffffffffu;

/// Makes meshes of primitives, each distinct (mode, indices, positions, normals) once.
class MeshReader {
public:
  MeshReader(Document& document, std::uint64_t file_bytes, Scene& scene);

  /// The scene's mesh for a primitive; kNoMesh where it has no triangle. Throws Error.
  std::uint32_t mesh_of(const Json& primitive);

private:
  using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;
  std::uint32_t make(const Key& key);

  Document& document_;
  Scene& scene_;
  std::uint64_t budget_;  ///< vertices and indices that the file may still unfold to
  std::map<Key, std::uint32_t> made_;
};

}  // namespace sightline::io::gltf
