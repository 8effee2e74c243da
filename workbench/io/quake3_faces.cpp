#include "workbench/io/quake3_faces.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace sightline::io::quake3 {

namespace {

constexpr std::uint32_t kSolidContents = 0x1, kFogContents = 0x40, kTranslucentContents = 0x20000000;
constexpr std::uint32_t kSkySurface = 0x4, kNoDrawSurface = 0x80, kLightFilterSurface = 0x8000,
                        kAlphaShadowSurface = 0x10000;
constexpr std::uint32_t kMaxPatchSide = 1023;
constexpr float kMaxTexture = 1e6f;  // beyond it, and of what is no number, the first texel

/// Quake 3 draws triangles from where they turn clockwise. The stored normals do not decide: some models'
/// point into their triangles.
void turn_round(FaceShape& shape) {
  for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3)
    std::swap(shape.indices[i + 1], shape.indices[i + 2]);
}

Vec3 point_of(const FaceRecord& face) {
  return is_finite(face.light_map_origin) ? to_point(face.light_map_origin) : Vec3{};
}

FaceShape flare_marker(const FaceRecord& face) {
  constexpr float kReach = 0.1f;
  const Vec3 c = point_of(face);
  FaceShape shape;
  for (std::uint32_t corner = 0; corner < 6; ++corner) {
    const float reach = corner % 2 == 0 ? kReach : -kReach;
    const Vec3 axis = corner < 2 ? Vec3{reach, 0, 0} : corner < 4 ? Vec3{0, reach, 0} : Vec3{0, 0, reach};
    shape.vertices.push_back({{c.x + axis.x, c.y + axis.y, c.z + axis.z}, axis, {}});
  }
  shape.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return shape;
}

void spend(std::uint64_t& budget, std::int32_t count, const char* what) {
  if (static_cast<std::uint64_t>(count) > budget) {
    throw Error(fmt::format(
        "claims {} {} that other faces claim too, expected no more than a level of its size needs", count,
        what));
  }
  budget -= static_cast<std::uint64_t>(count);
}

}  // namespace

ShaderLook look_of(const ShaderRecord& surface, const ShaderScripts& scripts) {
  const std::uint32_t flags = surface.surface_flags, contents = surface.content_flags;
  const ShaderLook see_through{.surface = Surface::transparent, .cull = Cull::none},
      holed{.surface = Surface::cut_out, .cull = Cull::none};
  if ((contents & kFogContents) != 0 || (flags & kNoDrawSurface) != 0) return see_through;
  const std::string_view name(surface.name.data(), surface.name.size());
  if (const ShaderLook* look = scripts.find(name.substr(0, name.find('\0')))) return *look;
  if ((contents & kTranslucentContents) != 0) return see_through;
  const bool may_have_holes = (flags & (kAlphaShadowSurface | kLightFilterSurface)) != 0 ||
                              ((contents & kSolidContents) == 0 && (flags & kSkySurface) == 0);
  return may_have_holes ? holed : ShaderLook{};
}

FaceReader::FaceReader(Bytes vertices, Bytes mesh_vertices, std::uint32_t patch_level)
    : vertices_(vertices, "vertices"),
      mesh_vertices_(mesh_vertices, "mesh vertices"),
      patch_level_(patch_level),
      // In real levels each vertex belongs to one face, and faces of one form share their indices, fewer
      // than three a vertex. The slack is for compilers we have not met; without the limit a small file
      // could claim its vertices once for each of 100,000 faces.
      vertex_budget_(2 * std::uint64_t{vertices_.size()} + 1024),
      index_budget_(16 * std::uint64_t{vertices_.size()} + 1024) {}

FaceShape FaceReader::read(const FaceRecord& face, Cull cull) {
  FaceShape shape;
  switch (face.type) {
    case polygon:
    case triangles:
      shape = read_triangles(face);
      break;
    case patch:
      shape = read_patch(face);
      break;
    case flare:
      return flare_marker(face);
    default:
      throw Error(fmt::format("has type {}, expected 1 … 4", face.type));
  }
  if (shape.vertices.empty()) shape.vertices.push_back({point_of(face), to_axes(face.normal), {}});
  if (cull != Cull::fronts) turn_round(shape);
  return shape;
}

std::vector<Surfel> FaceReader::surfels(const FaceRecord& face) {
  vertices_.require(face.first_vertex, face.vertex_count);
  spend(vertex_budget_, face.vertex_count, "vertices");
  std::vector<Surfel> out(static_cast<std::size_t>(face.vertex_count));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const VertexRecord vertex = vertices_.at(face.first_vertex + static_cast<std::int64_t>(i));
    if (!is_finite(vertex.position))
      throw Error(fmt::format("has vertex {} at a position that is not finite", i));
    out[i] = {to_point(vertex.position), is_finite(vertex.normal) ? to_axes(vertex.normal) : Vec3{0, 1, 0}};
    const float u = vertex.texture_and_light_map[0], v = vertex.texture_and_light_map[1];
    if (std::abs(u) < kMaxTexture && std::abs(v) < kMaxTexture) out[i].texture = {u, v};
  }
  return out;
}

FaceShape FaceReader::read_triangles(const FaceRecord& face) {
  FaceShape shape{surfels(face), {}};
  mesh_vertices_.require(face.first_mesh_vertex, face.mesh_vertex_count);
  spend(index_budget_, face.mesh_vertex_count, "mesh vertices");
  const std::int32_t whole = face.mesh_vertex_count / 3 * 3;
  shape.indices.reserve(static_cast<std::size_t>(whole));
  for (std::int32_t i = 0; i < whole; ++i) {
    const std::int32_t index = mesh_vertices_.at(std::int64_t{face.first_mesh_vertex} + i);
    if (index < 0 || index >= face.vertex_count) {
      throw Error(fmt::format("has index {}, expected one below its {} vertices", index, face.vertex_count));
    }
    shape.indices.push_back(static_cast<std::uint32_t>(index));
  }
  return shape;
}

FaceShape FaceReader::read_patch(const FaceRecord& face) {
  const std::int64_t width = face.patch_width, height = face.patch_height;
  const auto good = [](std::int64_t side) { return side >= 3 && side % 2 == 1 && side <= kMaxPatchSide; };
  if (!good(width) || !good(height) || width * height != face.vertex_count) {
    throw Error(
        fmt::format("is a patch of {} × {} control points with {} vertices, expected odd sides of 3 … {} "
                    "that multiply to the vertices",
                    width, height, face.vertex_count, kMaxPatchSide));
  }
  PatchGrid grid = tessellate(surfels(face), static_cast<std::uint32_t>(width),
                              static_cast<std::uint32_t>(height), patch_level_);
  return {std::move(grid.vertices), std::move(grid.indices)};
}

}  // namespace sightline::io::quake3
