// The plain aggregates every other header speaks in. No maths library is imposed on an engine.
// World space is right-handed, y up, in metres: a World of centimetres falls into far too many sectors, while
// which axis is up makes no difference to it. Matrices are column-major and multiply columns: there is one
// matrix type, and one order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sightline {

/// An object's number: its place in the caller's arrays, or what a World gave it.
using ObjectId = std::uint32_t;
/// The number of no object.
inline constexpr ObjectId kNoObject = 0xffffffffu;

/// A point or a direction.
struct Vec3 {
  float x = 0, y = 0, z = 0;  ///< metres, of a point
  bool operator==(const Vec3&) const = default;
};

/// Four numbers: a row of a matrix, a point in clip space.
struct Vec4 {
  float x = 0, y = 0, z = 0, w = 0;  ///< columns 0 … 3, of a row
  bool operator==(const Vec4&) const = default;
};

/// 4×4, column-major: element (row r, column c) is m[4·c + r].
struct Mat4 {
  /// The identity, unless set.
  std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  bool operator==(const Mat4&) const = default;
};

/// Axis-aligned bounding box, borders included. Valid iff finite and min <= max on each axis.
struct Box {
  Vec3 min, max;  ///< metres
  bool operator==(const Box&) const = default;
};

/// A point in metres, in double precision.
struct WorldPoint {
  double x = 0, y = 0, z = 0;  ///< metres
  bool operator==(const WorldPoint&) const = default;
};

/// A box in metres. Valid iff min <= max on each axis and all coordinates lie within ±kWorldReach.
struct WorldBox {
  WorldPoint min, max;  ///< metres
  bool operator==(const WorldBox&) const = default;
};

/// 10¹¹ m: beyond this boxes and views are refused.
inline constexpr double kWorldReach = 1e11;

/// A ball, in metres. Valid iff finite and radius >= 0.
struct Sphere {
  Vec3 centre;       ///< metres
  float radius = 0;  ///< metres
  bool operator==(const Sphere&) const = default;
};

/// The half space normal · p + distance >= 0; the normal has unit length unless a function says otherwise.
struct Plane {
  Vec3 normal;         ///< points into the half space
  float distance = 0;  ///< metres from the plane to the origin; negative where the origin is outside
  bool operator==(const Plane&) const = default;
};

/// A rectangle of the image in pixels, x to the right, y down, origin at the top left corner. Its samples
/// are the pixel centres c with min < c < max.
struct Rect {
  float min_x = 0, min_y = 0, max_x = 0, max_y = 0;  ///< pixels
  bool operator==(const Rect&) const = default;
};

}  // namespace sightline
