// What rays at boxes stop at, and what they go on through.
#pragma once

#include <span>
#include <vector>

#include <sightline/rays.hpp>
#include <sightline/workbench/scene.hpp>

#include "library/rays/bvh.hpp"
#include "library/rays/ray_hits.hpp"

namespace sightline::methods {

/// The boxes of opaque objects, which stop a ray, numbered on their own; and a tree over those of cut-outs
/// and transparent objects, which a ray sees and goes on through.
class RayTargets {
public:
  /// The scene outlives this.
  explicit RayTargets(const Scene& scene);
  /// Told after objects have moved.
  void update();

  /// Of opaque objects, ascending by id: what is cast at.
  [[nodiscard]] const Boxes& solid() const noexcept { return mixed() ? solid_ : scene_.bounds; }
  /// Whose box solid()[slot] is.
  [[nodiscard]] ObjectId object(std::size_t slot) const noexcept {
    return mixed() ? solid_ids_[slot] : static_cast<ObjectId>(slot);
  }
  [[nodiscard]] std::span<const ObjectId> solid_ids() const noexcept { return solid_ids_; }
  /// Whether something hides nothing.
  [[nodiscard]] bool mixed() const noexcept { return !see_through_ids_.empty(); }
  /// Over what hides nothing; leaves bear objects' ids.
  [[nodiscard]] std::span<const rays::BvhNode> see_through() const noexcept { return nodes_; }

  /// Turns hits at solid() into hits at objects, and lists, ascending, every object that a ray met: what
  /// stopped it, and what hides nothing and lies before that. `seen` is scratch.
  void collect(std::span<const PreparedRay> rays, rays::RayHits& hits, std::vector<std::uint8_t>& seen,
               std::vector<ObjectId>& visible) const;

private:
  void look_through(const PreparedRay& ray, float limit, std::vector<std::uint8_t>& seen) const;

  const Scene& scene_;
  Boxes solid_, boxes_;
  std::vector<ObjectId> solid_ids_, see_through_ids_;
  rays::Bvh bvh_;
  std::vector<rays::BvhNode> nodes_;
};

}  // namespace sightline::methods
