// The few shapes that generated worlds are made of.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/types.hpp>

namespace sightline::scene {

struct Shape {
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> indices;

  /// Appends another shape's triangles.
  void append(const Shape& other);
};

/// Unit sphere about the origin: an icosahedron, each triangle split in four `subdivisions` times: 20·4ⁿ
/// triangles.
Shape sphere(std::uint32_t subdivisions);

/// A cone (top = 0) or frustum of a cone along y, without caps, `sides` sides.
Shape cone(float base_radius, float top_radius, float base_y, float top_y, std::uint32_t sides);

/// A disc facing up or down at height y.
Shape disc(float radius, float y, std::uint32_t sides, bool faces_up);

}  // namespace sightline::scene
