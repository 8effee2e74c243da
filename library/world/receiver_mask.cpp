#include "library/world/receiver_mask.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/occlusion/depth_tiles.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kMostPixels = 256;

View smaller(const View& view) {
  View out = view;
  out.width = std::min(view.width, kMostPixels), out.height = std::min(view.height, kMostPixels);
  return out;
}

std::array<glm::dvec3, 8> corners_of(const glm::dvec3& low, const glm::dvec3& high) {
  std::array<glm::dvec3, 8> out;
  for (std::size_t i = 0; i < 8; ++i)
    out[i] = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
  return out;
}

}  // namespace

ReceiverMask::ReceiverMask(const Casters& casters, std::vector<float>& nearness)
    : view_(smaller(casters.shadow.view)),
      origin_(casters.shadow.origin),
      parallel_(is_orthographic(view_)),
      metres_(casters.filter.metres),
      nearness_(nearness) {
  const glm::dmat4 rows = glm::transpose(to_double(view_.eye_to_clip) * to_double(view_.world_to_eye));
  x_ = (rows[0] + rows[3]) * (0.5 * view_.width), y_ = (rows[3] - rows[1]) * (0.5 * view_.height),
  w_ = rows[3];
  const glm::dvec3 forward = to_double(view_direction(view_)), eye = eye_of(view_);
  depth_ = glm::dvec4(forward, -glm::dot(forward, eye));
  // Double precision loses far less than that.
  constexpr double kSlack = 1.0 / 256;
  const auto margin = [&](std::uint32_t pixels, std::uint32_t of) {
    if (SIGHTLINE_MUTANT(receivers_not_grown)) return 0.0;
    return static_cast<double>(casters.filter.texels) * pixels / of + kSlack;
  };
  margin_x_ = margin(view_.width, casters.shadow.view.width),
  margin_y_ = margin(view_.height, casters.shadow.view.height);
  nearness_.assign(std::size_t{view_.width} * view_.height, kNowhere);
}

void ReceiverMask::add_box(const glm::dvec3& low, const glm::dvec3& high) {
  fill(corners_of(low - metres_, high + metres_));
}

void ReceiverMask::add_points(const std::array<glm::dvec3, 8>& points) {
  if (metres_ == 0) return fill(points);
  glm::dvec3 low = points[0], high = points[0];
  for (const glm::dvec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
  add_box(low, high);
}

void ReceiverMask::fill(const std::array<glm::dvec3, 8>& points) {
  const double width = view_.width, height = view_.height;
  double left = width, right = 0, top = height, bottom = 0, least_w = 1, most_w = 0, farthest = -1e300;
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec4 p(points[i], 1);
    const double w = parallel_ ? 1 : glm::dot(w_, p), x = glm::dot(x_, p) / w, y = glm::dot(y_, p) / w;
    least_w = i == 0 ? w : std::min(least_w, w), most_w = std::max(most_w, w);
    left = i == 0 ? x : std::min(left, x), right = i == 0 ? x : std::max(right, x);
    top = i == 0 ? y : std::min(top, y), bottom = i == 0 ? y : std::max(bottom, y);
    farthest = std::max(farthest, glm::dot(depth_, p));
  }
  if (most_w <= 0) return;  // behind the light
  if (least_w <= 1e-6 * most_w) left = 0, right = width, top = 0, bottom = height;
  const double nearness = parallel_ ? -farthest : 1 / most_w;
  // Of what is no number nobody knows anything.
  const bool known = std::fabs(nearness) < 1e30;
  const float lower = known ? static_cast<float>(nearness - 1e-6 * std::fabs(nearness)) : -kNowhere;
  const double x0 = std::max(0.0, std::floor(left - margin_x_)),
               x1 = std::min(width - 1, std::floor(right + margin_x_));
  const double y0 = std::max(0.0, std::floor(top - margin_y_)),
               y1 = std::min(height - 1, std::floor(bottom + margin_y_));
  if (!(x0 <= x1 && y0 <= y1)) return;
  const auto first = static_cast<std::size_t>(x0), last = static_cast<std::size_t>(x1);
  for (auto y = static_cast<std::size_t>(y0); y <= static_cast<std::size_t>(y1); ++y) {
    float* row = &nearness_[y * view_.width];
    for (std::size_t x = first; x <= last; ++x) row[x] = std::min(row[x], lower);
  }
}

void ReceiverMask::keep_nearer(const std::vector<float>& other) {
  for (std::size_t i = 0; i < nearness_.size(); ++i) nearness_[i] = std::max(nearness_[i], other[i]);
}

void ReceiverMask::write(OcclusionBuffer& buffer) const {
  // Of area, so that it answers for any place of a pixel. The view is one that begin() has checked.
  (void)buffer.begin({view_, origin_}, {Coverage::area, 1});
  occlusion::DepthTiles& t = OcclusionAccess::tiles(buffer);
  constexpr std::uint32_t kSide = occlusion::kTile;
  for (std::uint32_t tile_y = 0; tile_y < t.rows; ++tile_y) {
    for (std::uint32_t tile_x = 0; tile_x < t.columns; ++tile_x) {
      const std::size_t tile = std::size_t{tile_y} * t.stride + tile_x;
      float least = kNowhere, most = -kNowhere;
      for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const std::uint32_t x = tile_x * kSide + i % kSide, y = tile_y * kSide + i / kSide;
        const bool within = x < t.width && y < t.height;
        const float nearness = within ? nearness_[std::size_t{y} * view_.width + x] : kNowhere;
        t.nearness[tile * kSide * kSide + i] = nearness;
        least = std::min(least, nearness);
        if (within) most = std::max(most, nearness);
      }
      t.plane.base[tile] = -kNowhere, t.farthest[tile] = least, t.nearest[tile] = most;
    }
  }
  occlusion::note_drawn(t, std::size_t{t.columns} * t.rows);
}

}  // namespace sightline::world
