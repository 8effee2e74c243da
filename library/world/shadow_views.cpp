// The views of shadow maps: faces of a light's own, and cascades of a sun that move by whole texels.
#include <sightline/shadows.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "library/geometry/elementary.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/geometry/rounding.hpp"
#include "library/world/camera_part.hpp"

namespace sightline {

using namespace geometry;

namespace {

Status bad(const char* message) {
  return {StatusCode::bad_argument, message};
}

Status check_direction(const Vec3& direction) {
  const double length = glm::length(to_double(direction));
  if (!(length > 0) || !std::isfinite(length))
    return bad("light: the direction is zero or not finite, expected any other length");
  return {};
}

Status check_light(const Light& light) {
  if (light.kind > LightKind::point)
    return bad("light: the kind is none, expected directional, spot or point");
  if (light.kind != LightKind::point)
    if (const Status sound = check_direction(light.direction); !sound) return sound;
  if (light.kind == LightKind::directional) {
    if (!(light.reach >= 0) || !std::isfinite(light.reach))
      return bad("light: the reach is negative or not finite");
    return {};
  }
  if (light.kind == LightKind::spot && !(light.cone > 0 && light.cone < std::numbers::pi_v<float>))
    return bad("light: the cone is out of range, expected between 0 and pi radians");
  if (!(light.near_plane > 0) || !(light.near_plane < light.range) || !std::isfinite(light.range))
    return bad("light: the planes are out of range, expected 0 < near_plane < range");
  return {};
}

Status check_pixels(std::uint32_t pixels) {
  if (pixels >= 16 && pixels <= 16384) return {};
  return {StatusCode::bad_view, "shadows: the size of a map is out of range, expected 16 to 16384 pixels"};
}

// Any direction that is not along another.
Vec3 up_of(const Vec3& direction) {
  const glm::dvec3 d = glm::normalize(to_double(direction));
  return std::fabs(d.y) < 0.99 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

Result<WorldView> lamp_view(const Light& light, std::uint32_t pixels, std::uint32_t face) {
  Camera camera;
  camera.vertical_fov = light.cone, camera.near_plane = light.near_plane, camera.far_plane = light.range;
  camera.forward = light.direction;
  if (light.kind == LightKind::point) {
    const float sign = face & 1 ? -1.0f : 1.0f;
    camera.forward = {face / 2 == 0 ? sign : 0, face / 2 == 1 ? sign : 0, face / 2 == 2 ? sign : 0};
    camera.vertical_fov = 0.5f * std::numbers::pi_v<float>;
  }
  camera.up = up_of(camera.forward);
  const Result<View> view = make_view(camera, pixels, pixels);
  if (!view) return view.error();
  const WorldView out{*view, light.position};
  if (const Status sound = check(out); !sound) return sound;
  return out;
}

// A ball around a part of what a camera sees, in eye space: the same however the camera stands.
struct Ball {
  glm::dvec3 centre;
  double radius = 0;
};

Ball ball_around(const View& view, const world::Depths& depths) {
  const auto near = world::corners_at(view, depths.near_plane),
             far = world::corners_at(view, depths.far_plane);
  const auto middle = [](const auto& c) { return 0.25 * (c[0] + c[1] + c[2] + c[3]); };
  const auto radius_at = [&](double t) {
    const glm::dvec3 centre = glm::mix(middle(near), middle(far), t);
    double most = 0;
    for (const auto* corners : {&near, &far})
      for (const glm::dvec3& corner : *corners) most = std::max(most, glm::length(corner - centre));
    return most;
  };
  // The greatest of distances is convex in t.
  double low = 0, high = 1;
  for (int step = 0; step < 40; ++step) {
    const double third = (high - low) / 3;
    if (radius_at(low + third) < radius_at(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  const double t = 0.5 * (low + high);
  return {glm::mix(middle(near), middle(far), t), radius_at(t)};
}

// So few digits that any number of texels is one of single precision.
double few_digits_up(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::ceil(mantissa * 1024) / 1024, exponent);
}

WorldView sun_view(const Light& sun, const WorldView& camera, const world::Depths& depths,
                   std::uint32_t pixels) {
  const Ball ball = ball_around(camera.view, depths);
  const glm::dmat4 to_world = glm::inverse(to_double(camera.view.world_to_eye));
  const glm::dvec3 middle(to_world * glm::dvec4(ball.centre, 1));
  // Room for half a texel that the middle moves by, and for what filters look at beyond.
  const double texel = few_digits_up(2 * ball.radius / (pixels - 8));
  const glm::dvec3 forward = glm::normalize(to_double(sun.direction));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, to_double(up_of(sun.direction))));
  const glm::dvec3 up = glm::cross(right, forward);
  const glm::dvec3 origin(camera.origin.x, camera.origin.y, camera.origin.z);
  // Texels are counted from the world's origin, wherever the camera's is.
  const auto snapped = [&](const glm::dvec3& axis) {
    const double at = glm::dot(axis, middle + origin);
    if (SIGHTLINE_MUTANT(cascades_not_snapped)) return at - glm::dot(axis, origin);
    return std::floor(at / texel + 0.5) * texel - glm::dot(axis, origin);
  };
  const double x = snapped(right), y = snapped(up), depth = 2 * ball.radius + sun.reach;
  // The eye stands before everything that can throw a shadow on the ball.
  const double eye = glm::dot(forward, middle) - ball.radius - sun.reach;
  const double scale = 2 / (texel * pixels);
  WorldView out;
  out.view.world_to_eye = to_mat4({{right.x, up.x, -forward.x, 0},
                                   {right.y, up.y, -forward.y, 0},
                                   {right.z, up.z, -forward.z, 0},
                                   {-x, -y, eye, 1}});
  // A little before the eye and behind the ball, for what rounding does.
  const double slack = 1e-5 * (depth + std::fabs(eye)) + 1e-3;
  const double over = 1 / (depth + 2 * slack);
  out.view.eye_to_clip =
      to_mat4({{scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, -over, 0}, {0, 0, slack * over, 1}});
  out.view.width = out.view.height = pixels;
  out.origin = camera.origin;
  return out;
}

// Where cascade `i` of `count` begins (Zhang et al. 2006).
double split_at(const world::Depths& depths, double logarithmic, std::size_t i, std::size_t count) {
  if (i == 0) return geometry::float_down(depths.near_plane);
  if (i == count) return geometry::float_up(depths.far_plane);
  const double t = static_cast<double>(i) / static_cast<double>(count);
  const double length = depths.far_plane - depths.near_plane;
  const double even = depths.near_plane + length * t;
  // A factor needs something to begin with: all is counted from a little before the near plane.
  const double first = std::max(depths.near_plane, 1e-3 * length), from = depths.near_plane - first;
  const double growing = from + first * portable::exp(t * portable::log((depths.far_plane - from) / first));
  return growing * logarithmic + even * (1 - logarithmic);
}

}  // namespace

Result<WorldView> shadow_view(const Light& light, const WorldView& camera, const DepthRange& depths,
                              std::uint32_t pixels, std::uint32_t face) noexcept {
  if (const Status sound = check_light(light); !sound) return sound;
  if (const Status sound = check_pixels(pixels); !sound) return sound;
  if (face >= (light.kind == LightKind::point ? kPointFaces : 1))
    return bad("light: there is no such face, expected 0 to 5 of a point light, 0 of others");
  if (light.kind != LightKind::directional) return lamp_view(light, pixels, face);
  Cascade one;
  if (const Status done = split_cascades(light, camera, {depths, 0, pixels}, {&one, 1}); !done) return done;
  return one.view;
}

Status split_cascades(const Light& light, const WorldView& camera, const CascadeOptions& options,
                      std::span<Cascade> cascades) noexcept {
  if (const Status sound = check_light(light); !sound) return sound;
  if (light.kind != LightKind::directional) return bad("light: only a directional one has cascades");
  if (const Status sound = check(camera); !sound) return sound;
  if (const Status sound = check_pixels(options.pixels); !sound) return sound;
  if (!(options.logarithmic >= 0 && options.logarithmic <= 1))
    return bad("cascades: logarithmic is out of range, expected 0 to 1");
  if (cascades.empty() || cascades.size() > kMaxCascades) return bad("cascades: expected 1 to 16");
  const world::Depths all = world::depths_of(camera.view, options.depths);
  if (const Status sound = world::check_depths(options.depths, all); !sound) return sound;
  for (std::size_t i = 0; i < cascades.size(); ++i) {
    const auto at = [&](std::size_t k) {
      return static_cast<float>(split_at(all, options.logarithmic, k, cascades.size()));
    };
    Cascade& out = cascades[i];
    out.depths = {at(i), at(i + 1)};
    out.view = sun_view(light, camera, {out.depths.near_plane, out.depths.far_plane}, options.pixels);
    if (const Status sound = check(out.view); !sound) return sound;
  }
  return {};
}

}  // namespace sightline
