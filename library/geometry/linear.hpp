// Between the public aggregates and GLM, which does the mathematics inside.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <cmath>

#include <sightline/frustum.hpp>
#include <sightline/types.hpp>

namespace sightline {
struct View;
}

namespace sightline::geometry {

/// eye_position(), not rounded.
glm::dvec3 eye_of(const View& view) noexcept;

inline glm::dmat4 to_double(const Mat4& m) noexcept {
  return glm::dmat4(glm::make_mat4(m.m.data()));
}
inline glm::dvec3 to_double(const Vec3& v) noexcept {
  return {v.x, v.y, v.z};
}
inline glm::vec3 to_glm(const Vec3& v) noexcept {
  return {v.x, v.y, v.z};
}

inline Vec3 to_vec3(const glm::dvec3& v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3 to_vec3(const glm::vec3& v) noexcept {
  return {v.x, v.y, v.z};
}

/// `rest` is what `rounded` lacks. Through a volatile: where g++ 12 vectorises the three subtractions, it
/// takes rounding to single precision and back for nothing done, and the rest for 0.
struct Split {
  Vec3 rounded, rest;
};
inline Split split(const glm::dvec3& v) noexcept {
  const auto rest = [](double value, float near) {
    const volatile float stored = near;
    return static_cast<float>(value - static_cast<double>(stored));
  };
  const Vec3 rounded = to_vec3(v);
  return {rounded, {rest(v.x, rounded.x), rest(v.y, rounded.y), rest(v.z, rounded.z)}};
}

inline Mat4 to_mat4(const glm::dmat4& m) noexcept {
  Mat4 out;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) out.m[4 * c + r] = static_cast<float>(m[c][r]);
  }
  return out;
}

/// An affine transform, not rounded.
struct ExactAffine {
  glm::dmat3 linear{1};
  glm::dvec3 translation{0};

  bool operator==(const ExactAffine&) const = default;
};
inline ExactAffine exact_affine(const Mat4& matrix) noexcept {
  const glm::dmat4 m = to_double(matrix);
  return {glm::dmat3(m), glm::dvec3(m[3])};
}

inline bool is_finite(const Vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_valid(const Box& box) noexcept {
  return is_finite(box.min) && is_finite(box.max) && box.min.x <= box.max.x && box.min.y <= box.max.y &&
         box.min.z <= box.max.z;
}

/// The largest absolute coordinates of a box.
inline Vec3 largest(const Box& box) noexcept {
  return {std::fmax(std::fabs(box.min.x), std::fabs(box.max.x)),
          std::fmax(std::fabs(box.min.y), std::fabs(box.max.y)),
          std::fmax(std::fabs(box.min.z), std::fabs(box.max.z))};
}

/// make_frustum for any matrix to clip space, still in double precision, and for what lies within `extent`
/// alone; `forward` tells front from back.
Frustum frustum_of(const glm::dmat4& clip, const Vec3& forward, const Box& extent) noexcept;
/// The front plane as the matrices have it, in double precision: (normal, distance), >= 0 before the eye; 0
/// where there is none.
glm::dvec4 near_plane(const View& view) noexcept;
/// A plane a little before the far one: a point that signed_distance() says is on its inner side is within
/// the frustum. Its normal is 0 where there is no far plane.
Plane far_plane_within(const View& view) noexcept;

}  // namespace sightline::geometry
