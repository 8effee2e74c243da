// The passes of the occlusion buffer in SIMD: boxes and polygons into tiles, and boxes against tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "culling/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/depth_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#ifndef SIGHTLINE_BOX_OUTLINES
#define SIGHTLINE_BOX_OUTLINES
namespace sightline::culling {

// Corner c of a box has the greater x, y, z where bit 0, 1, 2 is set. Faces -x, +x, -y, +y, -z, +z with their
// corners counterclockwise as seen from outside.
inline constexpr std::uint8_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

// The outline of a box by which faces look at the eye (Schmalstieg & Tobler 1999, made by rule): the edges
// between a face that does and one that does not, in the direction of the former.
struct BoxOutlines {
  std::uint8_t count[64] = {};
  std::uint8_t from[64][12] = {}, to[64][12] = {};

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
          from[faces][count[faces]] = a;
          to[faces][count[faces]++] = b;
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

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using VF = hn::Vec<F>;
using Row = hn::CappedTag<float, 8>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
alignas(64) constexpr float kColumn[64] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5,
                                           6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3,
                                           4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
alignas(64) constexpr float kRow[64] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2,
                                        2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 5,
                                        5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7};

// Bits i … i + lanes - 1 of a tile's pixels.
HWY_INLINE hn::Mask<F> pixels_at(std::uint64_t pixels, std::size_t i) {
  const std::uint64_t part = pixels >> i;
  std::uint8_t bytes[8];
  std::memcpy(bytes, &part, sizeof bytes);
  if (hn::Lanes(F()) < 8) bytes[0] &= (1u << hn::Lanes(F())) - 1;
  return hn::LoadMaskBits(F(), bytes);
}

// A tile's first touch: nothing there, and nothing to be waited for beyond the image.
void touch(DepthTiles& tiles, std::uint32_t tx, std::uint32_t ty) {
  const F f;
  const std::size_t tile = std::size_t{ty} * tiles.columns + tx;
  float* out = &tiles.nearness[tile * 64];
  std::uint64_t beyond = 0;
  const auto columns = hn::Set(f, static_cast<float>(tiles.width) - static_cast<float>(tx * kTile));
  const auto rows = hn::Set(f, static_cast<float>(tiles.height) - static_cast<float>(ty * kTile));
  for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
    const auto inside =
        hn::And(hn::Lt(hn::Load(f, kColumn + i), columns), hn::Lt(hn::Load(f, kRow + i), rows));
    hn::Store(hn::IfThenElse(inside, hn::Set(f, -kInfinity), hn::Set(f, kInfinity)), f, out + i);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(f, inside, bits);
    std::uint64_t part;
    std::memcpy(&part, bits, sizeof part);
    beyond |= (~part & ((std::uint64_t{1} << hn::Lanes(f)) - 1)) << i;
  }
  tiles.covered[tile] = beyond;
}

// The polygon's nearness over two rows of a tile, from their first pixel.
struct TilePlanes {
  alignas(64) std::array<std::array<float, 16>, 3> offset;
  std::array<float, 3> most;  // offset within a tile
};

HWY_INLINE TilePlanes tile_planes(const Convex& polygon) {
  const F f;
  TilePlanes out;
  for (std::size_t p = 0; p < polygon.planes; ++p) {
    const VF across = hn::Set(f, polygon.across[p]), down = hn::Set(f, polygon.down[p]);
    for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
      const VF offset =
          hn::Add(hn::Mul(across, hn::Load(f, kColumn + i)), hn::Mul(down, hn::Load(f, kRow + i)));
      hn::Store(offset, f, &out.offset[p][i]);
    }
    out.most[p] = std::max(0.0f, 7 * polygon.across[p]) + std::max(0.0f, 7 * polygon.down[p]);
  }
  return out;
}

