#include <sightline/view.hpp>

#include <numbers>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/elementary.hpp"
#include "library/geometry/linear.hpp"

namespace sightline {

using namespace geometry;

namespace {

constexpr std::uint32_t kMaxSide = 16384;

Status bad(const char* message) {
  return {StatusCode::bad_view, message};
}

Status check_size(std::uint32_t width, std::uint32_t height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    return bad("view: its size is out of range, expected 1 to 16384 pixels a side");
  return {};
}

Status check_camera(const Camera& c) {
  if (!is_finite(c.eye)) return bad("camera: the eye is not finite");
  if (!is_finite(c.forward) || !is_finite(c.up)) return bad("camera: a direction is not finite");
  const glm::dvec3 forward = to_double(c.forward), up = to_double(c.up);
  const double lengths = glm::length(forward) * glm::length(up);
  if (!(lengths > 0) || !(glm::length(glm::cross(forward, up)) > 1e-6 * lengths)) {
    return bad("camera: forward and up must not be zero or parallel");
  }
  if (!std::isfinite(c.shift_x) || !std::isfinite(c.shift_y)) return bad("camera: the shift is not finite");
  if (c.orthographic_height != 0) {
    if (!(c.orthographic_height > 0) || !std::isfinite(c.orthographic_height)) {
      return bad("camera: the orthographic height must be positive and finite");
    }
    if (!std::isfinite(c.near_plane) || !std::isfinite(c.far_plane) || !(c.near_plane < c.far_plane)) {
      return bad("camera: an orthographic view needs finite planes with near < far");
    }
    return {};
  }
  if (!(c.vertical_fov > 0) || !(c.vertical_fov < std::numbers::pi_v<float>)) {
    return bad("camera: the vertical field of view must lie between 0 and pi radians");
  }
  if (!(c.near_plane > 0) || !std::isfinite(c.near_plane) || !(c.near_plane < c.far_plane)) {
    return bad("camera: a perspective view needs 0 < near < far");
  }
  return {};
}

glm::dmat4 look_along(const Camera& c) {
  const glm::dvec3 back = -glm::normalize(to_double(c.forward));
  const glm::dvec3 right = glm::normalize(glm::cross(to_double(c.up), back));
  const glm::dvec3 up = glm::cross(back, right);
  const glm::dvec3 eye = to_double(c.eye);
  return {{right.x, up.x, back.x, 0},
          {right.y, up.y, back.y, 0},
          {right.z, up.z, back.z, 0},
          {-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1}};
}

// Depth as (z·a + b) / w where w = -z (perspective) or 1 (orthographic).
struct DepthTerms {
  double a, b;
};

DepthTerms perspective_depth(double n, double f, Depth depth) {
  if (std::isinf(f)) return depth == Depth::standard ? DepthTerms{-1, -n} : DepthTerms{0, n};
  if (depth == Depth::standard) return {-f / (f - n), -n * f / (f - n)};
  return {n / (f - n), n * f / (f - n)};
}

DepthTerms orthographic_depth(double n, double f, Depth depth) {
  if (depth == Depth::standard) return {-1 / (f - n), -n / (f - n)};
  return {1 / (f - n), f / (f - n)};
}

glm::dmat4 projection(const Camera& c, double aspect) {
  if (c.orthographic_height > 0) {
    const double y = 2 / static_cast<double>(c.orthographic_height);
    const DepthTerms z = orthographic_depth(c.near_plane, c.far_plane, c.depth);
    return {{y / aspect, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z.a, 0}, {c.shift_x, c.shift_y, z.b, 1}};
  }
  const double y = 1 / portable::tan(0.5 * static_cast<double>(c.vertical_fov));
  const DepthTerms z = perspective_depth(c.near_plane, c.far_plane, c.depth);
  return {{y / aspect, 0, 0, 0}, {0, y, 0, 0}, {-c.shift_x, -c.shift_y, z.a, -1}, {0, 0, z.b, 0}};
}

bool is_finite(const Mat4& m) {
  for (float x : m.m) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}

// Scaled by the rows so that a small but sound matrix is not taken for a singular one.
template <class Matrix>
bool is_singular(const Matrix& matrix) {
  // Whatever its columns and rows are measured in: a shift of a large image is no part of what a metre is.
  Matrix scaled = matrix;
  for (int way = 0; way < 2; ++way) {
    for (int c = 0; c < Matrix::length(); ++c) {
      const double length = glm::length(scaled[c]);
      if (length > 0) scaled[c] /= length;
    }
    scaled = glm::transpose(scaled);
  }
  return !(std::fabs(glm::determinant(scaled)) > 1e-12);
}

}  // namespace

Result<View> make_view(const Camera& camera, std::uint32_t width, std::uint32_t height) noexcept {
  if (const Status size = check_size(width, height); !size) return size;
  if (const Status sound = check_camera(camera); !sound) return sound;
  View view;
  view.world_to_eye = to_mat4(look_along(camera));
  view.eye_to_clip = to_mat4(projection(camera, static_cast<double>(width) / height));
  view.width = width;
  view.height = height;
  if (const Status sound = check(view); !sound) return sound;
  return view;
}

Status check(const View& view) noexcept {
  if (const Status size = check_size(view.width, view.height); !size) return size;
  if (!is_finite(view.world_to_eye) || !is_finite(view.eye_to_clip)) {
    return bad("view: a matrix has a NaN or infinite element, expected finite matrices");
  }
  const auto& v = view.world_to_eye.m;
  if (v[3] != 0 || v[7] != 0 || v[11] != 0 || v[15] != 1) {
    return bad("view: world_to_eye must be affine, with the last row 0 0 0 1");
  }
  // How far the eye is from the origin says nothing of whether the axes are sound.
  const glm::dmat4 to_eye = to_double(view.world_to_eye);
  const glm::dmat3 axes(to_eye);
  if (is_singular(axes) || !(glm::length(glm::inverse(axes) * glm::dvec3(to_eye[3])) <= kWorldReach))
    return bad("view: world_to_eye is singular, expected an invertible matrix and an eye within 1e11 m");
  if (is_singular(to_double(view.eye_to_clip)))
    return bad("view: eye_to_clip is singular, expected an invertible matrix");
  return {};
}

Status check(const WorldView& view) noexcept {
  if (!in_reach(view.origin)) return bad("view: its origin is out of range, expected within 1e11 m of 0");
  return check(view.view);
}

Mat4 world_to_clip(const View& view) noexcept {
  return to_mat4(to_double(view.eye_to_clip) * to_double(view.world_to_eye));
}

glm::dvec3 geometry::eye_of(const View& view) noexcept {
  return {glm::inverse(to_double(view.world_to_eye))[3]};
}

Vec3 eye_position(const View& view) noexcept {
  return to_vec3(eye_of(view));
}

Vec3 view_direction(const View& view) noexcept {
  const glm::dmat4 inverse = glm::inverse(to_double(view.world_to_eye));
  return to_vec3(glm::normalize(-glm::dvec3(inverse[2])));
}

bool is_orthographic(const View& view) noexcept {
  const auto& p = view.eye_to_clip.m;
  return p[3] == 0 && p[7] == 0 && p[11] == 0;
}

}  // namespace sightline
