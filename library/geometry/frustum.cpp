#include <sightline/frustum.hpp>

#include <limits>

#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"

namespace sightline {

using namespace geometry;

namespace {

// A plane a·x + b·y + c·z + d >= 0 in double precision, normalised, rounded, and moved outwards by what
// rounding the coefficients and evaluating signed_distance() within the extent can lose.
Plane round_outwards(const glm::dvec4& plane, const Vec3& largest) {
  const double length = glm::length(glm::dvec3(plane));
  if (!(length > kPlaneAtInfinity * std::fabs(plane.w)) || length == 0) {
    return {{0, 0, 0}, std::numeric_limits<float>::max()};  // at infinity: never rejects
  }
  const glm::dvec4 unit = plane / length;
  const double magnitude = std::fabs(unit.x) * largest.x + std::fabs(unit.y) * largest.y +
                           std::fabs(unit.z) * largest.z + std::fabs(unit.w);
  return {to_vec3(glm::dvec3(unit)), static_cast<float>(unit.w + kPlaneRounding * magnitude)};
}

bool reaches_beyond(const Box& extent, const Box& box) {
  return box.min.x < extent.min.x || box.min.y < extent.min.y || box.min.z < extent.min.z ||
         box.max.x > extent.max.x || box.max.y > extent.max.y || box.max.z > extent.max.z;
}

}  // namespace

Frustum geometry::frustum_of(const glm::dmat4& clip, const Vec3& forward, const Box& extent) noexcept {
  const glm::dmat4 rows = glm::transpose(clip);
  const Vec3 reach = largest(extent);
  Frustum frustum;
  frustum.extent = extent;
  frustum.planes[Frustum::left] = round_outwards(rows[3] + rows[0], reach);
  frustum.planes[Frustum::right] = round_outwards(rows[3] - rows[0], reach);
  frustum.planes[Frustum::bottom] = round_outwards(rows[3] + rows[1], reach);
  frustum.planes[Frustum::top] = round_outwards(rows[3] - rows[1], reach);
  // 0 <= z <= w: with reversed depth the first of these is the far plane, and the half spaces are the same.
  const Plane z_low = round_outwards(rows[2], reach);
  const Plane z_high = round_outwards(rows[3] - rows[2], reach);
  const Vec3& n = z_low.normal;
  const bool has_low = n.x != 0 || n.y != 0 || n.z != 0;
  const bool low_is_front = has_low && n.x * forward.x + n.y * forward.y + n.z * forward.z > 0;
  frustum.planes[Frustum::front] = low_is_front ? z_low : z_high;
  frustum.planes[Frustum::back] = low_is_front ? z_high : z_low;
  return frustum;
}

Frustum make_frustum(const View& view, const Box& extent) noexcept {
  return frustum_of(to_double(view.eye_to_clip) * to_double(view.world_to_eye), view_direction(view), extent);
}

Frustum make_frustum(const WorldView& view, const Box& extent) noexcept {
  Frustum frustum = make_frustum(view.view, extent);
  frustum.origin = view.origin;
  return frustum;
}

Overlap classify(const Frustum& frustum, const Box& box) noexcept {
  if (reaches_beyond(frustum.extent, box)) return Overlap::crossing;
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
  if (reaches_beyond(frustum.extent, {c, c})) return true;
  for (const Plane& plane : frustum.planes) {
    if (signed_distance(plane, c.x, c.y, c.z) < -sphere.radius) return false;
  }
  return true;
}

}  // namespace sightline
