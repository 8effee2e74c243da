// A mesh as occluders are made of it: vertices joined, neighbours known, in parts that hang together.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/types.hpp>

namespace sightline::occlusion {

/// How it is told whether a point lies inside a part: by counting, along any line out of it, how often the
/// line leaves the part more than it enters it.
enum class Inside : std::uint8_t {
  never,       ///< the part is open
  turned,      ///< where the count is not 0: closed, edges are used as often one way as the other
  turned_out,  ///< where it is positive: the same of a part of which some triangles are drawn in front alone
  odd_crossings,  ///< where the line meets it an odd number of times: each edge has an even number of
                  ///< triangles
};

struct MeshPart {
  std::vector<std::uint32_t> triangles;
  Inside inside = Inside::never;
  glm::dvec3 low{1e300}, high{-1e300};
  /// Half of the surface of the box around it: the mean of what that covers, but for a factor of 2.
  [[nodiscard]] double size() const noexcept {
    const glm::dvec3 e = high - low;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

struct MeshParts {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> one_sided;  ///< one a triangle
  /// Of edge k, from corner k to corner k + 1: the only other triangle there, if it turns the same way, or
  /// kNone.
  std::vector<std::array<std::uint32_t, 3>> neighbours;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<MeshPart> parts;  ///< the largest first
};

/// Of a mesh that OccluderMesh takes. Triangles that join to fewer than three corners are left out.
MeshParts parts_of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                   std::span<const Sides> sides);

}  // namespace sightline::occlusion
