// The plain aggregates every other header speaks in. No maths library is imposed on an engine.
// World space is right-handed, y up, in metres. Matrices are column-major and multiply columns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sightline {

/// An object's number: its place in the caller's arrays, or what a World gave it.
using ObjectId = std::uint32_t;
inline constexpr ObjectId kNoObject = 0xffffffffu;

struct Vec3 {
  float x = 0, y = 0, z = 0;
  bool operator==(const Vec3&) const = default;
};

struct Vec4 {
  float x = 0, y = 0, z = 0, w = 0;
  bool operator==(const Vec4&) const = default;
};

/// 4×4, column-major: element (row r, column c) is m[4·c + r].
struct Mat4 {
  std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  bool operator==(const Mat4&) const = default;
};

/// Affine transform, three rows of (linear part | translation).
struct Affine {
  std::array<Vec4, 3> rows{Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}};
  bool operator==(const Affine&) const = default;
};

Vec3 transform_point(const Affine& affine, const Vec3& point) noexcept;

/// Axis-aligned bounding box, borders included. Valid iff finite and min <= max on each axis.
struct Box {
  Vec3 min, max;
  bool operator==(const Box&) const = default;
};

/// A point in metres, in double precision.
struct WorldPoint {
  double x = 0, y = 0, z = 0;
  bool operator==(const WorldPoint&) const = default;
};

/// A box in metres. Valid iff min <= max on each axis and all coordinates lie within ±kWorldReach.
struct WorldBox {
  WorldPoint min, max;
  bool operator==(const WorldBox&) const = default;
};

/// 10¹¹ m: beyond this boxes and views are refused.
inline constexpr double kWorldReach = 1e11;

struct Sphere {
  Vec3 centre;
  float radius = 0;
  bool operator==(const Sphere&) const = default;
};

/// The half space normal · p + distance >= 0; the normal has unit length unless a function says otherwise.
struct Plane {
  Vec3 normal;
  float distance = 0;
  bool operator==(const Plane&) const = default;
};

/// A rectangle of the image in pixels, x to the right, y down, origin at the top left corner; half open
/// in spirit: the samples it holds are the pixel centres c with min < c < max.
struct Rect {
  float min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  bool operator==(const Rect&) const = default;
};

}  // namespace sightline
