#include "library/occlusion/near_clip.hpp"

#include <array>

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

}  // namespace sightline::occlusion
