// A solid sampled on a grid: where occluders inside it may lie.
#pragma once

#include <cstdint>
#include <vector>

#include "library/occlusion/solid.hpp"

namespace sightline::occlusion {

/// Nodes at every 1 / kCells of the unit cube, and one beyond it on every side.
struct SolidGrid {
  static constexpr int kCells = 32, kNodes = kCells + 3;
  static constexpr double kStep = 1.0 / kCells;
  /// How deep each node lies below the surface, at most 2 · kStep either way, negative outside.
  std::vector<float> depth;

  explicit SolidGrid(const Solid& solid);

  [[nodiscard]] static std::size_t index(int x, int y, int z) noexcept {
    return (static_cast<std::size_t>(z) * kNodes + static_cast<std::size_t>(y)) * kNodes +
           static_cast<std::size_t>(x);
  }
  /// A little off the round numbers that meshes' own edges lie at.
  [[nodiscard]] static glm::dvec3 place(int x, int y, int z) noexcept {
    return (glm::dvec3(x, y, z) - glm::dvec3(1 - 0.0141, 1 - 0.0173, 1 + 0.0159)) * kStep;
  }
};

/// At most `most` boxes inside the solid that do not overlap, the largest first.
std::vector<Bounds3> boxes_inside(const Solid& solid, const SolidGrid& grid, std::size_t most);

}  // namespace sightline::occlusion
