// What the world holds: objects in structure of arrays, and the meshes they show.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/occluder.hpp>
#include <sightline/pvs.hpp>
#include <sightline/types.hpp>
#include <sightline/workbench/affine.hpp>
#include <sightline/workbench/level_pvs.hpp>
#include <sightline/world.hpp>

namespace sightline {

/// A range of the scene's index and vertex arrays. Indices count from `first_vertex`, three a triangle.
struct Mesh {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
};

/// What a surface does to what lies behind it.
enum class Surface : std::uint8_t {
  opaque,       ///< hides it
  cut_out,      ///< drawn where its alpha says so, seen, never an occluder: glTF's MASK, a shader's alphaFunc
  transparent,  ///< drawn last, far to near, blended; hides nothing
};

/// Alpha over texture coordinates, 8 bits a texel, rows from the top: texel (x, y) covers u of x / width …
/// (x + 1) / width and v of y / height … (y + 1) / height. Repeated without end in both directions.
struct AlphaImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> alpha;  ///< width × height
  bool operator==(const AlphaImage&) const = default;
};

/// The alpha image of what has none.
inline constexpr std::uint32_t kNoAlphaImage = ~0u;

/// What an object's triangles look like, as far as culling cares.
struct Material {
  Surface surface = Surface::opaque;
  Sides sides = Sides::both;
  std::uint32_t alpha_image = kNoAlphaImage;  ///< of Scene::alpha_images; a cut-out without is drawn whole
  std::uint8_t alpha_cutoff = 128;            ///< a cut-out is drawn where alpha >= this

  Material() = default;
  /// Both sides, no image.
  Material(Surface of) : surface(of) {}
  Material(Surface of, Sides drawn, std::uint32_t image = kNoAlphaImage, std::uint8_t cutoff = 128)
      : surface(of), sides(drawn), alpha_image(image), alpha_cutoff(cutoff) {}
  bool operator==(const Material&) const = default;
};

/// In which state triangles are drawn: part of what "exact" means.
enum class RasterState : std::uint8_t {
  materials,    ///< each object's sides as its material has them
  both_sides,   ///< all triangles, from wherever they are seen
  front_faces,  ///< only triangles seen from their front
};

/// "materials", "both sides" or "front faces".
std::string_view to_string(RasterState state) noexcept;

/// A place in a texture: u to the right, v down; 0 … 1 is the whole image, beyond it repeats.
struct TextureCoordinate {
  float u = 0, v = 0;
  bool operator==(const TextureCoordinate&) const = default;
};

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
  std::vector<Sides> sides;                ///< drawn, in the raster state that is set
  std::vector<Sides> material_sides;       ///< drawn, as the materials have it
  std::vector<std::uint32_t> alpha_image;  ///< of `alpha_images`, or kNoAlphaImage
  std::vector<std::uint8_t> alpha_cutoff;  ///< a cut-out is drawn where alpha >= this
  std::vector<std::uint32_t> layers;       ///< a bit a layer that it is in, as World has them; all unless set

  // geometry
  std::vector<Mesh> meshes;
  std::vector<Vec3> positions;                         ///< mesh space
  std::vector<Vec3> normals;                           ///< mesh space, unit length, as many as positions
  std::vector<TextureCoordinate> texture_coordinates;  ///< as many as positions, or none at all
  std::vector<std::uint32_t> indices;
  std::vector<AlphaImage> alpha_images;

  RasterState raster_state = RasterState::materials;  ///< what `sides` was set to last
  /// All positions of this scene count from here: those of objects, viewpoints, waypoints and the level. Not
  /// 0 where the scene's file lies so far out that floats could not tell its points apart.
  WorldPoint origin;

  std::vector<std::string> ignored;  ///< what its file says that no part of this does, and what that means

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

  [[nodiscard]] Material material(ObjectId object) const noexcept {
    return {surface[object], material_sides[object], alpha_image[object], alpha_cutoff[object]};
  }

  /// Appends a mesh; `indices` count from 0 within it. Without normals they are computed: at each vertex
  /// those of the triangles around it, weighted by area. Throws Error for another number of normals or of
  /// texture coordinates than of positions; there may be none of either.
  std::uint32_t add_mesh(std::span<const Vec3> positions, std::span<const Vec3> normals,
                         std::span<const std::uint32_t> indices,
                         std::span<const TextureCoordinate> texture_coordinates = {});
  /// Appends an image for materials to name, and returns its number.
  std::uint32_t add_alpha_image(AlphaImage image);
  /// Appends an object and computes its bounds and radius from the mesh's vertices. Throws Error where there
  /// is no such mesh or alpha image.
  ObjectId add_object(std::uint32_t mesh, const Affine& transform, const Material& material = {});
  /// Gives an object a new transform, and recomputes its bounds and radius. Throws Error where there is no
  /// such object.
  void move_object(ObjectId object, const Affine& transform);
};

/// Union of all object bounds; a zero box at the origin where there are none.
Box extent(const Scene& scene) noexcept;

std::uint64_t triangle_count(const Scene& scene) noexcept;

/// Sets which sides of every object are drawn; with RasterState::materials, as they were made.
void set_raster_state(Scene& scene, RasterState state);

/// A number that scenes of other objects, other bounds, another origin, or other cut-outs and sides as drawn
/// all but surely do not share (FNV-1a, 64 bits).
std::uint64_t fingerprint(const Scene& scene) noexcept;

/// Throws Error unless the scene can be worked with: arrays of matching length, indices in range, bounds
/// finite and min <= max, radii and texture coordinates finite, alpha images of the size they say, texture
/// coordinates wherever an object shows an image. An empty scene is refused: there is nothing to decide.
void check(const Scene& scene);

}  // namespace sightline
