#include <sightline/frustum.hpp>

#include <limits>

#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"

namespace sightline {

using namespace geometry;

namespace {

// How far from the origin points may lie: |q_i| <= at_eye_i + per_w_i · w(q), where w is at least 0.
struct Reach {
  glm::dvec3 at_eye, per_w{0};
  glm::dvec4 w{0};
};

// Clip space maps back linearly: q = eye + A⁻¹·(x, y, w), of which |x| and |y| are at most w within the
// frustum. Where w is 1 everywhere, the third coordinate is z, at most w as well.
Reach reach_of(const glm::dmat4& rows) {
  const bool perspective = glm::length(glm::dvec3(rows[3])) > kPlaneAtInfinity * std::fabs(rows[3].w);
  const glm::dvec4& third = perspective ? rows[3] : rows[2];
  const glm::dmat3 inverse =
      glm::inverse(glm::transpose(glm::dmat3(glm::dvec3(rows[0]), glm::dvec3(rows[1]), glm::dvec3(third))));
  const glm::dvec3 eye = -(inverse * glm::dvec3(rows[0].w, rows[1].w, third.w));
  return {glm::abs(eye), glm::abs(inverse[0]) + glm::abs(inverse[1]) + glm::abs(inverse[2]), rows[3]};
}

bool is_at_infinity(const glm::dvec4& plane) {
  const double length = glm::length(glm::dvec3(plane));
  return !(length > kPlaneAtInfinity * std::fabs(plane.w)) || length == 0;
}

// Whether z >= 0, of 0 <= z <= w, is the near plane's half space: not with reversed depth.
bool low_is_front(const glm::dmat4& rows, const Vec3& forward) {
  return !is_at_infinity(rows[2]) && glm::dot(glm::dvec3(rows[2]), to_double(forward)) > 0;
}

// A plane a·x + b·y + c·z + d >= 0 in double precision, normalised, rounded, and moved outwards by
// `rounding`, what rounding the coefficients and evaluating signed_distance() within reach can lose: turned a
// little, where reach grows with w.
Plane round_outwards(const glm::dvec4& plane, const Reach& reach, double rounding) {
  constexpr Plane at_infinity{{0, 0, 0}, std::numeric_limits<float>::max()};  // never rejects
  if (is_at_infinity(plane)) return at_infinity;
  const glm::dvec4 unit = plane / glm::length(glm::dvec3(plane));
  const glm::dvec3 size = glm::abs(glm::dvec3(unit));
  const double least = glm::dot(size, reach.at_eye) + std::fabs(unit.w);
  if (SIGHTLINE_MUTANT(planes_not_moved_outwards))
    return {to_vec3(glm::dvec3(unit)), static_cast<float>(unit.w)};
  glm::dvec4 moved = unit + rounding * (glm::dot(size, reach.per_w) * reach.w + glm::dvec4(0, 0, 0, least));
  moved /= glm::length(glm::dvec3(moved));  // spheres compare it with their radius
  if (!std::isfinite(moved.x + moved.y + moved.z + moved.w)) return at_infinity;
  return {to_vec3(glm::dvec3(moved)), static_cast<float>(moved.w)};
}

Frustum frustum_within(const glm::dmat4& rows, const Vec3& forward, const Reach& reach,
                       double rounding = kPlaneRounding) {
  Frustum frustum;
  frustum.planes[Frustum::left] = round_outwards(rows[3] + rows[0], reach, rounding);
  frustum.planes[Frustum::right] = round_outwards(rows[3] - rows[0], reach, rounding);
  frustum.planes[Frustum::bottom] = round_outwards(rows[3] + rows[1], reach, rounding);
  frustum.planes[Frustum::top] = round_outwards(rows[3] - rows[1], reach, rounding);
  // 0 <= z <= w: with reversed depth the first of these is the far plane, and the half spaces are the same.
  const bool low = low_is_front(rows, forward);
  frustum.planes[low ? Frustum::front : Frustum::back] = round_outwards(rows[2], reach, rounding);
  frustum.planes[low ? Frustum::back : Frustum::front] = round_outwards(rows[3] - rows[2], reach, rounding);
  return frustum;
}

glm::dmat4 clip_rows(const View& view) {
  glm::dmat4 rows = glm::transpose(to_double(view.eye_to_clip) * to_double(view.world_to_eye));
  if (SIGHTLINE_MUTANT(planes_half_a_pixel_in)) rows[0] *= 1 + 1.0 / view.width;
  return rows;
}

}  // namespace

Frustum geometry::frustum_of(const glm::dmat4& clip, const Vec3& forward, const Box& extent) noexcept {
  return frustum_within(glm::transpose(clip), forward, {to_double(largest(extent))});
}

glm::dvec4 geometry::near_plane(const View& view) noexcept {
  const glm::dmat4 rows = clip_rows(view);
  const glm::dvec4 plane = low_is_front(rows, view_direction(view)) ? rows[2] : rows[3] - rows[2];
  return is_at_infinity(plane) ? glm::dvec4(0) : plane / glm::length(glm::dvec3(plane));
}

Plane geometry::far_plane_within(const View& view) noexcept {
  const glm::dmat4 rows = clip_rows(view);
  return frustum_within(rows, view_direction(view), reach_of(rows), -kPlaneRounding).planes[Frustum::back];
}

Frustum make_frustum(const View& view) noexcept {
  const glm::dmat4 rows = clip_rows(view);
  return frustum_within(rows, view_direction(view), reach_of(rows));
}

Frustum make_frustum(const WorldView& view) noexcept {
  Frustum frustum = make_frustum(view.view);
  frustum.origin = view.origin;
  return frustum;
}

Overlap classify(const Frustum& frustum, const Box& box) noexcept {
  bool inside = true;
  for (const Plane& plane : frustum.planes) {
    const bool x = plane.normal.x >= 0, y = plane.normal.y >= 0, z = plane.normal.z >= 0;
    const float nearest = signed_distance(plane, x ? box.max.x : box.min.x, y ? box.max.y : box.min.y,
                                          z ? box.max.z : box.min.z);
    if (nearest < 0) return Overlap::outside;
    const float farthest = signed_distance(plane, x ? box.min.x : box.max.x, y ? box.min.y : box.max.y,
                                           z ? box.min.z : box.max.z);
    inside = inside && farthest >= 0;
  }
  return inside ? Overlap::inside : Overlap::crossing;
}

bool overlaps(const Frustum& frustum, const Box& box) noexcept {
  return classify(frustum, box) != Overlap::outside;
}

bool overlaps(const Frustum& frustum, const Sphere& sphere) noexcept {
  const Vec3& c = sphere.centre;
  const float deepest = -sphere.radius * kRadiusGrowth;
  for (const Plane& plane : frustum.planes) {
    if (signed_distance(plane, c.x, c.y, c.z) < deepest) return false;
  }
  return true;
}

}  // namespace sightline
