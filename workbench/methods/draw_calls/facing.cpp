#include "workbench/methods/draw_calls/facing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::methods {

namespace {

using geometry::to_double;

// Pixels. Corners are put on a grid of 1/256, so each is moved by √2/512 at most; times 2.8, since the image
// of an edge away from its middle is longer than at it.
constexpr double kSnap = 1.0 / 128;
// What single precision and clipping may turn besides.
constexpr double kRounding = 1e-4;

glm::dvec3 precise_normal(const std::array<Vec3, 3>& triangle) noexcept {
  const glm::dvec3 a = to_double(triangle[0]);
  const glm::dvec3 across = glm::cross(to_double(triangle[1]) - a, to_double(triangle[2]) - a);
  const double length = glm::length(across);
  return length > 0 ? across / length : glm::dvec3(0);
}

// Perimeter over twice the area, rounded up; of triangles with an area.
float thinness(const std::array<Vec3, 3>& triangle) noexcept {
  const glm::dvec3 a = to_double(triangle[0]), b = to_double(triangle[1]), c = to_double(triangle[2]);
  const double perimeter = glm::length(b - a) + glm::length(c - b) + glm::length(a - c);
  return static_cast<float>(1.000001 * perimeter / glm::length(glm::cross(b - a, c - a)));
}

std::uint32_t sector_of(double x, double z) noexcept {
  const double turns = std::atan2(z, x) / (2 * std::numbers::pi) + 0.5;  // 0 … 1
  return static_cast<std::uint32_t>(turns * kSectors) % kSectors;
}

}  // namespace

std::uint32_t part_of(const Vec3& normal, PartPlanes planes) noexcept {
  const auto on_plane = [](double x, double along_plane, double across, std::uint32_t first) {
    const double along = std::hypot(x, along_plane);
    return along > 0 && along >= std::fabs(across) ? first + sector_of(x, along_plane) : kSteep;
  };
  const std::uint32_t part = planes == PartPlanes::xy ? kSteep : on_plane(normal.x, normal.z, normal.y, 0);
  return planes == PartPlanes::xz || part != kSteep ? part : on_plane(normal.x, normal.y, normal.z, kOnXy);
}

Vec3 unit_normal(const std::array<Vec3, 3>& triangle) noexcept {
  return geometry::to_vec3(precise_normal(triangle));
}

FacingCone cone_of(const partition::TriangleSpan& all, std::span<const std::uint32_t> triangles,
                   const Box& region, PartPlanes planes) noexcept {
  FacingCone cone;
  cone.bounds = partition::shown_within(region, all[triangles.front()]);
  glm::dvec3 sum(0);
  bool all_have_area = true;
  for (const std::uint32_t triangle : triangles) {
    const auto corners = all[triangle];
    cone.bounds = partition::united(cone.bounds, partition::shown_within(region, corners));
    const glm::dvec3 normal = precise_normal(corners);
    sum += normal;
    all_have_area = all_have_area && normal != glm::dvec3(0);
  }
  cone.part = part_of(unit_normal(all[triangles.front()]), planes);
  const double length = glm::length(sum);
  if (!all_have_area || !(length > 1e-6)) return cone;
  cone.axis = geometry::to_vec3(sum / length);
  const glm::dvec3 axis = glm::normalize(to_double(cone.axis));
  double least = 1;
  for (const std::uint32_t triangle : triangles) {
    least = std::min(least, glm::dot(axis, precise_normal(all[triangle])));
    cone.thin = std::max(cone.thin, thinness(all[triangle]));
  }
  const double half_angle = std::acos(std::clamp(least, -1.0, 1.0)) + kRounding;
  if (half_angle < std::numbers::pi / 2) cone.reach = static_cast<float>(std::sin(half_angle)) + 1e-6f;
  return cone;
}

Facing::Facing(const View& view, FacingRule rule) noexcept
    : rule_(rule),
      orthographic_(is_orthographic(view)),
      snap_(kSnap / double{make_projector(view, {}).pixels_per_metre}),
      eye_(eye_position(view)),
      forward_(view_direction(view)),
      on_xz_(forward_.x != 0 || forward_.z != 0 ? sector_of(forward_.x, forward_.z) : kSteep),
      on_xy_(forward_.x != 0 || forward_.y != 0 ? sector_of(forward_.x, forward_.y) : kSteep) {}

bool Facing::may_face(const FacingCone& cone) const noexcept {
  if (rule_ == FacingRule::none) return true;
  if (rule_ == FacingRule::printed) {
    const bool on_xy = cone.part >= kOnXy;
    const std::uint32_t looks = on_xy ? on_xy_ : on_xz_;
    if (cone.part == kSteep || looks == kSteep) return true;
    const std::uint32_t sector = on_xy ? cone.part - kOnXy : cone.part;
    const std::uint32_t apart = (sector + kSectors - looks) % kSectors;
    return apart != 0 && apart != 1 && apart != kSectors - 1;
  }
  if (cone.reach > 1) return true;
  const glm::dvec3 axis = to_double(cone.axis);
  const double reach = cone.reach;
  if (orthographic_) return glm::dot(axis, to_double(forward_)) < reach + turned_by(cone, 0);
  const glm::dvec3 eye = to_double(eye_), low = to_double(cone.bounds.min) - eye,
                   high = to_double(cone.bounds.max) - eye;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const glm::dvec3 way{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                         corner & 4 ? high.z : low.z};
    const double away = glm::length(way);
    if (!(glm::dot(axis, way) > 0) || glm::dot(axis, way) < (reach + turned_by(cone, away)) * away)
      return true;
  }
  return false;
}

}  // namespace sightline::methods
