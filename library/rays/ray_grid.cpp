#include "library/rays/ray_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"

namespace sightline::rays {

using namespace geometry;

ViewRays::ViewRays(const View& view) noexcept
    : clip_to_eye_(glm::inverse(to_double(view.eye_to_clip))),
      eye_to_world_(glm::inverse(to_double(view.world_to_eye))),
      width_(view.width),
      height_(view.height) {
  // The eye looks down -z. Halfway in depth is finite for every projection; the near plane lies before it.
  const auto z_at = [&](double depth) {
    const glm::dvec4 p = clip_to_eye_ * glm::dvec4(0, 0, depth, 1);
    return p.z / p.w;
  };
  const glm::dvec4 zero = clip_to_eye_ * glm::dvec4(0, 0, 0, 1);
  const bool zero_is_near = zero.w != 0 && zero.z / zero.w > z_at(0.5);
  if (!zero_is_near) near_depth_ = 1, far_depth_ = 0;
}

Ray ViewRays::through(double x, double y) const noexcept {
  const double clip_x = 2 * x / width_ - 1, clip_y = 1 - 2 * y / height_;
  const auto unproject = [&](double depth) { return clip_to_eye_ * glm::dvec4(clip_x, clip_y, depth, 1); };
  const glm::dvec4 first = unproject(near_depth_), half = unproject(0.5), last = unproject(far_depth_);
  const glm::dvec3 from = glm::dvec3(first) / first.w;
  const glm::dvec3 direction = glm::normalize(glm::dvec3(half) / half.w - from);
  // A far plane at infinity has w = 0 up to what rounding the matrix left of it.
  constexpr double kFarthest = std::numeric_limits<float>::max();
  double length = kFarthest;
  if (std::fabs(last.w) * 1e12 > glm::length(glm::dvec3(last))) {
    length = glm::dot(glm::dvec3(last) / last.w - from, direction);
    if (!(length > 0 && length < kFarthest)) length = kFarthest;
  }
  return {to_vec3(glm::dvec3(eye_to_world_ * glm::dvec4(from, 1))),
          to_vec3(glm::normalize(glm::dmat3(eye_to_world_) * direction)), static_cast<float>(length)};
}

void RayGrid::make(const View& view, std::uint32_t grid_columns, std::uint32_t grid_rows) {
  columns = grid_columns, rows = grid_rows;
  rays.clear(), prepared.clear();
  rays.reserve(std::size_t{columns} * rows), prepared.reserve(std::size_t{columns} * rows);
  const ViewRays view_rays(view);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      rays.push_back(
          view_rays.through((column + 0.5) * view.width / columns, (row + 0.5) * view.height / rows));
      prepared.emplace_back(rays.back());
    }
  }
  constexpr std::uint32_t kTile = 4;
  order.clear();
  order.reserve(rays.size());
  for (std::uint32_t top = 0; top < rows; top += kTile) {
    for (std::uint32_t left = 0; left < columns; left += kTile) {
      for (std::uint32_t row = top; row < std::min(top + kTile, rows); ++row) {
        for (std::uint32_t column = left; column < std::min(left + kTile, columns); ++column) {
          order.push_back(row * columns + column);
        }
      }
    }
  }
}

}  // namespace sightline::rays
