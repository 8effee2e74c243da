// What closes an open part of a mesh.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "library/occlusion/mesh_parts.hpp"

namespace sightline::occlusion {

/// Triangles that turn an open part into a closed one: between its open edges and the middle of each ring of
/// these. No triangle where the part is closed, or where it is more hole than surface.
struct Lid {
  std::vector<glm::dvec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Lid lid_of(const MeshParts& mesh, const MeshPart& part);

}  // namespace sightline::occlusion
