#include "library/occlusion/near_clip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "library/geometry/error_bounds.hpp"

namespace sightline::occlusion {

namespace {

// Sutherland & Hodgman 1974, one plane.
bool clip(const Vec4& plane, double slack, Polygon& polygon) {
  std::array<double, Polygon::kMost> side;
  bool whole = true;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    side[i] = dot(plane, polygon.points[i]) + slack;
    whole = whole && side[i] >= 0;
  }
  if (whole) return true;
  Polygon out;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t next = i + 1 < polygon.count ? i + 1 : 0;
    const glm::dvec3 &a = polygon.points[i], &b = polygon.points[next];
    if (out.count + 2 > Polygon::kMost) return false;
    if (side[i] >= 0) out.edge[out.count] = polygon.edge[i], out.points[out.count++] = a;
    if ((side[i] >= 0) != (side[next] >= 0)) {
      out.edge[out.count] = side[i] >= 0 ? Polygon::kClipped : polygon.edge[i];
      out.points[out.count++] = a + (b - a) * (side[i] / (side[i] - side[next]));
    }
  }
  polygon = out;
  return true;
}

}  // namespace

bool clip_to_view(const DepthTiles& tiles, double slack, Polygon& polygon) noexcept {
  const EyeProjection& e = tiles.projection;
  const auto w = static_cast<float>(tiles.width), h = static_cast<float>(tiles.height);
  const auto beyond = [&](const Vec4& row, float scale, float shift) {
    return Vec4{scale * row.x + shift * e.w.x, scale * row.y + shift * e.w.y, scale * row.z + shift * e.w.z,
                scale * row.w + shift * e.w.w};
  };
  if (!clip(tiles.rays.near_plane, slack, polygon)) return false;
  for (const Vec4& plane :
       {beyond(e.x, 1, w), beyond(e.x, -1, 2 * w), beyond(e.y, 1, h), beyond(e.y, -1, 2 * h)}) {
    if (polygon.count < 3) return true;
    if (!clip(plane, 0, polygon)) return false;
  }
  return true;
}

double reach_of(std::span<const glm::dvec3> points) noexcept {
  double reach = 0;
  for (const glm::dvec3& q : points)
    reach = std::max({reach, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
  return reach;
}

float near_edge_play(const DepthTiles& tiles, double reach, double least_w) noexcept {
  const EyeProjection& e = tiles.projection;
  const auto size = [](const Vec4& row) {
    return std::fabs(double{row.x}) + std::fabs(double{row.y}) + std::fabs(double{row.z});
  };
  const double place = std::max(tiles.width, tiles.height);
  return static_cast<float>(double{geometry::kRowRounding} * reach *
                            (std::max(size(e.x), size(e.y)) + place * size(e.w)) / least_w);
}

}  // namespace sightline::occlusion
