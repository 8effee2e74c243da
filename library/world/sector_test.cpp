#include "library/world/sector_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"

namespace sightline::world {

using namespace geometry;

namespace {

glm::dmat4 absolute(const glm::dmat4& m) {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2]), glm::abs(m[3])};
}

}  // namespace

SectorTest::SectorTest(const WorldView& view) noexcept : origin_(view.origin) {
  const glm::dmat4 to_clip = to_double(view.view.eye_to_clip), to_eye = to_double(view.view.world_to_eye);
  const glm::dmat4 rows = glm::transpose(to_clip * to_eye);
  const glm::dmat4 sizes = glm::transpose(absolute(to_clip) * absolute(to_eye));
  const auto add = [&](const glm::dvec4& plane, const glm::dvec4& size) {
    const double length = glm::length(glm::dvec3(plane));
    if (!(length > 0)) return;
    const glm::dvec4 unit = plane / length, error = size / length;
    planes_[count_++] = {{unit.x, unit.y, unit.z}, {error.x, error.y, error.z}, unit.w, error.w};
  };
  for (const int axis : {0, 1}) {
    add(rows[3] + rows[axis], sizes[3] + sizes[axis]);
    add(rows[3] - rows[axis], sizes[3] + sizes[axis]);
  }
  add(rows[2], sizes[2]);
  add(rows[3] - rows[2], sizes[3] + sizes[2]);
}

bool SectorTest::outside(const WidePlane& plane, const WorldPoint& at, const Box& bounds) const noexcept {
  const auto& n = plane.normal;
  const auto& e = plane.normal_error;
  const double x = at.x - origin_.x, y = at.y - origin_.y, z = at.z - origin_.z;
  const double distance = n[0] * x + n[1] * y + n[2] * z + plane.distance;
  // The sector's own planes take one this far off for one at infinity (from 1e12 m on), and never reject.
  if (!(std::fabs(distance) < 5e11)) return false;
  const Vec3 reach = largest(bounds);
  const auto best = [](double normal, float min, float max) {
    return normal * static_cast<double>(normal >= 0 ? max : min);
  };
  const double nearest = best(n[0], bounds.min.x, bounds.max.x) + best(n[1], bounds.min.y, bounds.max.y) +
                         best(n[2], bounds.min.z, bounds.max.z) + distance;
  if (nearest >= 0) return false;
  if (SIGHTLINE_MUTANT(sectors_tested_by_centre)) return distance < 0;
  // The sector's planes are moved outwards by 4 epsilons of this, and lose at most 4 more in single
  // precision.
  const double magnitude = std::fabs(n[0]) * static_cast<double>(reach.x) +
                           std::fabs(n[1]) * static_cast<double>(reach.y) +
                           std::fabs(n[2]) * static_cast<double>(reach.z) + std::fabs(distance);
  const double products = e[0] * (std::fabs(x) + static_cast<double>(reach.x)) +
                          e[1] * (std::fabs(y) + static_cast<double>(reach.y)) +
                          e[2] * (std::fabs(z) + static_cast<double>(reach.z)) + plane.distance_error;
  constexpr double kSingle = 16 * std::numeric_limits<float>::epsilon();
  constexpr double kDouble = 64 * std::numeric_limits<double>::epsilon();
  return nearest < -(kSingle * magnitude + kDouble * products + 1e-30);
}

bool SectorTest::misses(const WorldPoint& origin, const Box& bounds) noexcept {
  if (count_ == 0) return false;
  if (outside(planes_[last_], origin, bounds)) return true;
  for (std::size_t p = 0; p < count_; ++p) {
    if (p == last_ || !outside(planes_[p], origin, bounds)) continue;
    last_ = p;
    return true;
  }
  return false;
}

}  // namespace sightline::world
