// What the tests of bounds share: views and points drawn at random, scalar twins of the kernels' arithmetic,
// and the exact values beside them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/worst_case.hpp"
#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"
#include "library/occlusion/eye_projection.hpp"

namespace sightline::test {

using namespace geometry;

// The worst case found stays within the bound, and takes `share` of it: half the bound fails, and so does
// twice.
inline void expect_share(double found, double share) {
  EXPECT_LE(found, 1);
  EXPECT_GT(found, 0.75 * share);
  EXPECT_LT(found, 1.33 * share);
}

// Through volatiles: where g++ 12 vectorises it, it takes rounding to single precision and back for nothing
// done.
inline Vec3 rounded(const glm::dvec3& v) {
  const volatile float x = static_cast<float>(v.x), y = static_cast<float>(v.y), z = static_cast<float>(v.z);
  return {x, y, z};
}

inline Vec3 point(Draws& d, double least, double most) {
  return {d.any_float(least, most), d.any_float(least, most), d.any_float(least, most)};
}

inline glm::dvec3 direction(Draws& d) {
  const double z = d.between(-1, 1), angle = d.between(0, 6.3), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

inline double length(const glm::dvec3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// A perspective view and the projection about its eye.
struct Seen {
  View view;
  occlusion::EyeProjection rows;
  glm::dmat4 clip;

  // As far as the projection knows it, so that only what comes after shows.
  [[nodiscard]] glm::dvec4 exact_clip(const Vec3& p) const {
    const glm::dvec3 eye = to_double(rows.eye_high) + to_double(rows.eye_low);
    return clip * glm::dvec4(to_double(p) - eye, 0);
  }
};

inline Seen seen(Draws& d, double most_fov, double most_eye, std::uint32_t width, std::uint32_t height) {
  Camera camera;
  camera.eye = point(d, 0.01, most_eye);
  camera.forward = rounded(direction(d));
  camera.up = std::fabs(camera.forward.y) > 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  camera.vertical_fov = static_cast<float>(d.between(0.6, most_fov));
  Seen out{*make_view(camera, width, height), {}, {}};
  out.rows = occlusion::eye_projection({out.view, {}}, {});
  out.clip = to_double(out.view.eye_to_clip) * to_double(out.view.world_to_eye);
  return out;
}

// A point within the image, at `depth` before the eye.
inline Vec3 point_in(const Seen& s, double x, double y, double depth) {
  const glm::dmat4 back = glm::inverse(s.clip);
  const auto at = [&](double z) {
    const glm::dvec4 p = back * glm::dvec4(x, y, z, 1);
    return glm::dvec3(p) / p.w;
  };
  const glm::dvec3 near = at(0), along = glm::normalize(at(0.5) - near);
  return rounded(near + along * depth);
}

struct ExactPixel {
  double x, y, w;
};

inline ExactPixel exact_pixel(const Seen& s, const Vec3& p) {
  const glm::dvec4 c = s.exact_clip(p);
  return {(c.x / c.w + 1) * 0.5 * s.view.width, (1 - c.y / c.w) * 0.5 * s.view.height, c.w};
}

// The scalar twins of the kernels.
inline float dot_row(const Vec4& row, const Vec3& p) {
  return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
}
inline float dot(const Vec3& a, const Vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float largest_of(const Vec3& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}
inline Vec3 about_eye(const occlusion::EyeProjection& e, const Vec3& p) {
  return {(p.x - e.eye_high.x) - e.eye_low.x, (p.y - e.eye_high.y) - e.eye_low.y,
          (p.z - e.eye_high.z) - e.eye_low.z};
}

struct FloatPixel {
  float x, y, over_w;
};
inline FloatPixel float_pixel(const occlusion::EyeProjection& e, const Vec3& q) {
  const float over_w = 1 / dot_row(e.w, q);
  return {dot_row(e.x, q) * over_w, dot_row(e.y, q) * over_w, over_w};
}

}  // namespace sightline::test
