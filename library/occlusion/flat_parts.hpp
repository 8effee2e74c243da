// Flat parts of a mesh in few triangles, which cover nothing that it does not cover.
#pragma once

#include <cstdint>
#include <vector>

#include "library/occlusion/mesh_parts.hpp"

namespace sightline::occlusion {

/// A triangle that may occlude.
struct Candidate {
  std::array<Vec3, 3> corners;
  Sides sides = Sides::both;
  double area = 0;         ///< m²
  std::uint32_t part = 0;  ///< of MeshParts::parts
};

double triangle_area(const std::array<Vec3, 3>& corners);

/// All triangles of the mesh with an area; those that lie on one plane and hang together are merged, where
/// that makes fewer of them.
std::vector<Candidate> flat_parts(const MeshParts& mesh);

}  // namespace sightline::occlusion
