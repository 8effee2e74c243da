// How far along the view's direction a box lies: what draws are ordered by.
#pragma once

#include <bit>
#include <cstdint>

#include <sightline/types.hpp>

namespace sightline::geometry {

/// Of the box's centre.
inline float view_depth(const Box& box, const Vec3& eye, const Vec3& forward) noexcept {
  return (0.5f * (box.min.x + box.max.x) - eye.x) * forward.x +
         (0.5f * (box.min.y + box.max.y) - eye.y) * forward.y +
         (0.5f * (box.min.z + box.max.z) - eye.z) * forward.z;
}

/// Floats in the order of their values as unsigned integers.
inline std::uint32_t sortable(float value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

}  // namespace sightline::geometry
