// Turns about y whose bits are the same on every platform: no sine, no cosine.
#pragma once

#include <sightline/workbench/affine.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::scene {

/// Cosine and sine of a heading.
struct Turn {
  float c = 1, s = 0;
};

inline constexpr std::array<Turn, 4> kQuarterTurns{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Any heading: a rational point of the circle, in a quarter by chance.
inline Turn random_turn(Random& random) noexcept {
  const float t = random.unit(), d = 1 + t * t, c = (1 - t * t) / d, s = 2 * t / d;
  switch (random.below(4)) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

/// Scaled along each axis, turned about y, and moved.
inline Affine placed(const Vec3& at, const Vec3& scale, const Turn& turn) noexcept {
  const auto [c, s] = turn;
  return {{Vec4{c * scale.x, 0, s * scale.z, at.x}, Vec4{0, scale.y, 0, at.y},
           Vec4{-s * scale.x, 0, c * scale.z, at.z}}};
}

}  // namespace sightline::scene
