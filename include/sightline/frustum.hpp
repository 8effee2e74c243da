// The view frustum as six planes taken from the matrix (Gribb & Hartmann 2001), never from angles, so that
// every projection works, and the tests of a box or a sphere against it.
//
// All tests evaluate ((nx·x + ny·y) + nz·z) + d in single precision without fused operations, so they are
// monotonic in each coordinate: what holds for a cell's corner holds for everything inside the cell, to the
// bit, and the answer is the same for every SIMD width.
#pragma once

#include <array>
#include <span>

#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// Six inward planes. A plane at infinity (infinite far) has a zero normal and never rejects.
struct Frustum {
  enum Side : std::size_t { left, right, bottom, top, front, back, sides };  ///< front/back: near/far
  std::array<Plane, sides> planes;
};

enum class Overlap : std::uint8_t { outside, crossing, inside };

/// The view's frustum, its planes normalised. `extent` bounds all coordinates that will be tested: the
/// planes are moved outwards by the rounding error of a test within it, so that no test ever rejects
/// what exact arithmetic keeps.
Frustum make_frustum(const View& view, const Box& extent) noexcept;

/// Signed distance in the one evaluation order that all tests share.
inline float signed_distance(const Plane& plane, float x, float y, float z) noexcept {
  return ((plane.normal.x * x + plane.normal.y * y) + plane.normal.z * z) + plane.distance;
}

/// p-vertex / n-vertex test (Greene 1994). `outside` is certain; `crossing` may be outside near an edge.
Overlap classify(const Frustum& frustum, const Box& box) noexcept;

/// Whether the box has its p-vertex inside every plane.
bool overlaps(const Frustum& frustum, const Box& box) noexcept;

/// Whether the centre lies no deeper than -radius behind every plane.
bool overlaps(const Frustum& frustum, const Sphere& sphere) noexcept;

}  // namespace sightline
