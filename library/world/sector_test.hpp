// Whether a view surely misses a sector: said in double precision from the sector's bounds, before anything
// is worked out relative to the sector.
#pragma once

#include <array>

#include <sightline/frustum.hpp>
#include <sightline/world.hpp>

namespace sightline::world {

class SectorTest {
public:
  SectorTest() = default;
  explicit SectorTest(const WorldView& view) noexcept;

  /// True only where the frustum relative to the sector's origin (geometry::frustum_of with these bounds) has
  /// the bounds outside, too: leaving such a sector out changes no result. Remembers the plane that failed
  /// and tries it first, for sectors that follow one another are often neighbours.
  [[nodiscard]] bool misses(const WorldPoint& origin, const Box& bounds) noexcept;

private:
  /// Unit normal n and distance d about the view's origin; `error` is what |n| and |d| were before products
  /// cancelled out, and bounds what double precision lost on the way.
  struct WidePlane {
    std::array<double, 3> normal{}, normal_error{};
    double distance = 0, distance_error = 0;
  };
  [[nodiscard]] bool outside(const WidePlane& plane, const WorldPoint& at, const Box& bounds) const noexcept;

  WorldPoint origin_;
  std::array<WidePlane, Frustum::sides> planes_;
  std::size_t count_ = 0;  ///< planes that are not at infinity
  std::size_t last_ = 0;
};

}  // namespace sightline::world
