// The faces of a Quake 3 level as triangles, and what they do to what lies behind them.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/quake3_format.hpp"
#include "workbench/io/quake3_patch.hpp"
#include "workbench/io/quake3_shaders.hpp"

namespace sightline::io::quake3 {

/// A face's geometry before it becomes a mesh.
struct FaceShape {
  std::vector<Surfel> vertices;
  std::vector<std::uint32_t> indices;
};

/// What scripts say of a surface; where none does, what the flags of its record say, on the side of seeing
/// too much: what casts shadows by its alpha, filters light, or is not solid may have holes.
ShaderLook look_of(const ShaderRecord& surface, const ShaderScripts& scripts);

class FaceReader {
public:
  FaceReader(Bytes vertices, Bytes mesh_vertices, std::uint32_t patch_level);

  /// The face's triangles, turning counter-clockwise as seen from where they are drawn. Throws Error.
  FaceShape read(const FaceRecord& face, Cull cull);

private:
  std::vector<Surfel> surfels(const FaceRecord& face);
  FaceShape read_triangles(const FaceRecord& face);
  FaceShape read_patch(const FaceRecord& face);

  Records<VertexRecord> vertices_;
  Records<std::int32_t> mesh_vertices_;
  std::uint32_t patch_level_;
  std::uint64_t vertex_budget_, index_budget_;
};

}  // namespace sightline::io::quake3
