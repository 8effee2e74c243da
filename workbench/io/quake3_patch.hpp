// Quake 3's curved surfaces: biquadratic Bézier patches that share their borders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::io::quake3 {

struct Surfel {
  Vec3 position, normal;
  TextureCoordinate texture = {};
};

struct PatchGrid {
  std::vector<Surfel> vertices;  ///< row by row; normals not of unit length
  std::vector<std::uint32_t> indices;
};

/// Tessellates width × height control points (both odd, >= 3, row by row) with `level` segments along each
/// side of a 3 × 3 patch. A border curve depends on its own three control points alone and gives the same
/// bits from either end, so neighbours meet without a crack.
PatchGrid tessellate(std::span<const Surfel> control, std::uint32_t width, std::uint32_t height,
                     std::uint32_t level);

}  // namespace sightline::io::quake3