template <std::size_t kPlanes>
HWY_INLINE void update_tile(DepthTiles& tiles, const Convex& polygon, const TilePlanes& planes,
                            std::uint32_t tx, std::uint32_t ty, std::uint64_t pixels) {
  const F f;
  const float x = static_cast<float>(tx * kTile) + 0.5f, y = static_cast<float>(ty * kTile) + 0.5f;
  std::array<float, kPlanes> base;
  float nearest = kInfinity;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    base[p] = (polygon.at[p] + x * polygon.across[p]) + y * polygon.down[p];
    nearest = std::min(nearest, base[p] + planes.most[p]);
  }
  const std::size_t flat = std::size_t{ty} * tiles.stride + tx;
  if (nearest <= tiles.farthest[flat]) return;
  const std::size_t tile = std::size_t{ty} * tiles.columns + tx;
  if (tiles.covered[tile] == 0) touch(tiles, tx, ty);
  const std::uint64_t covered = tiles.covered[tile] |= pixels;
  tiles.nearest[flat] = std::max(tiles.nearest[flat], nearest + std::fabs(nearest) * 1e-6f);
  float* HWY_RESTRICT out = &tiles.nearness[tile * 64];
  VF least = hn::Set(f, kInfinity);
  for (std::size_t two_rows = 0; two_rows < 4; ++two_rows) {
    for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
      VF depth = hn::Set(f, kInfinity);
      for (std::size_t p = 0; p < kPlanes; ++p) {
        const float start = base[p] + static_cast<float>(2 * two_rows) * polygon.down[p];
        depth = hn::Min(depth, hn::Add(hn::Set(f, start), hn::Load(f, &planes.offset[p][i])));
      }
      const std::size_t at = 16 * two_rows + i;
      const VF old = hn::Load(f, out + at);
      const VF now = hn::IfThenElse(pixels_at(pixels, at), hn::Max(old, depth), old);
      hn::Store(now, f, out + at);
      least = hn::Min(least, now);
    }
  }
  if (covered == ~std::uint64_t{0}) tiles.farthest[flat] = hn::GetLane(hn::MinOfLanes(f, least));
}

// Eight scanlines' spans as columns [begin, end), empty where nothing is covered.
struct Spans {
  alignas(16) std::array<std::int16_t, 8> begin, end;
};

HWY_INLINE Spans spans_of(const Convex& polygon, float first_y, float width) {
  const Row f;
  const hn::RebindToSigned<Row> i32;
  const hn::Rebind<std::int16_t, Row> i16;
  Spans out;
  for (std::size_t i = 0; i < 8; i += hn::Lanes(f)) {
    const auto y = hn::Add(hn::Set(f, first_y), hn::Load(f, kColumn + i));
    auto left = hn::Set(f, polygon.left), right = hn::Set(f, polygon.right);
    for (std::size_t e = 0; e < polygon.left_edges; ++e) {
      left = hn::Max(left,
                     hn::Add(hn::Set(f, polygon.left_at[e]), hn::Mul(hn::Set(f, polygon.left_slope[e]), y)));
    }
    for (std::size_t e = 0; e < polygon.right_edges; ++e) {
      right = hn::Min(
          right, hn::Add(hn::Set(f, polygon.right_at[e]), hn::Mul(hn::Set(f, polygon.right_slope[e]), y)));
    }
    // Pixel centres at integers and a half, both borders included.
    const auto zero = hn::Zero(f), limit = hn::Set(f, width), half = hn::Set(f, 0.5f);
    const auto begin = hn::Min(hn::Max(hn::Ceil(hn::Sub(left, half)), zero), limit);
    auto end = hn::Min(hn::Max(hn::Floor(hn::Add(right, half)), zero), limit);
    const auto in_rows = hn::And(hn::Ge(y, hn::Set(f, polygon.top)), hn::Le(y, hn::Set(f, polygon.bottom)));
    end = hn::IfThenElse(hn::And(in_rows, hn::Gt(end, begin)), end, zero);
    const auto start = hn::IfThenElse(hn::Gt(end, zero), begin, hn::Set(f, 16384.0f));
    hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, start)), i16, &out.begin[i]);
    hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, end)), i16, &out.end[i]);
  }
  return out;
}

