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

void require_vec3(const Accessor& accessor, const char* what) {
  if (accessor.type() != "VEC3") {
    throw Error(fmt::format("has {} of type {}, expected VEC3", what, accessor.type()));
  }
}

}  // namespace

MeshReader::MeshReader(Document& document, std::uint64_t file_bytes, Scene& scene)
    : document_(document), scene_(scene), budget_(64 * (file_bytes + document.buffer_bytes()) + 65536) {}

std::uint32_t MeshReader::mesh_of(const Json& primitive) {
  const std::uint64_t mode = whole_of(primitive, "mode", triangles);
  if (mode > fan) throw Error(fmt::format("has mode {}, expected 0 … 6", mode));
  if (mode < triangles) return kNoMesh;
  const Json* attributes = find(primitive, "attributes");
  if (attributes == nullptr || find(*attributes, "POSITION") == nullptr) return kNoMesh;
  const Key key{mode, whole_of(primitive, "indices", kNone), whole_of(*attributes, "POSITION"),
                whole_of(*attributes, "NORMAL", kNone)};
  const auto [place, added] = made_.try_emplace(key, kNoMesh);
  if (added) place->second = make(key);
  return place->second;
}

std::uint32_t MeshReader::make(const Key& key) {
  const auto& [mode, indices_at, positions_at, normals_at] = key;
  const Accessor& source = document_.accessor(positions_at);
  require_vec3(source, "positions");
  const Accessor* order = indices_at == kNone ? nullptr : &document_.accessor(indices_at);
  if (order != nullptr && (order->type() != "SCALAR" || !order->is_unsigned_integer())) {
    throw Error("has indices that are not unsigned integers");
  }
  const Accessor* given = normals_at == kNone ? nullptr : &document_.accessor(normals_at);
  if (given != nullptr) {
    require_vec3(*given, "normals");
    if (given->count() != source.count()) {
      throw Error(fmt::format("has {} normals for {} positions", given->count(), source.count()));
    }
  }
  const std::uint64_t corner_count = order == nullptr ? source.count() : order->count();
  // A strip's vertex is a corner of three triangles; accessors without data behind them cost a file nothing.
  if (corner_count > budget_ / 4)
    throw Error("unfolds the file to more vertices than its size can stand for");
  budget_ -= 4 * corner_count;

  std::vector<std::uint32_t> corners(corner_count);
  for (std::uint64_t i = 0; i < corner_count; ++i) {
    corners[i] = order == nullptr ? static_cast<std::uint32_t>(i) : order->integer(i);
    if (corners[i] >= source.count()) {
      throw Error(
          fmt::format("has index {}, expected one below its {} positions", corners[i], source.count()));
    }
  }
  corners = as_triangles(std::move(corners), mode);
  if (corners.empty()) return kNoMesh;

  // Only the vertices that are used: exporters let many primitives index one long list.
  std::vector<std::uint32_t> used = corners;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  if (used.size() != source.count()) {
    for (std::uint32_t& corner : corners) {
      corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    }
  }
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (scene_.positions.size() + used.size() > kMost || scene_.indices.size() + corners.size() > kMost) {
    throw Error("brings the scene over 2^32 vertices or indices");
  }
  std::vector<Vec3> positions, normals(used.size());
  positions.reserve(used.size());
  for (const std::uint32_t vertex : used) {
    const Vec3 p = read_vec3(source, vertex);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error(fmt::format("has position {} that is not finite", vertex));
    }
    positions.push_back(p);
  }
  std::vector<Vec3> computed;
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
  return scene_.add_mesh(positions, normals, corners);
}

}  // namespace sightline::io::gltf
