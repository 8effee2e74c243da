#include "library/occlusion/silhouette.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "library/geometry/linear.hpp"

namespace sightline::occlusion {

namespace {

constexpr int kSide = 48;  // pixels
using Image = std::bitset<std::size_t{kSide} * kSide>;

void draw(std::array<glm::dvec2, 3> t, Sides sides, Image& image) {
  const auto beyond = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0;
  };
  if (beyond(t[0], t[1], t[2])) {
    if (sides == Sides::front) return;
    std::swap(t[1], t[2]);
  }
  const auto range = [&](int axis) {
    const auto [least, most] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    return std::pair{static_cast<int>(std::clamp(std::ceil(least - 0.5), 0.0, double{kSide})),
                     static_cast<int>(std::clamp(std::floor(most + 0.5), 0.0, double{kSide}))};
  };
  const auto [x0, x1] = range(0);
  const auto [y0, y1] = range(1);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const glm::dvec2 p(x + 0.5, y + 0.5);
      if (!beyond(t[0], t[1], p) && !beyond(t[1], t[2], p) && !beyond(t[2], t[0], p))
        image.set(static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x));
    }
  }
}

}  // namespace

double mean_silhouette(std::span<const Candidate> triangles, const glm::dvec3& low, const glm::dvec3& high) {
  static const glm::dvec3 kDirections[] = {{1, 0.1, 0.05}, {0.05, 1, 0.1},  {0.1, 0.05, 1},
                                           {1, 1, 1},      {-1, 1, 1},      {1, -1, 1},
                                           {1, 1, -1},     {0.7, 0.8, 0.1}, {0.1, 0.7, -0.8}};
  const glm::dvec3 middle = 0.5 * (low + high);
  const double scale = kSide / std::max(glm::length(high - low), 1e-300);
  std::size_t covered = 0, all = 0;
  for (std::size_t i = 0; i < 2 * std::size(kDirections); ++i) {
    const glm::dvec3 direction = (i % 2 == 0 ? 1.0 : -1.0) * kDirections[i / 2];
    const glm::dvec3 right = glm::normalize(glm::cross(direction, glm::dvec3(0.3, -0.2, 0.9))),
                     up = glm::cross(right, glm::normalize(direction));
    Image image;
    for (const Candidate& c : triangles) {
      std::array<glm::dvec2, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 at = geometry::to_double(c.corners[k]) - middle;
        corners[k] = scale * glm::dvec2(glm::dot(right, at), glm::dot(up, at)) + 0.5 * kSide;
      }
      draw(corners, c.sides, image);
    }
    covered += image.count(), all += image.size();
  }
  return static_cast<double>(covered) / static_cast<double>(all);
}

}  // namespace sightline::occlusion
