// Whether triangles and boxes are apart, by an axis between them: whichever axis it is, and however it was
// rounded, what lies apart along it is apart.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

#include "library/occlusion/solid.hpp"

namespace sightline::occlusion {

/// Whether the two lie farther apart than `margin` along some axis. False of some that lie closely beside one
/// another, true of none that do not.
inline bool are_apart(const Corners3& a, const Corners3& b, double margin) {
  constexpr double kNoAxis = 1e-24;
  const auto apart_along = [&](const glm::dvec3& axis) {
    const double length = glm::dot(axis, axis);
    if (!(length > kNoAxis)) return false;
    const double a0 = glm::dot(axis, a[0]), a1 = glm::dot(axis, a[1]), a2 = glm::dot(axis, a[2]);
    const double b0 = glm::dot(axis, b[0]), b1 = glm::dot(axis, b[1]), b2 = glm::dot(axis, b[2]);
    const double gap = std::max(std::min({a0, a1, a2}) - std::max({b0, b1, b2}),
                                std::min({b0, b1, b2}) - std::max({a0, a1, a2}));
    return gap > 0 && gap * gap > margin * margin * length;
  };
  const Corners3 ea{a[1] - a[0], a[2] - a[1], a[0] - a[2]}, eb{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const glm::dvec3 na = glm::cross(ea[0], ea[1]), nb = glm::cross(eb[0], eb[1]);
  if (apart_along(na) || apart_along(nb)) return true;
  for (const glm::dvec3& p : ea) {
    for (const glm::dvec3& q : eb) {
      if (apart_along(glm::cross(p, q))) return true;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (apart_along(glm::cross(ea[k], na)) || apart_along(glm::cross(eb[k], nb))) return true;
  }
  return false;
}

/// A triangle's plane and the planes through its edges, for asking of many boxes.
class TriangleSides {
public:
  explicit TriangleSides(const Corners3& t) {
    for (const glm::dvec3& p : t) box_.add(p);
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double length = glm::length(normal);
    if (!(length > 1e-18)) return;
    add(normal / length, t[0]), add(-normal / length, t[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 out = glm::cross(t[(k + 1) % 3] - t[k], normal / length);
      const double size = glm::length(out);
      if (size > 1e-12) add(out / size, t[k]);
    }
  }

  /// Whether the box lies farther than `margin` beyond one of them, or from the box around the triangle.
  [[nodiscard]] bool beyond(const Bounds3& box, double margin) const {
    if (glm::any(glm::greaterThan(box.low, box_.high + margin)) ||
        glm::any(glm::greaterThan(box_.low, box.high + margin)))
      return true;
    const glm::dvec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    for (int i = 0; i < count_; ++i) {
      if (glm::dot(normal_[i], middle) - at_[i] > glm::dot(glm::abs(normal_[i]), half) + margin + kRounding)
        return true;
    }
    return false;
  }

private:
  static constexpr double kRounding = 1e-12;
  void add(const glm::dvec3& normal, const glm::dvec3& through) {
    normal_[count_] = normal, at_[count_++] = glm::dot(normal, through);
  }
  Bounds3 box_;
  std::array<glm::dvec3, 5> normal_;
  std::array<double, 5> at_;
  int count_ = 0;
};

}  // namespace sightline::occlusion
