// The Quake 3 BSP file (IBSP, version 46) as records, and a view of its lumps that never reads beyond them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <sightline/types.hpp>
#include <sightline/workbench/error.hpp>

#include "workbench/io/byte_reader.hpp"

namespace sightline::io::quake3 {

enum class LumpId : std::uint32_t {
  entities,
  shaders,
  planes,
  nodes,
  leaves,
  leaf_faces,
  leaf_brushes,
  models,
  brushes,
  brush_sides,
  vertices,
  mesh_vertices,
  effects,
  faces,
  light_maps,
  light_grid,
  visibility,
  count,
};

using Int3 = std::array<std::int32_t, 3>;
using Float3 = std::array<float, 3>;

struct ShaderRecord {
  std::array<char, 64> name;
  std::uint32_t surface_flags, content_flags;
};
struct PlaneRecord {
  Float3 normal;
  float distance;
};
struct NodeRecord {
  std::int32_t plane, front, back;
  Int3 min, max;
};
struct LeafRecord {
  std::int32_t cluster, area;
  Int3 min, max;
  std::int32_t first_face, face_count, first_brush, brush_count;
};
struct ModelRecord {
  Float3 min, max;
  std::int32_t first_face, face_count, first_brush, brush_count;
};
struct VertexRecord {
  Float3 position;
  std::array<float, 4> texture_and_light_map;
  Float3 normal;
  std::uint32_t colour;
};
struct FaceRecord {
  std::int32_t shader, effect, type, first_vertex, vertex_count, first_mesh_vertex, mesh_vertex_count;
  std::int32_t light_map;
  std::array<std::int32_t, 4> light_map_rectangle;
  Float3 light_map_origin;
  std::array<float, 6> light_map_axes;
  Float3 normal;
  std::int32_t patch_width, patch_height;
};
static_assert(sizeof(ShaderRecord) == 72 && sizeof(PlaneRecord) == 16 && sizeof(NodeRecord) == 36 &&
              sizeof(LeafRecord) == 48 && sizeof(ModelRecord) == 40 && sizeof(VertexRecord) == 44 &&
              sizeof(FaceRecord) == 104);

enum FaceType : std::int32_t { polygon = 1, patch = 2, triangles = 3, flare = 4 };

/// A lump as an array of records; `at` is the only way in.
template <class Record>
class Records {
public:
  Records(Bytes bytes, const char* what) : bytes_(bytes), what_(what) {}
  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size() / sizeof(Record); }
  [[nodiscard]] Record at(std::int64_t index) const {
    require(index, 1);
    return read_at<Record>(bytes_, static_cast<std::size_t>(index) * sizeof(Record));
  }
  /// Throws unless [first, first + count) is a range of the lump.
  void require(std::int64_t first, std::int64_t count) const {
    if (first < 0 || count < 0 ||
        !fits(static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(count), size())) {
      throw Error("refers to " + std::string(what_) + " " + std::to_string(first) + " … +" +
                  std::to_string(count) + ", but the level holds " + std::to_string(size()));
    }
  }

private:
  Bytes bytes_;
  const char* what_;
};

inline constexpr float kMetresPerUnit = 0.0254f;

/// A direction in Sightline's axes.
constexpr Vec3 to_axes(const Float3& v) noexcept {
  return {v[0], v[2], -v[1]};
}
/// A point in Sightline's axes and metres.
constexpr Vec3 to_point(const Float3& v) noexcept {
  return {kMetresPerUnit * v[0], kMetresPerUnit * v[2], -kMetresPerUnit * v[1]};
}
inline bool is_finite(const Float3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace sightline::io::quake3
