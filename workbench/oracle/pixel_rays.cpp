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

// Well mixed bits of a number (Steele, Lea & Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

// How far in front of the eye a clip depth lies at the image's centre; the homogeneous weight decides where
// it tells the two apart, since at infinity only the weight is finite.
bool lies_before(const glm::dvec4& a, const glm::dvec4& b) {
  const double scale = std::fmax(std::fabs(a.w), std::fabs(b.w));
  if (std::fabs(a.w - b.w) > 1e-9 * scale) return a.w > b.w;
  return a.z / a.w > b.z / b.w;
}

}  // namespace

PixelRays::PixelRays(const View& view, std::uint32_t sample)
    : width_(view.width), height_(view.height), sample_(sample) {
  const glm::dmat4 world_to_eye = to_double(view.world_to_eye);
  clip_to_eye_ = glm::inverse(to_double(view.eye_to_clip));
  clip_to_world_ = glm::inverse(world_to_eye) * clip_to_eye_;
  eye_to_world_ = glm::inverse(glm::dmat3(world_to_eye));
  if (!lies_before(clip_to_eye_ * glm::dvec4(0, 0, 0, 1), clip_to_eye_ * glm::dvec4(0, 0, 1, 1))) {
    std::swap(near_depth_, far_depth_);
  }
}

// In normalised device coordinates.
glm::dvec2 PixelRays::place(std::uint32_t x, std::uint32_t y) const noexcept {
  glm::dvec2 in_pixel(0.5);
  if (sample_ > 0) {
    const std::uint64_t bits = mixed(std::uint64_t{sample_} << 32 | std::uint64_t{y} << 16 | x);
    in_pixel = {(static_cast<double>(bits >> 32) + 0.5) * 0x1p-32,
                (static_cast<double>(bits & 0xffffffffu) + 0.5) * 0x1p-32};
  }
  return {2 * (x + in_pixel.x) / width_ - 1, 1 - 2 * (y + in_pixel.y) / height_};
}

glm::dvec4 PixelRays::eye_point(const glm::dvec2& at, double depth) const noexcept {
  return clip_to_eye_ * glm::dvec4(at, depth, 1);
}

double PixelRays::distance(std::uint32_t x, std::uint32_t y, double depth) const noexcept {
  const glm::dvec2 at = place(x, y);
  const glm::dvec4 near_eye = eye_point(at, near_depth_), there = eye_point(at, depth);
  return glm::length(glm::dvec3(there) / there.w - glm::dvec3(near_eye) / near_eye.w);
}

PixelRay PixelRays::through(std::uint32_t x, std::uint32_t y) const noexcept {
  const glm::dvec2 at = place(x, y);
  const glm::dvec4 near_eye = eye_point(at, near_depth_), far_eye = eye_point(at, far_depth_);
  const glm::dvec4 near_world = clip_to_world_ * glm::dvec4(at, near_depth_, 1);
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
