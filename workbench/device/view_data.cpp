#include "workbench/device/view_data.hpp"

#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"

namespace sightline::device {

bool has_reversed_depth(const View& view) noexcept {
  // Along the eye's -z, depth z/w grows (standard) or falls (reversed). With z = a·e + b and w = c·e + d for
  // the eye coordinate e, the sign of d(z/w)/de is that of a·d - b·c.
  const auto& m = view.eye_to_clip.m;
  const double slope = double{m[10]} * m[15] - double{m[14]} * m[11];
  return slope > 0;
}

std::optional<View> with_denser_depth(const View& view) noexcept {
  const auto& m = view.eye_to_clip.m;
  const bool by_distance = m[2] == 0 && m[6] == 0 && m[3] == 0 && m[7] == 0 && m[10] != 0;
  if (has_reversed_depth(view) || !by_distance || m[11] == 0) return {};
  // w where z is 0: at the near plane.
  const double near = double{m[15]} - double{m[11]} * m[14] / m[10];
  if (!(near > 0)) return {};
  View out = view;
  out.eye_to_clip.m[10] = 0, out.eye_to_clip.m[14] = static_cast<float>(near);
  return out;
}

namespace {

// How far one plane may lie before another within `extent`: of a linear function the farthest corner's.
float most_between(const Plane& before, const glm::dvec4& behind, const Box& extent) {
  const auto most = [](float a, double b, float low, float high) {
    const double slope = double{a} - b;
    return slope * double{slope >= 0 ? high : low};
  };
  return static_cast<float>(most(before.normal.x, behind.x, extent.min.x, extent.max.x) +
                            most(before.normal.y, behind.y, extent.min.y, extent.max.y) +
                            most(before.normal.z, behind.z, extent.min.z, extent.max.z) +
                            (double{before.distance} - behind.w));
}

// Where near and far lie far apart, depth rounds to its end long before the far plane, or long after it: 2 km
// at 18 km with a near plane at 1 cm.
Vec4 far_end(const View& view) {
  const Plane plane = geometry::far_plane_within(view);
  const Vec3& n = plane.normal;
  const bool endless = n.x == 0 && n.y == 0 && n.z == 0;
  return endless ? Vec4{0, 0, 0, 1} : Vec4{n.x, n.y, n.z, plane.distance};
}

// Of the matrix as it was rounded, which is what vertices are placed by. Its inverse maps what is in clip
// space at x, y, z, 1 to a point under perspective, too, so that all of those are on one ray.
void set_rays(shared::ViewData& out) {
  const glm::dmat4 inverse = glm::inverse(geometry::to_double(out.world_to_clip));
  const glm::dvec4 depth = inverse[2], across[]{inverse[3], inverse[0], inverse[1]};
  const bool orthographic = out.eye.w > 0;
  for (std::size_t i = 0; i < 3; ++i) {
    glm::dvec3 origin(0), direction(0);
    if (orthographic) {
      const double scale = 1 / inverse[3].w;
      origin = scale * glm::dvec3(across[i]);
      if (i == 0 && out.reversed) origin += scale * glm::dvec3(depth);
      if (i == 0) direction = (out.reversed ? -scale : scale) * glm::dvec3(depth);
    } else {
      const glm::dvec3 eye = glm::dvec3(depth) / depth.w;
      if (i == 0) origin = eye;
      direction = glm::dvec3(across[i]) - across[i].w * eye;
    }
    out.ray_origin[i] = geometry::to_vec3(origin);
    out.ray_direction[i] = geometry::to_vec3(direction);
  }
}

}  // namespace

shared::ViewData view_data(const View& view, const Box& extent) noexcept {
  shared::ViewData out{};
  out.world_to_clip = world_to_clip(view);
  const Frustum frustum = make_frustum(view);
  for (std::size_t i = 0; i < Frustum::sides; ++i) {
    const Plane& plane = frustum.planes[i];
    out.planes[i] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.distance};
  }
  out.far_end = far_end(view);
  if (const glm::dvec4 near = geometry::near_plane(view); near != glm::dvec4(0))
    out.near_push = 1.01f * most_between(frustum.planes[Frustum::front], near, extent);
  const Projector projector = make_projector(view, extent);
  const Vec3 forward = view_direction(view);
  out.eye = {projector.eye.x, projector.eye.y, projector.eye.z, projector.orthographic ? 1.0f : 0.0f};
  out.forward = {forward.x, forward.y, forward.z, 0};
  out.width = projector.width;
  out.height = projector.height;
  out.pixels_per_metre = projector.pixels_per_metre;
  out.metres_per_w = projector.metres_per_w;
  out.coordinate_error = projector.coordinate_error;
  out.reversed = has_reversed_depth(view);
  set_rays(out);
  return out;
}

}  // namespace sightline::device
