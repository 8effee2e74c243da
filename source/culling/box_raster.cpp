// Occluding boxes into the tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "culling/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/box_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "culling/depth_raster-inl.hpp"

#ifndef SIGHTLINE_BOX_OUTLINES
#define SIGHTLINE_BOX_OUTLINES
namespace sightline::culling {

// Corner c of a box has the greater x, y, z where bit 0, 1, 2 is set. Edge 4a + i runs along axis a, upwards,
// from corner kEdges[4a + i]. Faces -x, +x, -y, +y, -z, +z with their corners counterclockwise as seen from
// outside.
inline constexpr std::uint8_t kEdges[12] = {0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};
inline constexpr std::uint8_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

// The outline of a box by which faces look at the eye (Schmalstieg & Tobler 1999, made by rule): the edges
// between a face that does and one that does not, in the direction of the former.
struct BoxOutlines {
  std::uint8_t count[64] = {};
  std::uint8_t edge[64][12] = {};
  bool downwards[64][12] = {};  // against the edge's own direction

  constexpr BoxOutlines() {
    for (int faces = 0; faces < 64; ++faces) {
      for (int f = 0; f < 6; ++f) {
        if ((faces >> f & 1) == 0) continue;
        for (int k = 0; k < 4; ++k) {
          const std::uint8_t a = kFaces[f][k], b = kFaces[f][(k + 1) % 4];
          bool inner = false;
          for (int g = 0; g < 6; ++g) {
            for (int j = 0; j < 4; ++j) {
              inner = inner || ((faces >> g & 1) != 0 && kFaces[g][j] == b && kFaces[g][(j + 1) % 4] == a);
            }
          }
          if (inner) continue;
          const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
          for (int i = 4 * axis; i < 4 * axis + 4; ++i) {
            if (kEdges[i] == (a & b)) edge[faces][count[faces]] = static_cast<std::uint8_t>(i);
          }
          downwards[faces][count[faces]++] = a > b;
        }
      }
    }
  }
};
inline constexpr BoxOutlines kOutlines;

}  // namespace sightline::culling
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

template <std::size_t kCount>
using Vectors = std::array<std::array<float, 16>, kCount>;

// A vector of boxes, projected, with all that any of their outlines may need.
struct ProjectedBoxes {
  alignas(64) Vectors<6> sides;                            // about the eye
  alignas(64) Vectors<8> x, y;                             // of the corners
  alignas(64) Vectors<12> slope, right_at, left_at, rise;  // of the edges; see add_edge()
  alignas(64) Vectors<3> at, across, down;                 // of the plane that looks at the eye, by axis
  alignas(64) std::array<float, 16> clearance, left, right, top, bottom, nearest, inset;
  std::uint32_t facing[6];  // a bit a box: the face surely looks at the eye
  std::uint32_t grazing;    // some face looks at it, but not surely
};

// Which faces look at the eye, and their planes.
HWY_INLINE void find_faces(const DepthTiles& tiles, VF nearest, ProjectedBoxes& out) {
  const F f;
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  const VF zero = hn::Zero(f);
  out.grazing = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const VF low = hn::Load(f, out.sides[a].data()), high = hn::Load(f, out.sides[a + 3].data());
    const VF margin =
        hn::Add(hn::Set(f, 1e-6f), hn::Mul(hn::Set(f, 1e-5f), hn::Max(hn::Abs(low), hn::Abs(high))));
    const VF forward = hn::Set(f, rays.forward[a]);
    const auto down = orthographic ? hn::Gt(forward, hn::Set(f, 1e-5f)) : hn::Gt(low, margin);
    const auto up = orthographic ? hn::Lt(forward, hn::Set(f, -1e-5f)) : hn::Lt(high, hn::Neg(margin));
    const auto any = orthographic ? hn::Ne(forward, zero) : hn::Or(hn::Gt(low, zero), hn::Lt(high, zero));
    out.facing[2 * a] = bits_of(down), out.facing[2 * a + 1] = bits_of(up);
    out.grazing |= bits_of(any) & ~(out.facing[2 * a] | out.facing[2 * a + 1]);
    const VF at = hn::IfThenElse(down, low, high);
    const VF scale = hn::Div(hn::Set(f, 1.0f), orthographic ? forward : at);
    const VF across = hn::Mul(hn::Set(f, rays.across[a]), scale),
             along = hn::Mul(hn::Set(f, rays.down[a]), scale);
    const VF start = orthographic ? hn::Sub(hn::Set(f, rays.at[a]), at) : hn::Set(f, rays.at[a]);
    hn::Store(across, f, out.across[a].data());
    hn::Store(along, f, out.down[a].data());
    hn::Store(moved_back(hn::Mul(start, scale), across, along, nearest), f, out.at[a].data());
  }
}

