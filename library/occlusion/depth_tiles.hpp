// The memory of an OcclusionBuffer, and a view prepared for drawing and querying.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <sightline/occlusion.hpp>

#include "library/geometry/aligned_vector.hpp"

namespace sightline::occlusion {

/// A view's projection about its eye, so that coordinates near the eye keep their digits: a point p is first
/// moved to q = (p - eye_high) - eye_low. Then (pixel x, pixel y, 1)·w = rows · (q, 1).
struct EyeProjection {
  Vec3 eye_high, eye_low;
  Vec4 x, y, w;
  Vec4 nearness;  ///< · (q, 1): orthographic only, minus the depth along the view; else 1/w is used
  bool orthographic = false;
};

/// What drawing needs besides: which way a pixel looks.
struct PixelRays {
  /// Per axis a: L_a(x, y) = at + x·across + y·down. Perspective: the direction through pixel (x, y) that has
  /// w = 1; orthographic: where its ray crosses depth 0, relative to the eye.
  std::array<float, 3> at{}, across{}, down{};
  std::array<float, 3> forward{};  ///< orthographic: the ray's direction
  Vec4 near_plane;                 ///< · (q, 1) >= 0 in front of the near plane
  bool turns_right =
      false;  ///< corners that go counterclockwise round a face do so to the right on the image
};

inline constexpr std::uint32_t kTile = 8;  ///< pixels a side

/// What a view has found out about a mesh. Reused from mesh to mesh.
struct MeshScratch {
  /// The groups in view, and their boxes about the view's origin: min x, y, z, max x, y, z.
  std::vector<std::uint32_t> group;
  std::array<geometry::AlignedVector<float>, 6> box;
  std::vector<std::uint64_t> near_first, other;  ///< depth, and place in the lists above
  /// Which way a triangle turns, in groups whose `known` says `turn`.
  geometry::AlignedVector<float> facing;
  std::vector<std::uint32_t> known;
  std::uint32_t turn = 0;
};

struct DepthTiles {
  WorldView view;
  EyeProjection projection;
  PixelRays rays;
  std::uint32_t width = 0, height = 0;
  std::uint32_t columns = 0, rows = 0;  ///< tiles
  std::uint32_t stride = 0;             ///< tiles from row to row, a multiple of 16 beyond the columns
  /// One a tile: no pixel of it is farther; -infinity where some pixel has no occluder. Padding: +infinity.
  geometry::AlignedVector<float> farthest;
  /// One a tile: no pixel of it is nearer; -infinity where nothing was drawn.
  geometry::AlignedVector<float> nearest;
  /// 64 a tile, row by row; undefined where `nearest` is -infinity. Pixels without an occluder hold
  /// -infinity, those beyond the image +infinity.
  geometry::AlignedVector<float> nearness;
  /// What an untouched tile holds: one within the image, in the last column, in the last row, in both.
  geometry::AlignedVector<float> untouched;

  MeshScratch mesh;
};

/// A convex polygon of the image, and its plane's nearness: at + x·across + y·down.
struct Convex {
  static constexpr std::size_t kMaxEdges = 10;
  std::size_t left_edges = 0, right_edges = 0;
  std::array<float, kMaxEdges + 1> left_at, left_slope, right_at, right_slope;  // x = at + slope·y
  float top = 0, bottom = 0;  // pixel centres y with top <= y <= bottom
  float left = 0, right = 0;  // bounds of the same kind
  float at = 0, across = 0, down = 0;
};

// How far inside its outline, in pixels, an occluder must hold a pixel centre; and how much the rounding of
// far-off coordinates adds.
inline constexpr float kInset = 1.0f / 256, kInsetGrowth = 2e-6f;
// Edges flatter than this are the top or the bottom of a polygon.
inline constexpr float kFlat = 1e-3f;

/// Adds the edge from a to b, whose interior lies to its left or right on the image, moved inwards by `inset`
/// pixels.
inline void add_edge(Convex& polygon, float ax, float ay, float bx, float by, bool interior_left,
                     float inset) noexcept {
  const float dy = by - ay;
  const bool steep = std::fabs(dy) >= kFlat;
  const float slope = (bx - ax) / dy, at = ax - ay * slope;
  const float inwards = inset * (1 + std::fabs(slope));
  // Written to both lists and counted in one: no branch to guess.
  polygon.right_at[polygon.right_edges] = at - inwards;
  polygon.right_slope[polygon.right_edges] = slope;
  polygon.left_at[polygon.left_edges] = at + inwards;
  polygon.left_slope[polygon.left_edges] = slope;
  polygon.right_edges += steep && interior_left;
  polygon.left_edges += steep && !interior_left;
}

/// Moves the plane away by what rounding can have brought it nearer: of the numbers, and of the pixel's place
/// on a surface seen edge on.
inline void move_back(Convex& polygon, float nearest) noexcept {
  polygon.at -= 2e-5f * std::fabs(nearest) + (std::fabs(polygon.across) + std::fabs(polygon.down)) / 64;
}

struct OccluderTopology {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Of edge k, from corner k to corner k+1: the only other triangle there, or kNone.
  std::vector<std::array<std::uint32_t, 3>> neighbours;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// Whether this triangle, of even number, and the next make a flat convex quad; their edges 2 are its
  /// diagonal.
  std::vector<std::uint8_t> first_half;

