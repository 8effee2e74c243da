// How the three structures of Serpa, Serpa & Rodrigues share a node's triangles out to its children: a grid
// on the ground and an octree at the middle of the node's region, a k-d tree at the mean along the axis of
// highest variance. A rule knows neither recursion nor cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/types.hpp>

namespace sightline::partition {

enum class Structure : std::uint8_t {
  grid,     ///< square on x–z, 4 children a level: 2^height cells a side
  octree,   ///< 8 children, regular
  kd_tree,  ///< 2 children
};

/// Views on triangles in world space.
struct TriangleSpan {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> indices;  ///< three a triangle

  [[nodiscard]] std::size_t size() const noexcept { return indices.size() / 3; }
  [[nodiscard]] std::array<Vec3, 3> operator[](std::size_t triangle) const noexcept {
    return {positions[indices[3 * triangle]], positions[indices[3 * triangle + 1]],
            positions[indices[3 * triangle + 2]]};
  }
};

/// The smallest box around three points.
Box bounds_of(const std::array<Vec3, 3>& triangle) noexcept;

/// A node's children: regions that share borders and together fill the node's, and the triangles of each.
struct Split {
  std::array<Box, 8> regions;
  std::array<std::vector<std::uint32_t>, 8> triangles;  ///< in the order they came in
};

/// Shares triangles out to every child they reach into. False where that would multiply them more than
/// divide them, as with triangles as large as the node.
bool split(Structure structure, const TriangleSpan& all, std::span<const std::uint32_t> triangles,
           const Box& region, Split& out);

}  // namespace sightline::partition
