// Visible sets ahead of time: Ye et al. 2023 have BOCA compute those of many viewpoints in idle time, and
// look them up when the camera gets there.
#pragma once

#include <span>
#include <vector>

#include <sightline/view.hpp>

#include "library/rays/ray_grid.hpp"
#include "workbench/methods/ray_pvs/ray_targets.hpp"

namespace sightline::methods {

class BreakTimeSets {
public:
  /// The scene outlives this, and does not move. Rays go through the middles of side × side parts of a view.
  BreakTimeSets(const Scene& scene, std::uint32_t side);

  /// The set that boca finds in a view; ascending.
  void cast(const View& view, std::vector<ObjectId>& visible);
  /// Casts a view's set and keeps it.
  void add(const View& view);
  /// The set kept for the nearest eye, of equally near ones for the nearest direction; approximate anywhere
  /// but there. Empty where none is kept. Cost: linear in the views kept.
  [[nodiscard]] std::span<const ObjectId> look_up(const View& view) const noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return kept_.size(); }
  /// That the kept sets take.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return kept_.size() * sizeof(Kept) + objects_.size() * sizeof(ObjectId);
  }

private:
  struct Kept {
    Vec3 eye, direction;
    std::size_t first, count;  ///< range of objects_
  };

  RayTargets targets_;
  rays::Bvh bvh_;
  std::uint32_t side_;
  std::vector<Kept> kept_;
  std::vector<ObjectId> objects_, visible_;
  rays::RayGrid grid_;
  rays::RayHits hits_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace sightline::methods