  /// Runs of triangles with a box that holds them: what is out of view or hidden as a whole is not set up.
  static constexpr std::uint32_t kGroup = 16;
  struct Group {
    /// A bit a triangle and edge: its second corner has the lower number.
    std::array<std::uint32_t, 3> turned{};
    std::uint32_t first_half = 0;                    ///< a bit a triangle
    std::uint32_t first_beside = 0, end_beside = 0;  ///< in `beside`
  };
  std::vector<Group> groups;          ///< group g holds triangles 16·g …
  std::vector<std::uint32_t> beside;  ///< of each group those that hold its triangles' neighbours
  /// Per 16 groups the middles of their boxes, x, y, z, and half their sizes: 16 values each.
  geometry::AlignedVector<float> box;
  /// Per group, corner and axis 16 values, and per group and edge 16 neighbours or -1; beyond the last
  /// triangle its first corner three times, no neighbours.
  geometry::AlignedVector<float> corners;
  geometry::AlignedVector<std::int32_t> neighbour;
  void lay_out();
};

/// Puts halves of quads side by side. Neighbours are known; triangles are numbered anew, near their old
/// places.
void pair_up(OccluderTopology& mesh);

EyeProjection eye_projection(const WorldView& view, const WorldPoint& origin) noexcept;
void draw_convex(DepthTiles& tiles, const Convex& polygon) noexcept;
/// A box that crosses the near plane, about the eye.
void draw_clipped_box(DepthTiles& tiles, const std::array<float, 3>& low,
                      const std::array<float, 3>& high) noexcept;
/// A triangle that crosses the near plane, about the eye.
void draw_clipped_triangle(DepthTiles& tiles, const std::array<std::array<double, 3>, 3>& corners) noexcept;
void draw_boxes(DepthTiles& tiles, std::span<const Box> boxes) noexcept;
void draw_balls(DepthTiles& tiles, std::span<const Sphere> balls) noexcept;
/// Allocates until it has seen its largest mesh.
void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform);
void query_boxes(const DepthTiles& tiles, const EyeProjection& projection, const BoxSpan& boxes,
                 std::uint8_t* visible) noexcept;
void query_spheres(const DepthTiles& tiles, const EyeProjection& projection, const SphereSpan& spheres,
                   std::uint8_t* visible) noexcept;
/// Three corners a triangle.
bool query_triangles(const DepthTiles& tiles, std::span<const Vec3> corners) noexcept;

/// Sixteen triangles ready to be asked for: a value a triangle, by corner and axis. Of fewer the last again.
struct TriangleBlock {
  static constexpr std::size_t kSize = 16;
  alignas(64) std::array<std::array<std::array<float, kSize>, 3>, 3> corners;
  /// Up to 16 of the triangles from `first` on, three corners each.
  void take(std::span<const Vec3> triangles, std::size_t first) noexcept;
};
/// Of blocks that are soon asked for the first, if there is one.
void prefetch(std::span<const TriangleBlock> blocks) noexcept;
/// The same of the first `count` triangles of whole blocks.
bool query_triangles(const DepthTiles& tiles, std::span<const TriangleBlock> blocks,
                     std::size_t count) noexcept;

}  // namespace sightline::occlusion
