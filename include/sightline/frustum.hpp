// The view frustum as six planes taken from the matrix (Gribb & Hartmann 2001), never from angles, so that
// every projection works; the tests of a box or a sphere against it; and flat culling of whole arrays, in
// SIMD.
//
// All tests evaluate ((nx·x + ny·y) + nz·z) + d in single precision without fused operations, so they are
// monotonic in each coordinate: what holds for a cell's corner holds for everything inside the cell, to the
// bit, and the answer is the same for every SIMD width and processor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// Six inward planes about `origin`. A plane at infinity (infinite far) has a zero normal and never rejects.
struct Frustum {
  /// The order of the planes; front is near and back is far.
  enum Side : std::size_t { left, right, bottom, top, front, back, sides };
  std::array<Plane, sides> planes;  ///< their normals point inwards
  WorldPoint origin;                ///< the planes are relative to it
};

/// How a box lies to a frustum: surely outside, across its border or near it, wholly inside.
enum class Overlap : std::uint8_t { outside, crossing, inside };

/// The frustum of a view, its planes normalised and moved outwards by the rounding error of a test, wherever
/// in the frustum that happens: no test ever rejects what exact arithmetic keeps. They move by some 1e-6 of
/// the distance from the eye and of the eye's from the origin: give a far eye an origin near it (WorldView).
/// Errors: none; the view is one that check() finds sound. Cost: constant. Threads: any. Allocates: nothing.
Frustum make_frustum(const WorldView& view) noexcept;
/// The same about the world's origin. Errors, Cost, Threads, Allocates: the same.
Frustum make_frustum(const View& view) noexcept;

/// Signed distance in metres in the one evaluation order that all tests share.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
inline float signed_distance(const Plane& plane, float x, float y, float z) noexcept {
  return ((plane.normal.x * x + plane.normal.y * y) + plane.normal.z * z) + plane.distance;
}

/// p-vertex / n-vertex test (Greene 1994) of a box in metres about the frustum's origin. `outside` is
/// certain; `crossing` may be outside near an edge. Errors: none. Cost: constant. Threads: any. Allocates:
/// nothing.
Overlap classify(const Frustum& frustum, const Box& box) noexcept;

/// Whether classify() says anything but `outside`.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
bool overlaps(const Frustum& frustum, const Box& box) noexcept;

/// Whether the centre lies no deeper than a radius behind every plane. Errors: none. Cost: constant. Threads:
/// any. Allocates: nothing.
bool overlaps(const Frustum& frustum, const Sphere& sphere) noexcept;

/// Room that an output of the functions below needs beyond the input's count.
inline constexpr std::size_t kCullPadding = 64;

/// Writes the indices of the boxes that overlap the frustum, as overlaps() says, in ascending order, and
/// returns how many. `visible` has room for boxes.size() + kCullPadding; what stands behind the returned
/// count is undefined. Errors: bad_argument for boxes that are not sound or more than 2³² - 2;
/// buffer_too_small; nothing is written then. Of boxes that are not valid the answer means nothing. Cost:
/// linear; an array a coordinate without an origin (BoxView::arrays) costs least, for others are laid out so
/// on the way, 64 at a time, and three quarters of it where all six begin with a cache line, as those of
/// Boxes do. Threads: any. Allocates: nothing.
Result<std::size_t> cull_boxes(const Frustum& frustum, const BoxView& boxes,
                               std::span<ObjectId> visible) noexcept;

/// The same for spheres about the frustum's origin. Errors, Cost, Threads, Allocates: the same.
Result<std::size_t> cull_spheres(const Frustum& frustum, const SphereView& spheres,
                                 std::span<ObjectId> visible) noexcept;

}  // namespace sightline
