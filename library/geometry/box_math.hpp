// Boxes as sets of points: what holds what, unions, centres, surfaces, coordinates by axis.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <sightline/types.hpp>

namespace sightline::geometry {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Holds nothing; united with it a box stays as it is.
inline constexpr Box kEmptyBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

inline float coordinate(const Vec3& v, std::uint32_t axis) noexcept {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
inline float& coordinate(Vec3& v, std::uint32_t axis) noexcept {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Halves first, so that no finite box overflows.
inline Vec3 centre_of(const Box& b) noexcept {
  return {0.5f * b.min.x + 0.5f * b.max.x, 0.5f * b.min.y + 0.5f * b.max.y, 0.5f * b.min.z + 0.5f * b.max.z};
}

inline Box united(const Box& a, const Box& b) noexcept {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

/// What both hold; where that is nothing, min > max.
inline Box intersected(const Box& a, const Box& b) noexcept {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y), std::max(a.min.z, b.min.z)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y), std::min(a.max.z, b.max.z)}};
}

/// Half the surface; 0 for nothing. Doubles, so that no finite box overflows.
inline double half_area(const Box& box) noexcept {
  if (!(box.min.x <= box.max.x)) return 0;
  const double x = double{box.max.x} - box.min.x, y = double{box.max.y} - box.min.y,
               z = double{box.max.z} - box.min.z;
  return x * y + y * z + z * x;
}

inline bool holds(const Box& outer, const Box& inner) noexcept {
  return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
         outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

}  // namespace sightline::geometry
