// Polygons clipped to what a view can show: the one place where the near plane cuts.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "library/occlusion/depth_tiles.hpp"

namespace sightline::occlusion {

/// A convex polygon about the eye; in double precision, for what the near plane cuts may reach far behind the
/// eye, and its plane must still be right before it.
struct Polygon {
  static constexpr std::size_t kMost = 12;
  static constexpr std::uint8_t kClipped = 0xff;
  std::array<glm::dvec3, kMost> points;
  /// Of the edge from a point to the next: what whoever made the polygon wrote, or kClipped where a plane
  /// made the edge.
  std::array<std::uint8_t, kMost> edge{};
  std::size_t count = 0;
};

/// Vec4 · (q, 1).
inline double dot(const Vec4& row, const glm::dvec3& q) noexcept {
  return row.x * q.x + row.y * q.y + row.z * q.z + row.w;
}

/// The largest coordinate of some points.
double reach_of(std::span<const glm::dvec3> points) noexcept;

/// Keeps what lies no farther behind the near plane than `slack` and no farther beyond the image than the
/// image is wide or high; nothing remains where count < 3. False where rounding has bent the polygon so that
/// it gets more corners than there is room for.
bool clip_to_view(const DepthTiles& tiles, double slack, Polygon& polygon) noexcept;

/// How far, in pixels, a rasteriser that clips in single precision may move the edge that the near plane
/// makes of a polygon whose corners reach so far about the eye; `least_w` is of that edge.
float near_edge_play(const DepthTiles& tiles, double reach, double least_w) noexcept;

}  // namespace sightline::occlusion
