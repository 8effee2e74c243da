// A scene's triangles in world space, object by object, counter-clockwise from their front.
#pragma once

#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/partition/triangle_split.hpp"

namespace sightline::methods {

struct FlatTriangles {
  std::vector<Vec3> positions;
  std::vector<TextureCoordinate> texture_coordinates;  ///< as many, or none
  std::vector<std::uint32_t> indices;                  ///< three a triangle
  std::vector<ObjectId> objects;                       ///< one a triangle
  std::vector<Sides> sides;                            ///< one an object: those that are drawn

  [[nodiscard]] partition::TriangleSpan span() const noexcept { return {positions, indices}; }
  [[nodiscard]] std::size_t size() const noexcept { return objects.size(); }
};

FlatTriangles flatten(const Scene& scene);

/// Appends an object's indices, which count from `base`, as its transform turns them.
void append_indices(const Scene& scene, ObjectId object, std::uint32_t base,
                    std::vector<std::uint32_t>& indices);

/// Whether flattening stays within bounds: no more than 100 M triangles, and no more than 2 M or twice those
/// that the meshes hold, so that a million instances of one tree are not written out.
bool can_flatten(const Scene& scene);
inline constexpr const char* kFlattenNeeds = "triangles few enough to be written out in world space";

}  // namespace sightline::methods
