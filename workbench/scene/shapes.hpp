// The few shapes that generated worlds are made of.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::scene {

struct Shape {
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  std::vector<TextureCoordinate> texture_coordinates;  ///< as many as positions, or none

  /// Appends another shape's triangles. Where one of the two has texture coordinates, so has the whole.
  void append(const Shape& other);
};

/// Unit sphere about the origin: an icosahedron, each triangle split in four `subdivisions` times: 20·4ⁿ
/// triangles.
Shape sphere(std::uint32_t subdivisions);

/// A cone (top = 0) or frustum of a cone along y, without caps, `sides` sides.
Shape cone(float base_radius, float top_radius, float base_y, float top_y, std::uint32_t sides);

/// A disc facing up or down at height y.
Shape disc(float radius, float y, std::uint32_t sides, bool faces_up);

/// A box whose faces look outwards, six times four vertices.
Shape box(const Box& extent);

/// An upright rectangle that looks along +z, its foot centred on the origin. The texture is repeated `across`
/// times from left to right and `up` times, its top at the top.
Shape card(float width, float height, float across = 1, float up = 1);

}  // namespace sightline::scene
