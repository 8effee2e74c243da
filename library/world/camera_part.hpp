// A part of what a camera sees: its corners, and planes around points.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <span>

#include <sightline/shadows.hpp>

namespace sightline::world {

/// In metres of eye space's depth.
struct Depths {
  double near_plane = 0, far_plane = 0;
};

/// What the camera's own planes leave of a range; far is infinite where neither limits it. Of a slanted plane
/// nothing is said.
Depths depths_of(const View& view, const DepthRange& range) noexcept;
/// Whether the range is one, and ends.
Status check_depths(const DepthRange& range, const Depths& depths) noexcept;

/// What lies at a depth where the image has x and y, -1 … 1, y up: in eye space.
glm::dvec3 point_at(const View& view, double x, double y, double depth) noexcept;
/// The same of the image's corners: x before y, -1 before 1.
std::array<glm::dvec3, 4> corners_at(const View& view, double depth) noexcept;

/// A half space: dot(normal, p) + distance >= 0, the normal of unit length.
struct WidePlane {
  glm::dvec3 normal;
  double distance = 0;
};

/// Planes of the convex hull of at most 17 points, moved outwards by up to a part in 10⁷ of its size where
/// faces are nearly one. Writes as many as there is room for: all hold all points. Returns how many.
std::size_t hull_planes(std::span<const glm::dvec3> points, std::span<WidePlane> planes) noexcept;

}  // namespace sightline::world
