// Small files made in memory, whole and well-formed; tests bend and break them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "workbench/io/quake3_format.hpp"

namespace sightline::samples {

using Blob = std::vector<std::byte>;

/// The records of a Quake 3 level before they become a file.
struct Level {
  std::string entities;
  std::vector<io::quake3::ShaderRecord> shaders;
  std::vector<io::quake3::PlaneRecord> planes;
  std::vector<io::quake3::NodeRecord> nodes;
  std::vector<io::quake3::LeafRecord> leaves;
  std::vector<std::int32_t> leaf_faces;
  std::vector<io::quake3::ModelRecord> models;
  std::vector<io::quake3::VertexRecord> vertices;
  std::vector<std::int32_t> mesh_vertices;
  std::vector<io::quake3::FaceRecord> faces;
  std::vector<std::uint8_t> visibility;
};

/// Two rooms, x >= 0 (leaf 0, cluster 0) and x < 0 (leaf 1, cluster 1); room 1 sees room 0, not the other
/// way. Faces: 0 a wall of room 0 that looks along -x, 1 a patch and 2 a triangle of room 1 (translucent), 3
/// a flare and 4 a face without triangles of room 0, 5 a face of a door,
/// which stands 100 units along y and has a leaf that the tree does not reach, as compilers write it. Two
/// spawn points, an item, one spawn in nothing.
Level two_rooms();
Blob to_bsp(const Level& level);

/// A zip archive, its entries deflated; or of one entry.
Blob to_pk3(const std::vector<std::pair<std::string, Blob>>& entries);
Blob to_pk3(const std::string& entry, std::span<const std::byte> content);

/// A glTF of one triangle (0,0,0) (1,0,0) (0,1,0), in one buffer as data URI: 36 bytes of positions, then the
/// indices 0 1 2 as unsigned short.
nlohmann::json one_triangle();
Blob to_bytes(const std::string& text);
Blob to_bytes(const nlohmann::json& document);
/// GLB of a document and its binary chunk.
Blob to_glb(const nlohmann::json& document, std::span<const std::byte> binary);
std::string to_data_uri(std::span<const std::byte> bytes);

/// What an Error says; empty if nothing was thrown.
std::string error_of(const std::function<void()>& action);

/// A folder that is gone with the object.
class TemporaryFolder {
public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

void write(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace sightline::samples
