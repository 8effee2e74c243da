#include "library/world/camera_part.hpp"

#include <algorithm>
#include <cmath>

#include "library/geometry/linear.hpp"

namespace sightline::world {

using namespace geometry;

Depths depths_of(const View& view, const DepthRange& range) noexcept {
  const auto& m = view.eye_to_clip.m;
  Depths out{range.near_plane, range.far_plane};
  if (!is_orthographic(view)) out.near_plane = std::max(out.near_plane, 0.0);
  if (m[2] != 0 || m[6] != 0) return out;
  // Along the view clip z is a·z + b and w is c·z + d: the planes stand where z = 0 and where z = w.
  const double a = m[10], b = m[14], c = m[11], d = m[15];
  const double one = b / a, other = (b - d) / (a - c);
  const bool one_stands = std::isfinite(one), other_stands = std::isfinite(other);
  if (one_stands && other_stands) {
    out.near_plane = std::max(out.near_plane, std::min(one, other));
    out.far_plane = std::min(out.far_plane, std::max(one, other));
  } else if (one_stands || other_stands) {
    out.near_plane = std::max(out.near_plane, one_stands ? one : other);
  }
  return out;
}

Status check_depths(const DepthRange& range, const Depths& depths) noexcept {
  if (!(range.near_plane < range.far_plane))
    return {StatusCode::bad_argument, "shadows: a range of depths is none, expected near_plane < far_plane"};
  if (!std::isfinite(depths.near_plane) || !std::isfinite(depths.far_plane))
    return {StatusCode::bad_argument,
            "shadows: the camera sees infinitely far, expected a range of depths that ends"};
  if (!(depths.near_plane < depths.far_plane))
    return {StatusCode::bad_argument, "shadows: the camera sees nothing in the range of depths"};
  return {};
}

glm::dvec3 point_at(const View& view, double x, double y, double depth) noexcept {
  const glm::dmat4 rows = glm::transpose(to_double(view.eye_to_clip));
  const glm::dvec4 across = rows[0] - x * rows[3], up = rows[1] - y * rows[3];
  const double over = 1 / (across.x * up.y - across.y * up.x);
  const double s = across.z * depth - across.w, t = up.z * depth - up.w;
  return {(s * up.y - t * across.y) * over, (across.x * t - up.x * s) * over, -depth};
}

std::array<glm::dvec3, 4> corners_at(const View& view, double depth) noexcept {
  return {point_at(view, -1, -1, depth), point_at(view, 1, -1, depth), point_at(view, -1, 1, depth),
          point_at(view, 1, 1, depth)};
}

namespace {

// The plane through three points, or a normal of 0 where they are nearly on a line.
WidePlane plane_through(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 one = b - a, other = c - a, normal = glm::cross(one, other);
  const double length = glm::length(normal);
  if (!(length > 1e-9 * glm::length(one) * glm::length(other))) return {{0, 0, 0}, 0};
  return {normal / length, 0};
}

}  // namespace

std::size_t hull_planes(std::span<const glm::dvec3> points, std::span<WidePlane> planes) noexcept {
  double size = 0;
  for (const glm::dvec3& p : points) size = std::max(size, glm::length(p - points[0]));
  const double play = 1e-7 * size;
  std::size_t count = 0;
  const auto add = [&](const glm::dvec3& normal, double least) {
    for (const WidePlane& other : planes.first(count))
      if (glm::dot(other.normal, normal) > 1 - 1e-12) return;
    if (count < planes.size()) planes[count++] = {normal, -least};
  };
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      for (std::size_t c = b + 1; c < points.size(); ++c) {
        const WidePlane plane = plane_through(points[a], points[b], points[c]);
        if (plane.normal == glm::dvec3(0)) continue;
        const double at = glm::dot(plane.normal, points[a]);
        double least = at, most = at;
        for (const glm::dvec3& p : points) {
          const double d = glm::dot(plane.normal, p);
          least = std::min(least, d), most = std::max(most, d);
          if (least < at - play && most > at + play) break;
        }
        if (least >= at - play) add(plane.normal, least);
        if (most <= at + play) add(-plane.normal, -most);
      }
    }
  }
  return count;
}

}  // namespace sightline::world
