// Boxes and spheres out of the caller's memory, in the layouts that the library works on.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/types.hpp>

namespace sightline {

namespace geometry {

/// `count` boxes, one array a coordinate.
struct BoxSpan {
  const float *min_x = nullptr, *min_y = nullptr, *min_z = nullptr;
  const float *max_x = nullptr, *max_y = nullptr, *max_z = nullptr;
  std::size_t count = 0;
};

/// Of six arrays: min x, y, z, max x, y, z.
template <class Rows>
[[nodiscard]] BoxSpan span_of(const Rows& rows, std::size_t count) noexcept {
  return {rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data(),
          rows[4].data(), rows[5].data(), count};
}

/// `count` spheres, one array a coordinate.
struct SphereSpan {
  const float *x = nullptr, *y = nullptr, *z = nullptr, *radius = nullptr;
  std::size_t count = 0;
};

/// How many boxes or spheres are laid out at a time.
inline constexpr std::size_t kBlock = 64;

/// Whether boxes of every form are read by code of its own; not where each byte of it is loaded by whoever
/// opens a web page.
#ifdef __wasm__
inline constexpr bool kEveryFormIsQuick = false;
#else
inline constexpr bool kEveryFormIsQuick = true;
#endif

/// One array a coordinate, on the stack.
struct BoxBlock {
  alignas(64) std::array<std::array<float, kBlock>, 6> values;
  [[nodiscard]] BoxSpan span(std::size_t count) const noexcept { return span_of(values, count); }
};
struct SphereBlock {
  alignas(64) std::array<std::array<float, kBlock>, 4> values;
  [[nodiscard]] SphereSpan span(std::size_t count) const noexcept {
    return {values[0].data(), values[1].data(), values[2].data(), values[3].data(), count};
  }
};

/// min <= max on each axis and within ±kWorldReach; false for what is no number.
inline bool is_valid(const WorldBox& b) noexcept {
  const auto is_range = [](double low, double high) {
    return low >= -kWorldReach && high <= kWorldReach && low <= high;
  };
  return is_range(b.min.x, b.max.x) && is_range(b.min.y, b.max.y) && is_range(b.min.z, b.max.z);
}
/// Within ±kWorldReach on each axis; false for what is no number.
inline bool in_reach(const WorldPoint& p) noexcept {
  return std::fabs(p.x) <= kWorldReach && std::fabs(p.y) <= kWorldReach && std::fabs(p.z) <= kWorldReach;
}

/// The box about an origin, rounded outwards.
Box relative_box(const WorldBox& box, const WorldPoint& origin) noexcept;
/// The other way: where a box about an origin stands, to the nearest.
inline WorldBox world_box(const Box& b, const WorldPoint& o) noexcept {
  return {{o.x + double{b.min.x}, o.y + double{b.min.y}, o.z + double{b.min.z}},
          {o.x + double{b.max.x}, o.y + double{b.max.y}, o.z + double{b.max.z}}};
}
/// As relative_box(), rounded inwards.
Box inner_box(const WorldBox& box, const WorldPoint& origin) noexcept;

}  // namespace geometry

/// All of sound views, and of indices below their sizes.
struct BoxReader {
  /// Boxes first … first + count - 1, rounded outwards or inwards.
  static void read(const BoxView& view, std::size_t first, std::size_t count, WorldBox* out,
                   bool outwards) noexcept;
  /// Whether boxes first … first + count - 1 surely are valid, at a quick look: it does not say so where one
  /// reaches nearly as far as it may.
  static bool surely_valid(const BoxView& view, std::size_t first, std::size_t count) noexcept;
  /// Whether the boxes lie as one array a coordinate about `origin`, so that they can be read where they are.
  static bool lies_in_arrays(const BoxView& view, const WorldPoint& origin, geometry::BoxSpan& out) noexcept;
  static bool lies_in_arrays(const SphereView& view, geometry::SphereSpan& out) noexcept;
  /// Whether they are given by minimum and maximum in single precision, so that a copy is as good.
  static bool are_float_corners(const BoxView& view) noexcept {
    return !view.doubles_ && view.form_ == BoxView::corners;
  }
  /// The same as structs, one after another.
  static bool lies_as_structs(const BoxView& view, const WorldPoint& origin,
                              std::span<const Box>& out) noexcept;
  static bool lies_as_structs(const SphereView& view, std::span<const Sphere>& out) noexcept;
  /// At most kBlock boxes about an origin, rounded outwards.
  static geometry::BoxSpan lay_out(const BoxView& view, std::size_t first, std::size_t count,
                                   const WorldPoint& origin, geometry::BoxBlock& out) noexcept;
  static geometry::SphereSpan lay_out(const SphereView& view, std::size_t first, std::size_t count,
                                      geometry::SphereBlock& out) noexcept;
};

}  // namespace sightline
