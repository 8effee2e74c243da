// What the world holds: objects in structure of arrays, and the meshes they show.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/pvs.hpp>
#include <sightline/types.hpp>
#include <sightline/workbench/affine.hpp>
#include <sightline/workbench/level_pvs.hpp>

namespace sightline {

/// A range of the scene's index and vertex arrays. Indices count from `first_vertex`, three a triangle.
struct Mesh {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
};

enum class Surface : std::uint8_t { opaque, transparent };

/// A named place to look from: a level's spawn point, a file's camera, a generated world's own view.
struct Viewpoint {
  std::string name;
  Vec3 eye{};
  Vec3 forward{0, 0, -1};
};

/// Objects and geometry. All object arrays have the same length; an object is its index in them.
struct Scene {
  std::string name;

  // objects
  Boxes bounds;               ///< world space, tight around the transformed vertices
  std::vector<float> radius;  ///< of the bounding sphere about the centre of the bounds, metres
  std::vector<std::uint32_t> mesh;
  std::vector<Affine> transform;  ///< mesh space to world space
  std::vector<Surface> surface;

  // geometry
  std::vector<Mesh> meshes;
  std::vector<Vec3> positions;  ///< mesh space
  std::vector<Vec3> normals;    ///< mesh space, unit length, as many as positions
  std::vector<std::uint32_t> indices;

  std::vector<Viewpoint> viewpoints;
  std::vector<Vec3> waypoints;           ///< places known to be free, that a walk may lead through
  std::optional<LevelPvs> level;         ///< the visibility another program computed, where the file has one
  std::shared_ptr<const CellPvs> cells;  ///< what was baked for this scene, where somebody loaded it

  [[nodiscard]] std::size_t size() const noexcept { return mesh.size(); }
  [[nodiscard]] bool empty() const noexcept { return mesh.empty(); }
  [[nodiscard]] Sphere sphere(ObjectId object) const noexcept;
  [[nodiscard]] std::uint64_t triangles(ObjectId object) const noexcept {
    return meshes[mesh[object]].index_count / 3;
  }

  /// Appends a mesh; `indices` count from 0 within it. Without normals they are computed: at each vertex
  /// those of the triangles around it, weighted by area. Throws Error for another number of normals than of
  /// positions.
  std::uint32_t add_mesh(std::span<const Vec3> positions, std::span<const Vec3> normals,
                         std::span<const std::uint32_t> indices);
  /// Appends an object and computes its bounds and radius from the mesh's vertices. Throws Error where there
  /// is no such mesh.
  ObjectId add_object(std::uint32_t mesh, const Affine& transform, Surface surface = Surface::opaque);
  /// Gives an object a new transform, and recomputes its bounds and radius. Throws Error where there is no
  /// such object.
  void move_object(ObjectId object, const Affine& transform);
};

/// Union of all object bounds; a zero box at the origin where there are none.
Box extent(const Scene& scene) noexcept;

std::uint64_t triangle_count(const Scene& scene) noexcept;

/// A number that scenes of other objects or other bounds all but surely do not share (FNV-1a, 64 bits).
std::uint64_t fingerprint(const Scene& scene) noexcept;

/// Throws Error unless the scene can be worked with: arrays of matching length, indices in range, bounds
/// finite and min <= max, radii finite. An empty scene is refused: there is nothing to decide.
void check(const Scene& scene);

}  // namespace sightline