#if HWY_TARGET == HWY_SCALAR
std::uint64_t pixels_of(const Spans& spans, std::uint32_t x) {
  std::uint64_t pixels = 0;
  for (std::uint32_t row = 0; row < 8; ++row) {
    const auto column = [&](std::int16_t at) { return std::clamp(at - static_cast<int>(x), 0, 8); };
    const std::uint32_t from = 0xffu << column(spans.begin[row]) & 0xff,
                        beyond = 0xffu << column(spans.end[row]);
    pixels |= std::uint64_t{from & ~beyond} << (8 * row);
  }
  return pixels;
}

std::uint32_t first_column(const Spans& spans) {
  return static_cast<std::uint32_t>(*std::min_element(spans.begin.begin(), spans.begin.end()));
}
std::uint32_t end_column(const Spans& spans) {
  return static_cast<std::uint32_t>(*std::max_element(spans.end.begin(), spans.end.end()));
}
#else
// A byte a scanline of the tile that starts at column x, a bit a pixel.
HWY_INLINE std::uint64_t pixels_of(const Spans& spans, std::uint32_t x) {
  const hn::FixedTag<std::int16_t, 8> i16;
  const hn::FixedTag<std::uint8_t, 8> half;
  const hn::FixedTag<std::uint8_t, 16> u8;
  // The bits from a column on.
  alignas(16) static constexpr std::uint8_t kFrom[16] = {0xff, 0xfe, 0xfc, 0xf8, 0xf0, 0xe0, 0xc0, 0x80, 0};
  const auto at = hn::Set(i16, static_cast<std::int16_t>(x)), zero = hn::Zero(i16), eight = hn::Set(i16, 8);
  const auto clamp = [&](const std::int16_t* columns) HWY_ATTR {
    return hn::DemoteTo(half, hn::Min(hn::Max(hn::Sub(hn::Load(i16, columns), at), zero), eight));
  };
  const auto both = hn::Combine(u8, clamp(spans.end.data()), clamp(spans.begin.data()));
  alignas(16) std::uint64_t bits[2];
  hn::Store(hn::TableLookupBytes(hn::Load(u8, kFrom), both), u8, reinterpret_cast<std::uint8_t*>(bits));
  return bits[0] & ~bits[1];
}

HWY_INLINE std::uint32_t first_column(const Spans& spans) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(i16, hn::Load(i16, spans.begin.data()))));
}
HWY_INLINE std::uint32_t end_column(const Spans& spans) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(i16, hn::Load(i16, spans.end.data()))));
}
#endif

template <std::size_t kPlanes>
HWY_INLINE void draw_with_planes(DepthTiles& tiles, const Convex& polygon, float top, float bottom) {
  const TilePlanes planes = tile_planes(polygon);
  const auto first = static_cast<std::uint32_t>(top) / kTile,
             last = static_cast<std::uint32_t>(bottom) / kTile;
  for (std::uint32_t ty = first; ty <= last; ++ty) {
    const Spans spans =
        spans_of(polygon, static_cast<float>(ty * kTile) + 0.5f, static_cast<float>(tiles.width));
    const std::uint32_t begin = first_column(spans), end = end_column(spans);
    for (std::uint32_t x = begin & ~(kTile - 1); x < end; x += kTile) {
      const std::uint64_t pixels = pixels_of(spans, x);
      if (pixels != 0) update_tile<kPlanes>(tiles, polygon, planes, x / kTile, ty, pixels);
    }
  }
}

void draw_polygon(DepthTiles& tiles, const Convex& polygon) {
  const float top = std::max(polygon.top, 0.5f),
              bottom = std::min(polygon.bottom, static_cast<float>(tiles.height) - 0.5f);
  if (!(top <= bottom) || polygon.left_edges == 0 || polygon.right_edges == 0) return;
  if (polygon.planes == 1) return draw_with_planes<1>(tiles, polygon, top, bottom);
  if (polygon.planes == 2) return draw_with_planes<2>(tiles, polygon, top, bottom);
  draw_with_planes<3>(tiles, polygon, top, bottom);
}

