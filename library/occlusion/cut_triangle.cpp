#include "library/occlusion/cut_triangle.hpp"

#include <algorithm>
#include <cmath>

#include "library/geometry/error_bounds.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

// A corner on the image, times its depth; and the depth.
using Homogeneous = glm::dvec3;

Homogeneous on_image(const EyeProjection& e, const glm::dvec3& q) {
  return {dot(e.x, q), dot(e.y, q), dot(e.w, q)};
}

// Whether each corner of what lies before the near plane is that far from the lines of the edges that it does
// not end, along x or y; an edge that is not before the plane at all is never reached.
bool wide_enough(const DepthTiles& tiles, const ExactCorners& corners, double inset) {
  std::array<Homogeneous, 3> at;
  std::array<double, 3> before;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = on_image(tiles.projection, corners[k]);
    before[k] = dot(tiles.rays.near_plane, corners[k]);
  }
  const auto far_from = [&](const Homogeneous& corner, std::size_t p, std::size_t q) {
    if (!(before[p] >= 0) && !(before[q] >= 0)) return true;
    const glm::dvec3 line = glm::cross(at[p], at[q]);
    return std::fabs(glm::dot(line, corner)) >= inset * corner.z * (std::fabs(line.x) + std::fabs(line.y));
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    if (before[k] >= 0 && !far_from(at[k], p, q)) return false;
    if ((before[p] >= 0) == (before[q] >= 0)) continue;
    const Homogeneous cut = at[p] + (at[q] - at[p]) * (before[p] / (before[p] - before[q]));
    if (!far_from(cut, k, p) || !far_from(cut, k, q)) return false;
  }
  return true;
}

// How much the nearness of the triangle's plane changes over a pixel; nothing where it is seen edge on.
std::optional<double> slant_of(const DepthTiles& tiles, const ExactCorners& corners) {
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = glm::length(normal);
  const double reach = reach_of(corners);
  const auto along = [&](const std::array<float, 3>& v) {
    return (normal.x * v[0] + normal.y * v[1] + normal.z * v[2]) / length;
  };
  const double scale = orthographic ? along(rays.forward) : glm::dot(normal, corners[0]) / length;
  if (!(length > 0) ||
      !(std::fabs(scale) > (orthographic ? double{rays.edge_on} : kEdgeOnPart * reach + kEdgeOnDistance)))
    return {};
  return (std::fabs(along(rays.across)) + std::fabs(along(rays.down))) / std::fabs(scale);
}

// Of the part of a segment from `begin` to `end`, from 0 to 1, that which is on the side of a plane where `a`
// and `b`, the values at its ends, are not negative.
void cut_by(double a, double b, double& begin, double& end) {
  if (a < 0 && b < 0) end = -1;
  if (a < 0 && b >= 0) begin = std::max(begin, a / (a - b));
  if (a >= 0 && b < 0) end = std::min(end, a / (a - b));
}

// Of the part of a segment before the near plane what is no farther beyond the image than that is wide or
// high.
std::optional<ImageSegment> part_in_image(const DepthTiles& tiles, const glm::dvec3& a, const glm::dvec3& b,
                                          double begin, double end) {
  const Homogeneous from = on_image(tiles.projection, a), to = on_image(tiles.projection, b);
  const double width = tiles.width, height = tiles.height;
  cut_by(from.x + width * from.z, to.x + width * to.z, begin, end);
  cut_by(2 * width * from.z - from.x, 2 * width * to.z - to.x, begin, end);
  cut_by(from.y + height * from.z, to.y + height * to.z, begin, end);
  cut_by(2 * height * from.z - from.y, 2 * height * to.z - to.y, begin, end);
  if (!(begin <= end)) return {};
  const auto place = [&](double share) {
    const Homogeneous at = from + (to - from) * share;
    return std::array{static_cast<float>(at.x / at.z), static_cast<float>(at.y / at.z)};
  };
  return ImageSegment{place(begin), place(end), 0};
}

}  // namespace

glm::dvec3 about_eye(const EyeProjection& e, const Vec3& at) noexcept {
  return {double{at.x} - e.eye_high.x - e.eye_low.x, double{at.y} - e.eye_high.y - e.eye_low.y,
          double{at.z} - e.eye_high.z - e.eye_low.z};
}

CutTriangle cut_triangle(const DepthTiles& tiles, const ExactCorners& corners) noexcept {
  const double inset =
      double{kInset} + tiles.around() + 2 * kInsetGrowth * std::max(tiles.width, tiles.height);
  const std::optional<double> slant = slant_of(tiles, corners);
  if (!slant) return {};
  // The corners' rounding turns the plane by far less.
  return {wide_enough(tiles, corners, inset), static_cast<float>(*slant * 1.001)};
}

std::optional<ImageSegment> in_view(const DepthTiles& tiles, const glm::dvec3& a,
                                    const glm::dvec3& b) noexcept {
  double begin = 0, end = 1;
  cut_by(dot(tiles.rays.near_plane, a), dot(tiles.rays.near_plane, b), begin, end);
  return part_in_image(tiles, a, b, begin, end);
}

std::optional<ImageSegment> near_edge(const DepthTiles& tiles, const ExactCorners& corners) noexcept {
  std::array<glm::dvec3, 2> ends;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
    const double at = dot(tiles.rays.near_plane, a), next = dot(tiles.rays.near_plane, b);
    if ((at >= 0) != (next >= 0) && count < 2) ends[count++] = a + (b - a) * (at / (at - next));
  }
  if (count < 2) return {};
  // On the plane but for rounding, which must not carry them behind the eye.
  const Vec4& plane = tiles.rays.near_plane;
  const glm::dvec3 inwards(plane.x, plane.y, plane.z);
  const double least = 1e-9 * (std::fabs(double{plane.w}) + 1e-6);
  for (glm::dvec3& q : ends) q += inwards * ((least - dot(plane, q)) / glm::dot(inwards, inwards));
  std::optional<ImageSegment> out = part_in_image(tiles, ends[0], ends[1], 0, 1);
  const double least_w = std::min(dot(tiles.projection.w, ends[0]), dot(tiles.projection.w, ends[1]));
  if (out) out->play = near_edge_play(tiles, reach_of(corners), least_w);
  return out;
}

}  // namespace sightline::occlusion