HWY_INLINE void find_edges(VF inset, ProjectedBoxes& out) {
  const F f;
  for (std::size_t e = 0; e < 12; ++e) {
    const std::size_t from = kEdges[e], to = from | std::size_t{1} << (e / 4);
    const VF ax = hn::Load(f, out.x[from].data()), ay = hn::Load(f, out.y[from].data()),
             bx = hn::Load(f, out.x[to].data()), by = hn::Load(f, out.y[to].data());
    const VF rise = hn::Sub(by, ay), slope = hn::Div(hn::Sub(bx, ax), rise),
             at = hn::Sub(ax, hn::Mul(ay, slope));
    const VF inwards = hn::Mul(inset, hn::Add(hn::Set(f, 1.0f), hn::Abs(slope)));
    hn::Store(rise, f, out.rise[e].data());
    hn::Store(slope, f, out.slope[e].data());
    hn::Store(hn::Sub(at, inwards), f, out.right_at[e].data());
    hn::Store(hn::Add(at, inwards), f, out.left_at[e].data());
  }
}

HWY_INLINE void project_boxes(const DepthTiles& tiles, const Box* boxes, std::size_t count,
                              ProjectedBoxes& out) {
  const F f;
  const EyeProjection& e = tiles.projection;
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) {
    const Box& box = boxes[std::min(i, count - 1)];
    out.sides[0][i] = box.min.x, out.sides[1][i] = box.min.y, out.sides[2][i] = box.min.z;
    out.sides[3][i] = box.max.x, out.sides[4][i] = box.max.y, out.sides[5][i] = box.max.z;
  }
  const float high[3] = {e.eye_high.x, e.eye_high.y, e.eye_high.z},
              low[3] = {e.eye_low.x, e.eye_low.y, e.eye_low.z};
  VF q[6];
  for (std::size_t side = 0; side < 6; ++side) {
    q[side] = hn::Sub(hn::Sub(hn::Load(f, out.sides[side].data()), hn::Set(f, high[side % 3])),
                      hn::Set(f, low[side % 3]));
    hn::Store(q[side], f, out.sides[side].data());
  }
  VF left = hn::Set(f, kInfinity), top = left, clear = left;
  VF right = hn::Set(f, -kInfinity), bottom = right, nearest = right;
  for (std::size_t c = 0; c < 8; ++c) {
    const VF qx = q[c & 1 ? 3 : 0], qy = q[c & 2 ? 4 : 1], qz = q[c & 4 ? 5 : 2];
    const auto dot = [&](const Vec4& row) HWY_ATTR { return dot_row(row, qx, qy, qz); };
    clear = hn::Min(clear, dot(tiles.rays.near_plane));
    const VF over_w = hn::Div(hn::Set(f, 1.0f), dot(e.w));
    const VF x = hn::Mul(dot(e.x), over_w), y = hn::Mul(dot(e.y), over_w);
    nearest = hn::Max(nearest, e.orthographic ? dot(e.nearness) : over_w);
    left = hn::Min(left, x), right = hn::Max(right, x), top = hn::Min(top, y), bottom = hn::Max(bottom, y);
    hn::Store(x, f, out.x[c].data());
    hn::Store(y, f, out.y[c].data());
  }
  const VF farthest_out =
      hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
  const VF inset = hn::Add(hn::Set(f, kInset), hn::Mul(hn::Set(f, kInsetGrowth), farthest_out));
  hn::Store(inset, f, out.inset.data());
  hn::Store(clear, f, out.clearance.data());
  hn::Store(nearest, f, out.nearest.data());
  hn::Store(left, f, out.left.data());
  hn::Store(right, f, out.right.data());
  hn::Store(top, f, out.top.data());
  hn::Store(bottom, f, out.bottom.data());
  find_faces(tiles, nearest, out);
  find_edges(inset, out);
}

