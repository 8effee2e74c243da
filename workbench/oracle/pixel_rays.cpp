#include "workbench/oracle/pixel_rays.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace sightline::oracle {
namespace {

glm::dmat4 to_double(const Mat4& m) {
  return glm::dmat4(glm::make_mat4(m.m.data()));
}

// How far in front of the eye a clip depth lies at the image's centre; the homogeneous weight decides where
// it tells the two apart, since at infinity only the weight is finite.
bool lies_before(const glm::dvec4& a, const glm::dvec4& b) {
  const double scale = std::fmax(std::fabs(a.w), std::fabs(b.w));
  if (std::fabs(a.w - b.w) > 1e-9 * scale) return a.w > b.w;
  return a.z / a.w > b.z / b.w;
}

}  // namespace

PixelRays::PixelRays(const View& view) : width_(view.width), height_(view.height) {
  const glm::dmat4 world_to_eye = to_double(view.world_to_eye);
  clip_to_eye_ = glm::inverse(to_double(view.eye_to_clip));
  clip_to_world_ = glm::inverse(world_to_eye) * clip_to_eye_;
  eye_to_world_ = glm::inverse(glm::dmat3(world_to_eye));
  if (!lies_before(clip_to_eye_ * glm::dvec4(0, 0, 0, 1), clip_to_eye_ * glm::dvec4(0, 0, 1, 1))) {
    std::swap(near_depth_, far_depth_);
  }
}

glm::dvec4 PixelRays::eye_point(std::uint32_t x, std::uint32_t y, double depth) const noexcept {
  const double ndc_x = (2.0 * x + 1.0) / width_ - 1.0, ndc_y = 1.0 - (2.0 * y + 1.0) / height_;
  return clip_to_eye_ * glm::dvec4(ndc_x, ndc_y, depth, 1);
}

double PixelRays::distance(std::uint32_t x, std::uint32_t y, double depth) const noexcept {
  const glm::dvec4 near_eye = eye_point(x, y, near_depth_), at = eye_point(x, y, depth);
  return glm::length(glm::dvec3(at) / at.w - glm::dvec3(near_eye) / near_eye.w);
}

PixelRay PixelRays::through(std::uint32_t x, std::uint32_t y) const noexcept {
  const double ndc_x = (2.0 * x + 1.0) / width_ - 1.0, ndc_y = 1.0 - (2.0 * y + 1.0) / height_;
  const glm::dvec4 near_eye = eye_point(x, y, near_depth_), far_eye = eye_point(x, y, far_depth_);
  const glm::dvec4 near_world = clip_to_world_ * glm::dvec4(ndc_x, ndc_y, near_depth_, 1);
  PixelRay ray;
  ray.origin = glm::dvec3(near_world) / near_world.w;
  // A weight that is nothing but the rounding of the matrix means a far plane at infinity.
  if (far_eye.w <= 1e-12 * near_eye.w) {
    ray.direction = glm::normalize(eye_to_world_ * glm::dvec3(far_eye));
    ray.length = std::numeric_limits<double>::infinity();
  } else {
    const glm::dvec3 along = glm::dvec3(far_eye) / far_eye.w - glm::dvec3(near_eye) / near_eye.w;
    ray.length = glm::length(along);
    ray.direction = eye_to_world_ * (along / ray.length);
  }
  return ray;
}

}  // namespace sightline::oracle
