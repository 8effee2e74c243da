// What rays see of the triangles themselves: no box hides what its own geometry does not.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/rays.hpp>
#include <sightline/workbench/scene.hpp>

#include "library/rays/ray_hits.hpp"
#include "library/rays/wide_bvh.hpp"

namespace sightline::partition {

/// A tree over objects and one over each mesh's triangles, met from the sides that are drawn. Opaque objects
/// hide what lies behind them; cut-outs and transparent ones are seen where nothing opaque lies before, and
/// hide nothing.
class TriangleRays {
public:
  /// The scene has passed check() and outlives this.
  explicit TriangleRays(const Scene& scene);
  /// Told after Scene::move_object.
  void update();

  /// Waiting nodes; one a thread.
  struct Stack {
    std::vector<std::uint64_t> objects, triangles;
  };

  /// For each ray the nearest opaque object, or kNoObject, in `nearest`; of equally near objects, the lower
  /// id. Sets seen[o] to 1 for it, for up to seven more that lie on the same spot up to rounding (of two
  /// coincident faces nobody knows which one a renderer shows), and for each that hides nothing before it.
  /// Adds to `stats`.
  void cast(std::span<const Ray> rays, std::span<ObjectId> nearest, std::span<std::uint8_t> seen,
            Stack& stack, rays::RayStats& stats) const;

  struct Triangle {
    Vec3 a, ab, ac;
  };
  struct MeshTree {
    rays::WideBvh bvh;
    std::vector<Triangle> triangles;
  };
  struct Kind {
    std::vector<ObjectId> ids;  ///< whom the tree's boxes belong to
    rays::WideBvh bvh;
  };

private:
  void refresh();

  const Scene& scene_;
  std::vector<MeshTree> meshes_;
  std::vector<Affine> to_mesh_;           ///< one an object: world space to mesh space
  std::vector<std::uint8_t> invertible_;  ///< 0: flattened by its transform; its box is taken for it
  Kind opaque_, see_through_;
  std::size_t stack_size_ = 0;
};

}  // namespace sightline::partition