// Whether each pixel centre of the columns and rows, last ones included, has an occluder nearer than
// `nearness`.
HWY_INLINE bool hidden(const DepthTiles& tiles, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1,
                       std::uint32_t y1, float nearness) {
  const F f;
  const std::uint32_t tx0 = x0 / kTile, tx1 = x1 / kTile;
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = y0 / kTile; ty <= y1 / kTile; ++ty) {
    const float* row = &tiles.farthest[std::size_t{ty} * tiles.stride];
    for (std::uint32_t tx = tx0; tx <= tx1; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
      auto open = hn::Le(hn::LoadU(f, row + tx), limit);
      open = hn::And(open, hn::FirstN(f, tx1 - tx + 1));
      if (hn::AllFalse(f, open)) continue;
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(f, open, bytes);
      std::uint32_t bits;
      std::memcpy(&bits, bytes, sizeof bits);
      for (; bits != 0; bits &= bits - 1) {
        const std::uint32_t t = tx + static_cast<std::uint32_t>(std::countr_zero(bits));
        const std::size_t tile = std::size_t{ty} * tiles.columns + t;
        if (nearness > tiles.nearest[std::size_t{ty} * tiles.stride + t]) return false;
        // The rectangle's pixels within the tile.
        const std::uint32_t left = std::max(x0, t * kTile) - t * kTile,
                            right = std::min(x1, t * kTile + 7) - t * kTile;
        const std::uint32_t low = std::max(y0, ty * kTile) - ty * kTile,
                            high = std::min(y1, ty * kTile + 7) - ty * kTile;
        const std::uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left);
        const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - high))) & (~std::uint64_t{0} << (8 * low));
        const std::uint64_t wanted = columns * 0x0101010101010101u & rows;
        if ((wanted & ~tiles.covered[tile]) != 0) return false;
        const float* depth = &tiles.nearness[tile * 64];
        for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
          const auto seen = hn::And(hn::Le(hn::Load(f, depth + i), limit), pixels_at(wanted, i));
          if (!hn::AllFalse(f, seen)) return false;
        }
      }
    }
  }
  return true;
}

// The same by whole tiles, and surely: false where a tile would need a closer look.
HWY_INLINE bool hidden_tiles(const DepthTiles& tiles, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1,
                             std::uint32_t y1, float nearness) {
  const F f;
  const std::uint32_t tx0 = x0 / kTile, tx1 = x1 / kTile;
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = y0 / kTile; ty <= y1 / kTile; ++ty) {
    const float* row = &tiles.farthest[std::size_t{ty} * tiles.stride];
    for (std::uint32_t tx = tx0; tx <= tx1; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
      const auto open = hn::Lt(hn::LoadU(f, row + tx), limit);
      if (!hn::AllFalse(f, hn::And(open, hn::FirstN(f, tx1 - tx + 1)))) return false;
    }
  }
  return true;
}

// A vector of boxes, projected: corner c of box i stands at [c][i].
struct ProjectedBoxes {
  alignas(64) std::array<std::array<float, 16>, 6> sides;  // about the eye
  alignas(64) std::array<std::array<float, 16>, 8> x, y;
  alignas(64) std::array<float, 16> clearance, left, right, top, bottom, nearest;
};

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
    const auto dot = [&](const Vec4& row) HWY_ATTR {
      return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(f, row.x), qx), hn::Mul(hn::Set(f, row.y), qy)),
                             hn::Mul(hn::Set(f, row.z), qz)),
                     hn::Set(f, row.w));
    };
    clear = hn::Min(clear, dot(tiles.rays.near_plane));
    const VF over_w = hn::Div(hn::Set(f, 1.0f), dot(e.w));
    const VF x = hn::Mul(dot(e.x), over_w), y = hn::Mul(dot(e.y), over_w);
    nearest = hn::Max(nearest, e.orthographic ? dot(e.nearness) : over_w);
    left = hn::Min(left, x), right = hn::Max(right, x), top = hn::Min(top, y), bottom = hn::Max(bottom, y);
    hn::Store(x, f, out.x[c].data());
    hn::Store(y, f, out.y[c].data());
  }
  hn::Store(clear, f, out.clearance.data());
  hn::Store(nearest, f, out.nearest.data());
  hn::Store(left, f, out.left.data());
  hn::Store(right, f, out.right.data());
  hn::Store(top, f, out.top.data());
  hn::Store(bottom, f, out.bottom.data());
}

