// A scene's occluders in an OcclusionBuffer, and what they leave of a list of objects: what masked does, and
// methods that put it behind a cull of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::methods {

/// Which objects occlude; the defaults are masked's.
struct OccluderChoice {
  std::uint32_t most = 512;      ///< at most so many as meshes, the largest on the image
  float least_area = 150;        ///< px², of such an occluder's bounding sphere
  float least_sphere = 5;        ///< px², of an object that occludes by the sphere inside it
  std::uint32_t whole = 150000;  ///< most triangles of a scene that occludes as one
  bool all_solid = false;        ///< everything occludes, from both sides
  /// Which places of the image are answered for, and how finely: centres are where its pictures are sampled.
  OcclusionOptions buffer{Coverage::centres};
};

/// Objects that share few meshes occlude one by one, the largest on the image, round ones as spheres, which
/// are cheap. A scene that is one built thing of few triangles, like a game level, occludes as a whole, and
/// objects are asked for triangle by triangle. The scene outlives this.
class SceneOccluders {
public:
  explicit SceneOccluders(const Scene& scene, const OccluderChoice& choice = {});

  /// Told after Scene::move_object of each of `objects`, before the next frame.
  void update(std::span<const ObjectId> objects);

  /// False where the scene is beyond what the library takes: then nothing can be said to be hidden.
  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// Whether the scene occludes as one, whatever is in view.
  [[nodiscard]] bool as_one() const noexcept { return whole_.has_value(); }

  /// Begins the buffer and draws what occludes of `candidates`, the objects in view. False where it holds no
  /// such view.
  bool draw(const WorldView& at, std::span<const ObjectId> candidates);
  [[nodiscard]] const OcclusionBuffer& buffer() const noexcept { return buffer_; }

  /// Of what its box leaves, an object's triangles or its sphere may drop some more. Keeps the rest in front,
  /// in order, and returns how many.
  std::size_t keep_seen(std::span<ObjectId> visible);
  /// The same of objects whose boxes nobody has asked for yet.
  std::size_t keep_unhidden(std::span<ObjectId> visible);

private:
  // A mesh, and what lies inside it and is drawn in its place.
  struct Occluder {
    std::optional<OccluderMesh> whole, proxy;
    std::optional<Sphere> sphere;
  };
  struct Picked {
    float area, distance;
    ObjectId object;
    bool cut;  // by the near plane
  };

  [[nodiscard]] bool occludes(ObjectId o) const noexcept;
  [[nodiscard]] Sides sides_of(ObjectId o) const noexcept;
  [[nodiscard]] std::size_t occluder_of(ObjectId o) const noexcept;
  void append_corners(ObjectId o);
  bool take_triangles();
  void build_whole();
  void find_occluders();
  void pick_occluders(const View& view, std::span<const ObjectId> candidates);
  void draw_picked_spheres();
  void draw_picked_meshes();
  std::size_t keep_seen_spheres(std::span<ObjectId> visible);

  const Scene& scene_;
  OccluderChoice choice_;
  OcclusionBuffer buffer_;
  std::vector<std::uint8_t> moved_;
  std::optional<OccluderMesh> whole_;  // where the scene occludes as one
  OccludeeTriangles occludees_;        // of all objects, where it does
  std::vector<Vec3> corners_;          // of the objects at hand
  std::vector<Occluder> occluders_;    // two a mesh, by its sides, where it does not
  Box extent_;                         // of the scene, as it stands
  std::vector<Picked> picked_;
  std::vector<std::uint64_t> near_first_;  // squared distance and object
  std::vector<Sphere> drawn_spheres_;
  std::vector<std::uint8_t> seen_;
  bool usable_ = true;
};

}  // namespace sightline::methods
