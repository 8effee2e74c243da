// What a box or a sphere covers on the image: rectangles and areas in pixels, for contribution culling.
#pragma once

#include <array>

#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// A view prepared for projecting many things: rows of world_to_clip and the pixel scale.
struct Projector {
  std::array<Vec4, 4> rows;     ///< of world_to_clip
  Vec3 eye;                     ///< metres
  float width = 0, height = 0;  ///< pixels
  float pixels_per_metre = 0;   ///< of a thing at eye distance 1 (perspective) or anywhere (orthographic)
  float metres_per_w = 1;       ///< depth along the view direction is w times this (perspective)
  bool orthographic = false;    ///< whether parallel lines stay parallel
  float coordinate_error = 0;   ///< absolute rounding error bound of a clip coordinate within the extent
  Box extent;                   ///< what that bound holds for
};

/// `extent`, in metres, holds what will be projected; what reaches beyond it covers the whole plane.
/// Errors: none; the view is one that check() finds sound. Cost: constant. Threads: any. Allocates: nothing.
Projector make_projector(const View& view, const Box& extent) noexcept;

/// The smallest rectangle that surely holds the box's image, widened by the rounding error; the whole
/// plane (±infinity) where a corner lies on or behind the eye plane, or beyond the extent. Not clipped to the
/// image. Errors: none. Cost: constant. Threads: any. Allocates: nothing.
Rect projected_rect(const Projector& projector, const Box& box) noexcept;

/// Whether the rectangle, clipped to the image, holds a pixel centre. False is certain: nothing inside the
/// rectangle can leave a pixel.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
bool covers_sample(const Projector& projector, const Rect& rect) noexcept;

/// Area of a sphere's image in px² by Lee & Shin 2023, equation (1) with its misprint mended:
/// π·(r·(l/2) / (d·tan(f/2)))², d the distance from the eye; infinite where the eye is inside.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
float projected_area(const Projector& projector, const Sphere& sphere) noexcept;

/// The same with r/√(d² − r²) for r/d and the widening off axis: never less than the sphere covers.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
float projected_area_bound(const Projector& projector, const Sphere& sphere) noexcept;

}  // namespace sightline