// The faces of box i that surely look at the eye, and their planes.
HWY_INLINE std::uint32_t add_faces(const DepthTiles& tiles, const ProjectedBoxes& boxes, std::size_t i,
                                   Convex& polygon) {
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  std::uint32_t faces = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const float low = boxes.sides[a][i], high = boxes.sides[a + 3][i];
    const float margin = 1e-6f + 1e-5f * std::max(std::fabs(low), std::fabs(high));
    const bool down = orthographic ? rays.forward[a] > 1e-5f : low > margin;
    const bool up = orthographic ? rays.forward[a] < -1e-5f : high < -margin;
    // Without branches: which faces look at the eye is anyone's guess.
    faces |= (std::uint32_t{down} | std::uint32_t{up} << 1) << (2 * a);
    const float at = down ? low : high;
    const float scale = 1 / (orthographic ? rays.forward[a] : at);
    const std::size_t p = polygon.planes;
    polygon.across[p] = rays.across[a] * scale;
    polygon.down[p] = rays.down[a] * scale;
    polygon.at[p] = (orthographic ? rays.at[a] - at : rays.at[a]) * scale;
    move_back(polygon, p, boxes.nearest[i]);
    polygon.planes += down | up;
  }
  return faces;
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
      const auto column = [&](float x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0f, width - 1)); };
      const auto row = [&](float y) { return static_cast<std::uint32_t>(std::clamp(y, 0.0f, height - 1)); };
      if (hidden_tiles(tiles, column(x0), row(y0), column(x1), row(y1), b.nearest[i])) continue;

      Convex polygon;
      const std::uint32_t faces = add_faces(tiles, b, i, polygon);
      const float farthest_out =
          std::max(std::max(std::fabs(x0), std::fabs(x1)), std::max(std::fabs(y0), std::fabs(y1)));
      const float inset = kInset + kInsetGrowth * farthest_out;
      polygon.left = polygon.top = kInfinity;
      polygon.right = polygon.bottom = -kInfinity;
      for (std::uint32_t k = 0; k < kOutlines.count[faces]; ++k) {
        const std::uint8_t from = kOutlines.from[faces][k], to = kOutlines.to[faces][k];
        const float ax = b.x[from][i], ay = b.y[from][i], bx = b.x[to][i], by = b.y[to][i];
        add_edge(polygon, ax, ay, bx, by, (by > ay) == tiles.rays.turns_right, inset);
        polygon.left = std::min(polygon.left, ax), polygon.right = std::max(polygon.right, ax);
        polygon.top = std::min(polygon.top, ay), polygon.bottom = std::max(polygon.bottom, ay);
      }
      polygon.left += inset, polygon.right -= inset, polygon.top += inset, polygon.bottom -= inset;
      draw_polygon(tiles, polygon);
    }
  }
}

