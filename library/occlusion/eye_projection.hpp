// A view prepared for drawing and querying: coordinates about its eye.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

#include <sightline/boxes.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

#include "library/geometry/linear.hpp"

namespace sightline::occlusion {

/// A view's projection about its eye, so that coordinates near the eye keep their digits: a point p is first
/// moved to q = (p - eye_high) - eye_low. Then (pixel x, pixel y, 1)·w = rows · (q, 1).
struct EyeProjection {
  Vec3 eye_high, eye_low;
  Vec4 x, y, w;
  Vec4 nearness;  ///< · (q, 1): orthographic only, minus the depth along the view; else 1/w is used
  bool orthographic = false;
};

/// What drawing needs besides: which way a pixel looks.
struct PixelRays {
  /// Per axis a: L_a(x, y) = at + x·across + y·down. Perspective: the direction through pixel (x, y) that has
  /// w = 1; orthographic: where its ray crosses depth 0, relative to the eye.
  std::array<float, 3> at{}, across{}, down{};
  std::array<float, 3> forward{};  ///< orthographic: the ray's direction
  /// Orthographic: a plane is drawn whose unit normal's product with it is larger.
  float edge_on = 0;
  float stretch = 1;  ///< how long a metre of the view is in the space that this is in
  Vec4 near_plane;    ///< · (q, 1) >= 0 in front of the near plane
  /// Corners that go counterclockwise round a face do so to the right on the image.
  bool turns_right = false;
};

/// Of the same view about another origin, in pixels `scale` times as wide as the view's.
EyeProjection eye_projection(const WorldView& view, const WorldPoint& origin,
                             std::uint32_t scale = 1) noexcept;
/// The same of what stands in a space of its own: `placement` is from there to metres about the view's
/// origin.
EyeProjection placed_projection(const View& view, const glm::dmat4& placement, std::uint32_t scale) noexcept;
PixelRays pixel_rays(const View& view, std::uint32_t scale = 1) noexcept;
/// How far rounding may move a corner within the image, in pixels as above.
float corner_rounding(const EyeProjection& projection, const View& view, std::uint32_t scale) noexcept;
/// Turns both, of one view, to the space of what `placement` moves from there to metres about the view's
/// origin. Returns how many times as far as kInset rounding may move what is seen there; 0, and nothing done,
/// where it flattens or skews beyond kMostSkew.
double place(const geometry::ExactAffine& placement, EyeProjection& projection, PixelRays& rays) noexcept;

}  // namespace sightline::occlusion
