#include "workbench/io/gltf_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/scene/vertex_normals.hpp"

namespace sightline::io::gltf {

namespace {

enum Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

/// Three vertices a triangle, wound as the file's first triangle is.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> corners, std::uint64_t mode) {
  if (mode == triangles) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> out;
  if (corners.size() < 3) return out;
  out.reserve((corners.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    const std::size_t odd = i % 2;
    if (mode == strip) {
      out.insert(out.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
    } else {
      out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
  }
  return out;
}

Vec3 read_vec3(const Accessor& accessor, std::uint64_t i) {
  return {accessor.component(i, 0), accessor.component(i, 1), accessor.component(i, 2)};
}

std::vector<Vec3> read_positions(const Accessor& source, std::span<const std::uint32_t> used) {
  std::vector<Vec3> positions;
  positions.reserve(used.size());
  for (const std::uint32_t vertex : used) {
    const Vec3 p = read_vec3(source, vertex);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error(fmt::format("has position {} that is not finite", vertex));
    }
    positions.push_back(p);
  }
  return positions;
}

/// Those given, of unit length; computed where there are none.
std::vector<Vec3> read_normals(const Accessor* given, std::span<const std::uint32_t> used,
                               std::span<const Vec3> positions, std::span<const std::uint32_t> corners) {
  std::vector<Vec3> normals(used.size()), computed;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Vec3 stored = given == nullptr ? Vec3{} : read_vec3(*given, used[i]);
    std::array<double, 3> n{stored.x, stored.y, stored.z};
    // What is of unit length already keeps its bits.
    if (std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6) {
      normals[i] = stored;
    } else if (scene::normalise(n)) {
      normals[i] = {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
    } else {
      if (computed.empty()) computed = scene::vertex_normals(positions, corners);
      normals[i] = computed[i];
    }
  }
  return normals;
}

std::vector<TextureCoordinate> read_coordinates(const Accessor* given, std::span<const std::uint32_t> used,
                                                const Look& look, bool moved) {
  std::vector<TextureCoordinate> coordinates;
  if (given == nullptr) return coordinates;
  coordinates.reserve(used.size());
  for (const std::uint32_t vertex : used) {
    TextureCoordinate at{given->component(vertex, 0), given->component(vertex, 1)};
    if (moved) {
      const auto along = [&](std::size_t first) {
        return static_cast<float>(look.move[first] * at.u + look.move[first + 1] * at.v +
                                  look.move[first + 2]);
      };
      at = {along(0), along(3)};
    }
    if (!std::isfinite(at.u) || !std::isfinite(at.v)) {
      throw Error(fmt::format("has texture coordinate {} that is not finite", vertex));
    }
    coordinates.push_back(at);
  }
  return coordinates;
}

/// The accessor of the texture coordinates that the material's texture lies on; kNone where there is none.
std::uint64_t coordinate_accessor(const Json& attributes, const Look& look) {
  return whole_of(attributes, fmt::format("TEXCOORD_{}", look.coordinate_set).c_str(), kNone);
}

}  // namespace

MeshReader::MeshReader(Document& document, const MaterialReader& materials, std::uint64_t file_bytes,
                       Scene& scene)
    : document_(document),
      materials_(materials),
      scene_(scene),
      budget_(64 * (file_bytes + document.buffer_bytes()) + 65536) {
  for (const Json& mesh : array_of(document.root(), "meshes")) {
    for (const Json& primitive : array_of(mesh, "primitives")) {
      const Json* attributes = find(primitive, "attributes");
      if (attributes == nullptr) continue;
      const Look& look = materials.look_of(primitive);
      if (look.material.alpha_image != kNoAlphaImage)
        images_lie_on_.insert(coordinate_accessor(*attributes, look));
    }
  }
}

/// Primitives without an image take along what one with an image needs, so that the two share a mesh.
std::uint64_t MeshReader::coordinates_of(const Json& attributes, const Look& look) const {
  const std::uint64_t accessor = coordinate_accessor(attributes, look);
  return images_lie_on_.contains(accessor) ? accessor : kNone;
}

std::uint32_t MeshReader::mesh_of(const Json& primitive) {
  const std::uint64_t mode = whole_of(primitive, "mode", triangles);
  if (mode > fan) throw Error(fmt::format("has mode {}, expected 0 … 6", mode));
  if (mode < triangles) return kNoMesh;
  const Json* attributes = find(primitive, "attributes");
  if (attributes == nullptr || find(*attributes, "POSITION") == nullptr) return kNoMesh;
  const Look& look = materials_.look_of(primitive);
  const Key key{mode,
                whole_of(primitive, "indices", kNone),
                whole_of(*attributes, "POSITION"),
                whole_of(*attributes, "NORMAL", kNone),
                coordinates_of(*attributes, look),
                look.moved_by};
  const auto [place, added] = made_.try_emplace(key, kNoMesh);
  if (added) place->second = make(key, look);
  return place->second;
}

const Accessor* MeshReader::vertex_data(std::uint64_t index, const char* what, const char* type,
                                        std::uint64_t count) {
  if (index == kNone) return nullptr;
  const Accessor& accessor = document_.accessor(index);
  if (accessor.type() != type) {
    throw Error(fmt::format("has {} of type {}, expected {}", what, accessor.type(), type));
  }
  if (accessor.count() != count) {
    throw Error(fmt::format("has {} {} for {} positions", accessor.count(), what, count));
  }
  return &accessor;
}

MeshReader::Corners MeshReader::corners_of(const Key& key, std::uint64_t vertices) {
  const Accessor* order = key.indices == kNone ? nullptr : &document_.accessor(key.indices);
  if (order != nullptr && (order->type() != "SCALAR" || !order->is_unsigned_integer())) {
    throw Error("has indices that are not unsigned integers");
  }
  const std::uint64_t corner_count = order == nullptr ? vertices : order->count();
  // A strip's vertex is a corner of three triangles; accessors without data behind them cost a file nothing.
  if (corner_count > budget_ / 4)
    throw Error("unfolds the file to more vertices than its size can stand for");
  budget_ -= 4 * corner_count;

  Corners out;
  std::vector<std::uint32_t> corners(corner_count);
  for (std::uint64_t i = 0; i < corner_count; ++i) {
    corners[i] = order == nullptr ? static_cast<std::uint32_t>(i) : order->integer(i);
    if (corners[i] >= vertices) {
      throw Error(fmt::format("has index {}, expected one below its {} positions", corners[i], vertices));
    }
  }
  out.corners = as_triangles(std::move(corners), key.mode);

  // Only the vertices that are used: exporters let many primitives index one long list.
  out.used = out.corners;
  std::sort(out.used.begin(), out.used.end());
  out.used.erase(std::unique(out.used.begin(), out.used.end()), out.used.end());
  if (out.used.size() != vertices) {
    for (std::uint32_t& corner : out.corners) {
      corner = static_cast<std::uint32_t>(std::lower_bound(out.used.begin(), out.used.end(), corner) -
                                          out.used.begin());
    }
  }
  return out;
}

std::uint32_t MeshReader::make(const Key& key, const Look& look) {
  const Accessor& source = document_.accessor(key.positions);
  vertex_data(key.positions, "positions", "VEC3", source.count());
  const Accessor* normals = vertex_data(key.normals, "normals", "VEC3", source.count());
  const Accessor* coordinates = vertex_data(key.coordinates, "texture coordinates", "VEC2", source.count());
  const auto [corners, used] = corners_of(key, source.count());
  if (corners.empty()) return kNoMesh;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (scene_.positions.size() + used.size() > kMost || scene_.indices.size() + corners.size() > kMost) {
    throw Error("brings the scene over 2^32 vertices or indices");
  }
  const std::vector<Vec3> positions = read_positions(source, used);
  return scene_.add_mesh(positions, read_normals(normals, used, positions, corners), corners,
                         read_coordinates(coordinates, used, look, key.moved_by != kNone));
}

}  // namespace sightline::io::gltf
