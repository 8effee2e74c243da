// Rays through pixel centres and their boxes, in double precision and from the matrices alone: the truth that
// occlusion is tested against.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/view.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::test {

/// Hits are told as nearness: 1 / w (perspective) or -depth (orthographic), -infinity for a miss.
class ExactRays {
public:
  explicit ExactRays(const View& view) : view_(view), orthographic_(is_orthographic(view)) {
    using namespace geometry;
    const glm::dmat4 clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
    inverse_ = glm::inverse(clip);
    rows_ = glm::transpose(clip);
    const glm::dmat4 to_world = glm::inverse(to_double(view.world_to_eye));
    eye_ = glm::dvec3(to_world[3]);
    forward_ = glm::normalize(-glm::dvec3(to_world[2]));
    near_ = near_plane(view);
  }

  /// The nearest point in front of the near plane where the pixel's ray meets the box's surface;
  /// `front_only`: where it enters.
  [[nodiscard]] double hit(double x, double y, const Box& box, bool front_only = false) const {
    const auto [origin, direction] = ray(x, y);
    double from = -1e30, to = 1e30;
    const double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0) {
        if (origin[a] < low[a] || origin[a] > high[a]) return kMiss;
        continue;
      }
      const double s = (low[a] - origin[a]) / direction[a], t = (high[a] - origin[a]) / direction[a];
      from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
    }
    // The near plane cuts surfaces, so a box that it cuts shows its inside: its far faces.
    const double slope = glm::dot(glm::dvec3(near_), direction),
                 start = glm::dot(glm::dvec3(near_), origin) + near_.w;
    const double first = slope > 0 ? -start / slope : -1e30;
    if (from > to || to < first || (front_only && from < first)) return kMiss;
    const double at = from >= first ? from : to;
    return orthographic_ ? -at : 1 / at;
  }

  /// The nearest point where the pixel's ray meets a sphere that lies in front of the near plane.
  [[nodiscard]] double hit(double x, double y, const Sphere& sphere) const {
    const auto [origin, direction] = ray(x, y);
    const glm::dvec3 to = glm::dvec3(sphere.centre.x, sphere.centre.y, sphere.centre.z) - origin;
    const double a = glm::dot(direction, direction), b = glm::dot(direction, to),
                 r = static_cast<double>(sphere.radius), under = b * b - a * (glm::dot(to, to) - r * r);
    const double at = (b - std::sqrt(std::max(under, 0.0))) / a;
    if (under < 0 || (!orthographic_ && at <= 0)) return kMiss;
    return orthographic_ ? -at : 1 / at;
  }

  /// Where the pixel's ray meets a triangle in front of the near plane, either face.
  [[nodiscard]] double hit(double x, double y, const std::array<Vec3, 3>& triangle) const {
    using geometry::to_double;
    return hit(x, y, std::array{to_double(triangle[0]), to_double(triangle[1]), to_double(triangle[2])});
  }
  [[nodiscard]] double hit(double x, double y, const std::array<glm::dvec3, 3>& triangle) const {
    const auto [origin, direction] = ray(x, y);
    const glm::dvec3 p = triangle[0], a = triangle[1] - p, b = triangle[2] - p;
    const glm::dvec3 normal = glm::cross(a, b), to = p - origin;
    const double slope = glm::dot(normal, direction);
    if (slope == 0) return kMiss;
    const double at = glm::dot(normal, to) / slope;
    const glm::dvec3 from = direction * at - to;  // p -> hit
    const double u = glm::dot(glm::cross(from, b), normal), v = glm::dot(glm::cross(a, from), normal);
    if (u < 0 || v < 0 || u + v > glm::dot(normal, normal)) return kMiss;
    if (glm::dot(glm::dvec3(near_), origin + direction * at) + near_.w < 0) return kMiss;
    return orthographic_ ? -at : 1 / at;
  }

  static constexpr double kMiss = -std::numeric_limits<double>::infinity();

private:
  struct Ray {
    glm::dvec3 origin, direction;
  };

  Ray ray(double x, double y) const {
    const double u = 2 * x / view_.width - 1, v = 1 - 2 * y / view_.height;
    glm::dvec3 origin, direction;
    if (orthographic_) {
      origin = eye_ + across(u, v);
      direction = forward_;
    } else {
      origin = eye_;
      const glm::dmat3 m(
          glm::transpose(glm::dmat3(glm::dvec3(rows_[0]), glm::dvec3(rows_[1]), glm::dvec3(rows_[3]))));
      direction = glm::inverse(m) * glm::dvec3(u, v, 1);  // w grows by 1 along it
    }
    return {origin, direction};
  }

  glm::dvec3 across(double u, double v) const {
    const glm::dvec3 x(rows_[0]), y(rows_[1]);
    const glm::dvec3 at(u * rows_[3].w - (glm::dot(x, eye_) + rows_[0].w),
                        v * rows_[3].w - (glm::dot(y, eye_) + rows_[1].w), 0);
    const glm::dmat3 m(glm::transpose(glm::dmat3(x, y, forward_)));
    return glm::inverse(m) * at;
  }

  View view_;
  bool orthographic_;
  glm::dmat4 inverse_, rows_;
  glm::dvec3 eye_, forward_;
  glm::dvec4 near_;
};

/// Where a point lies on the image, in pixels; false where it does not.
inline bool seen_at(const View& view, const glm::dvec3& point, glm::dvec2& out) {
  using geometry::to_double;
  const glm::dvec4 clip = to_double(view.eye_to_clip) * (to_double(view.world_to_eye) * glm::dvec4(point, 1));
  if (!(clip.w > 0)) return false;
  out = {(0.5 + 0.5 * clip.x / clip.w) * view.width, (0.5 - 0.5 * clip.y / clip.w) * view.height};
  return out.x >= 0 && out.x < view.width && out.y >= 0 && out.y < view.height;
}

/// The pixel there.
inline std::size_t pixel_of(const View& view, const glm::dvec2& place) {
  return static_cast<std::size_t>(place.y) * view.width + static_cast<std::size_t>(place.x);
}

/// Places of pixel i that are answered for: its centre; some within it, those at its corners among them.
inline std::vector<glm::dvec2> places_in(scene::Random& random, const View& view, std::size_t i,
                                         Coverage coverage) {
  const glm::dvec2 at(static_cast<double>(i % view.width), static_cast<double>(i / view.width));
  if (coverage == Coverage::centres) return {at + 0.5};
  std::vector<glm::dvec2> out;
  for (const double x : {1e-4, 1 - 1e-4}) {
    for (const double y : {1e-4, 1 - 1e-4}) out.push_back(at + glm::dvec2(x, y));
  }
  for (int k = 0; k < 4; ++k) out.push_back(at + glm::dvec2{random.between(0, 1), random.between(0, 1)});
  return out;
}

}  // namespace sightline::test