// Boxes a vector at a time: rectangles and nearest depths; then each against the tiles.
void query_all_boxes(const DepthTiles& tiles, const EyeProjection& e, const BoxSpan& boxes,
                     std::uint8_t* visible) {
  const F f;
  const hn::RebindToSigned<F> i32;
  const std::size_t lanes = hn::Lanes(f);
  const VF half = hn::Set(f, 0.5f), zero = hn::Zero(f);
  alignas(64) std::array<std::int32_t, 16> x0, y0, x1, y1;
  alignas(64) std::array<float, 16> near;
  for (std::size_t first = 0; first < boxes.count; first += lanes) {
    // The last vector repeats boxes rather than reading beyond them.
    alignas(64) std::array<std::array<float, 16>, 6> tail;
    const std::size_t count = std::min(lanes, boxes.count - first);
    const float* from[6] = {boxes.min_x + first, boxes.min_y + first, boxes.min_z + first,
                            boxes.max_x + first, boxes.max_y + first, boxes.max_z + first};
    if (count < lanes) {
      for (std::size_t side = 0; side < 6; ++side) {
        for (std::size_t i = 0; i < lanes; ++i) tail[side][i] = from[side][std::min(i, count - 1)];
        from[side] = tail[side].data();
      }
    }
    const auto about_eye = [&](std::size_t side, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(hn::LoadU(f, from[side]), hn::Set(f, high)), hn::Set(f, low));
    };
    const VF q[2][3] = {{about_eye(0, e.eye_high.x, e.eye_low.x), about_eye(1, e.eye_high.y, e.eye_low.y),
                         about_eye(2, e.eye_high.z, e.eye_low.z)},
                        {about_eye(3, e.eye_high.x, e.eye_low.x), about_eye(4, e.eye_high.y, e.eye_low.y),
                         about_eye(5, e.eye_high.z, e.eye_low.z)}};
    const VF reach_x = hn::Max(hn::Abs(q[0][0]), hn::Abs(q[1][0])),
             reach_y = hn::Max(hn::Abs(q[0][1]), hn::Abs(q[1][1])),
             reach_z = hn::Max(hn::Abs(q[0][2]), hn::Abs(q[1][2]));
    // The products of a row, and what rounding them, their sum and the row itself can lose.
    struct Terms {
      VF x[2], y[2], z[2], error;
    };
    constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
    const auto terms = [&](const Vec4& row) HWY_ATTR {
      Terms t;
      for (int s = 0; s < 2; ++s) {
        t.x[s] = hn::Add(hn::Mul(hn::Set(f, row.x), q[s][0]), hn::Set(f, row.w));
        t.y[s] = hn::Mul(hn::Set(f, row.y), q[s][1]);
        t.z[s] = hn::Mul(hn::Set(f, row.z), q[s][2]);
      }
      const VF magnitude =
          hn::Add(hn::Add(hn::Mul(hn::Set(f, std::fabs(row.x)), reach_x),
                          hn::Mul(hn::Set(f, std::fabs(row.y)), reach_y)),
                  hn::Add(hn::Mul(hn::Set(f, std::fabs(row.z)), reach_z), hn::Set(f, std::fabs(row.w))));
      t.error = hn::Mul(hn::Set(f, kRounding), magnitude);
      return t;
    };
    const Terms tx = terms(e.x), ty = terms(e.y), tw = terms(e.w);
    VF left = hn::Set(f, kInfinity), top = left, least_w = left;
    VF right = hn::Set(f, -kInfinity), bottom = right;
    for (int k = 0; k < 8; ++k) {
      const auto sum = [&](const Terms& t)
                           HWY_ATTR { return hn::Add(hn::Add(t.x[k & 1], t.y[k >> 1 & 1]), t.z[k >> 2]); };
      const VF w = sum(tw);
      const VF over_w = hn::Div(hn::Set(f, 1.0f), w);
      const VF x = hn::Mul(sum(tx), over_w), y = hn::Mul(sum(ty), over_w);
      least_w = hn::Min(least_w, w);
      left = hn::Min(left, x), right = hn::Max(right, x), top = hn::Min(top, y), bottom = hn::Max(bottom, y);
    }
    const auto before = hn::Gt(least_w, hn::Add(tw.error, tw.error));
    const VF over_least = hn::Div(hn::Set(f, 1.0f), hn::Sub(least_w, tw.error));
    const VF widest = hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
    // The second term covers the pixel mapping's own rounding and a rasteriser's 8-bit subpixel grid.
    const VF slack =
        hn::Add(hn::Mul(hn::Add(hn::Max(tx.error, ty.error), hn::Mul(widest, tw.error)), over_least),
                hn::Set(f, 1.0f / 128));
    VF nearest = hn::Mul(over_least, hn::Set(f, 1 + 1e-6f));
    if (e.orthographic) {
      const Terms tn = terms(e.nearness);
      nearest = hn::Add(hn::Add(hn::Max(tn.x[0], tn.x[1]), hn::Max(tn.y[0], tn.y[1])),
                        hn::Add(hn::Max(tn.z[0], tn.z[1]), tn.error));
    }
    const auto columns = hn::Set(f, static_cast<float>(tiles.width)),
               lines = hn::Set(f, static_cast<float>(tiles.height));
    const auto to_int = [&](VF v, VF limit) HWY_ATTR {
      return hn::ConvertTo(i32, hn::Min(hn::Max(v, hn::Set(f, -1.0f)), limit));
    };
    // Pixel centres c with low <= c <= high, as columns [begin, last].
    hn::Store(to_int(hn::Ceil(hn::Sub(hn::Max(hn::Sub(left, slack), zero), half)), columns), i32, x0.data());
    hn::Store(to_int(hn::Ceil(hn::Sub(hn::Max(hn::Sub(top, slack), zero), half)), lines), i32, y0.data());
    hn::Store(to_int(hn::Floor(hn::Sub(hn::Min(hn::Add(right, slack), columns), half)), columns), i32,
              x1.data());
    hn::Store(to_int(hn::Floor(hn::Sub(hn::Min(hn::Add(bottom, slack), lines), half)), lines), i32,
              y1.data());
    hn::Store(hn::IfThenElse(before, nearest, hn::Set(f, kInfinity)), f, near.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (!(near[i] < kInfinity)) {  // on or behind the eye's plane, or beyond numbers
        visible[first + i] = 1;
        continue;
      }
      const bool covers = x0[i] <= x1[i] && y0[i] <= y1[i];
      visible[first + i] =
          covers && !hidden(tiles, static_cast<std::uint32_t>(x0[i]), static_cast<std::uint32_t>(y0[i]),
                            static_cast<std::uint32_t>(x1[i]), static_cast<std::uint32_t>(y1[i]), near[i]);
    }
  }
}

