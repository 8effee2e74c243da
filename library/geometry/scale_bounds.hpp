// What a transform may do to lengths.
#pragma once

#include <algorithm>
#include <cmath>

#include <sightline/types.hpp>

#include "library/geometry/error_bounds.hpp"

namespace sightline::geometry {

/// How much shorter and longer a direction may become under a transform; `least` may be 0 where it is not
/// known.
struct ScaleBounds {
  float least, most;
};

/// By Gershgorin's discs about the squares of the columns' lengths, rounded outwards.
inline ScaleBounds scale_bounds(const Affine& t) noexcept {
  const auto dot = [&](int a, int b) {
    float sum = 0;
    for (const Vec4& row : t.rows) {
      const float columns[3] = {row.x, row.y, row.z};
      sum += columns[a] * columns[b];
    }
    return sum;
  };
  float least = dot(0, 0), most = 0;
  for (int a = 0; a < 3; ++a) {
    const float middle = dot(a, a), reach = std::fabs(dot(a, (a + 1) % 3)) + std::fabs(dot(a, (a + 2) % 3));
    least = std::min(least, middle - reach);
    most = std::max(most, middle + reach);
  }
  return {least > 0 ? std::sqrt(least) * (1 - kScaleRounding) : 0, std::sqrt(most) * (1 + kScaleRounding)};
}

}  // namespace sightline::geometry