// The outline of box i and the planes before it.
HWY_INLINE void outline(const DepthTiles& tiles, const ProjectedBoxes& b, std::size_t i, Convex& polygon) {
  std::uint32_t faces = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint32_t down = b.facing[2 * a] >> i & 1, up = b.facing[2 * a + 1] >> i & 1;
    // Without branches: which faces look at the eye is anyone's guess.
    faces |= (down | up << 1) << (2 * a);
    const std::size_t p = polygon.planes;
    polygon.across[p] = b.across[a][i], polygon.down[p] = b.down[a][i], polygon.at[p] = b.at[a][i];
    polygon.planes += down | up;
  }
  polygon.left = b.left[i], polygon.right = b.right[i], polygon.top = b.top[i], polygon.bottom = b.bottom[i];
  const bool grazed = b.grazing >> i & 1;
  if (grazed) polygon.left = polygon.top = kInfinity, polygon.right = polygon.bottom = -kInfinity;
  for (std::uint32_t k = 0; k < kOutlines.count[faces]; ++k) {
    const std::uint8_t e = kOutlines.edge[faces][k];
    const float rise = b.rise[e][i];
    const bool steep = std::fabs(rise) >= kFlat;
    const bool interior_left = ((rise > 0) != kOutlines.downwards[faces][k]) == tiles.rays.turns_right;
    polygon.right_at[polygon.right_edges] = b.right_at[e][i];
    polygon.left_at[polygon.left_edges] = b.left_at[e][i];
    polygon.right_slope[polygon.right_edges] = polygon.left_slope[polygon.left_edges] = b.slope[e][i];
    polygon.right_edges += steep && interior_left;
    polygon.left_edges += steep && !interior_left;
    if (!grazed) continue;  // else the outline is smaller than the box
    for (const std::size_t c : {std::size_t{kEdges[e]}, kEdges[e] | std::size_t{1} << (e / 4)}) {
      polygon.left = std::min(polygon.left, b.x[c][i]), polygon.right = std::max(polygon.right, b.x[c][i]);
      polygon.top = std::min(polygon.top, b.y[c][i]), polygon.bottom = std::max(polygon.bottom, b.y[c][i]);
    }
  }
  // One length of lists for nearly all boxes: less to guess. A side has four edges or more only now and then.
  for (; polygon.planes < 3; ++polygon.planes) {
    const std::size_t p = polygon.planes;
    polygon.across[p] = polygon.across[0], polygon.down[p] = polygon.down[0], polygon.at[p] = polygon.at[0];
  }
  for (; polygon.left_edges > 0 && polygon.left_edges < 3; ++polygon.left_edges)
    polygon.left_at[polygon.left_edges] = -kInfinity, polygon.left_slope[polygon.left_edges] = 0;
  for (; polygon.right_edges > 0 && polygon.right_edges < 3; ++polygon.right_edges)
    polygon.right_at[polygon.right_edges] = kInfinity, polygon.right_slope[polygon.right_edges] = 0;
  const float inset = b.inset[i];
  polygon.left += inset, polygon.right -= inset, polygon.top += inset, polygon.bottom -= inset;
}

void draw_all_boxes(DepthTiles& tiles, std::span<const Box> boxes) {
  const F f;
  const auto width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
  ProjectedBoxes b;
  for (std::size_t first = 0; first < boxes.size(); first += hn::Lanes(f)) {
    const std::size_t count = std::min(hn::Lanes(f), boxes.size() - first);
    project_boxes(tiles, &boxes[first], count, b);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(b.sides[0][i] <= b.sides[3][i] && b.sides[1][i] <= b.sides[4][i] &&
            b.sides[2][i] <= b.sides[5][i])) {
        continue;
      }
      if (!(b.clearance[i] >= 0)) {
        draw_clipped_box(tiles, {b.sides[0][i], b.sides[1][i], b.sides[2][i]},
                         {b.sides[3][i], b.sides[4][i], b.sides[5][i]});
        continue;
      }
      const float x0 = b.left[i], x1 = b.right[i], y0 = b.top[i], y1 = b.bottom[i];
      if (!(x1 > 0 && x0 < width && y1 > 0 && y0 < height)) continue;
      // A box behind what is drawn already changes nothing.
      if (hidden_rect(tiles, x0, y0, x1, y1, b.nearest[i])) continue;
      Convex polygon;
      outline(tiles, b, i, polygon);
      draw_polygon(tiles, polygon);
    }
  }
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::culling {
HWY_EXPORT(draw_all_boxes);

void draw_boxes(DepthTiles& tiles, std::span<const Box> boxes) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_all_boxes)(tiles, boxes);
}

}  // namespace sightline::culling
#endif