// Moves points to the eye and projects them.
void project_points(const EyeProjection& e, std::span<const Vec3> points, DepthTiles& out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float x = (points[i].x - e.eye_high.x) - e.eye_low.x,
                y = (points[i].y - e.eye_high.y) - e.eye_low.y,
                z = (points[i].z - e.eye_high.z) - e.eye_low.z;
    const auto dot = [&](const Vec4& r) { return ((r.x * x + r.y * y) + r.z * z) + r.w; };
    const float over_w = 1 / dot(e.w);
    out.eye_x[i] = x, out.eye_y[i] = y, out.eye_z[i] = z;
    out.screen_x[i] = dot(e.x) * over_w, out.screen_y[i] = dot(e.y) * over_w;
    out.screen_near[i] = e.orthographic ? dot(e.nearness) : over_w;
    out.clearance[i] = dot(out.rays.near_plane);
  }
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::culling {
HWY_EXPORT(draw_polygon);
HWY_EXPORT(draw_all_boxes);
HWY_EXPORT(query_all_boxes);
HWY_EXPORT(project_points);

void draw_convex(DepthTiles& tiles, const Convex& polygon) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_polygon)(tiles, polygon);
}

void draw_boxes(DepthTiles& tiles, std::span<const Box> boxes) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_all_boxes)(tiles, boxes);
}

void query_boxes(const DepthTiles& tiles, const EyeProjection& projection, const BoxSpan& boxes,
                 std::uint8_t* visible) noexcept {
  HWY_DYNAMIC_DISPATCH(query_all_boxes)(tiles, projection, boxes, visible);
}

void project(const EyeProjection& projection, std::span<const Vec3> points, DepthTiles& out) noexcept {
  HWY_DYNAMIC_DISPATCH(project_points)(projection, points, out);
}

}  // namespace sightline::culling
#endif
