// Convex polygons into the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_DEPTH_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_DEPTH_RASTER_INL
#undef SIGHTLINE_CULLING_DEPTH_RASTER_INL
#else
#define SIGHTLINE_CULLING_DEPTH_RASTER_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "culling/depth_tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using VF = hn::Vec<F>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
alignas(64) constexpr float kColumn[64] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5,
                                           6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3,
                                           4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
alignas(64) constexpr float kRow[64] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2,
                                        2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 5,
                                        5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7};

alignas(64) constexpr float kLine[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// A bit a lane, from the lowest.
HWY_INLINE std::uint32_t bits_of(hn::Mask<F> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(F(), mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((1u << hn::Lanes(F())) - 1);
}

// Bits i … i + lanes - 1 of a tile's pixels.
HWY_INLINE hn::Mask<F> pixels_at(std::uint64_t pixels, std::size_t i) {
  const std::uint64_t part = pixels >> i;
  std::uint8_t bytes[8];
  std::memcpy(bytes, &part, sizeof bytes);
  if (hn::Lanes(F()) < 8) bytes[0] &= (1u << hn::Lanes(F())) - 1;
  return hn::LoadMaskBits(F(), bytes);
}

// A tile's first touch: nothing there, and nothing to be waited for beyond the image.
HWY_INLINE void touch(DepthTiles& tiles, std::uint32_t tx, std::uint32_t ty) {
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

template <std::size_t kPlanes>
HWY_INLINE TilePlanes tile_planes(const Convex& polygon) {
  const F f;
  TilePlanes out;
  for (std::size_t p = 0; p < kPlanes; ++p) {
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
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    VF depth[kPlanes], step[kPlanes];
    for (std::size_t p = 0; p < kPlanes; ++p) {
      depth[p] = hn::Add(hn::Set(f, base[p]), hn::Load(f, &planes.offset[p][i]));
      step[p] = hn::Set(f, 2 * polygon.down[p]);
    }
    for (std::size_t at = i; at < 64; at += 16) {
      VF front = depth[0];
      for (std::size_t p = 1; p < kPlanes; ++p) front = hn::Min(front, depth[p]);
      for (std::size_t p = 0; p < kPlanes; ++p) depth[p] = hn::Add(depth[p], step[p]);
      const VF old = hn::Load(f, out + at);
      const VF now = hn::IfThenElse(pixels_at(pixels, at), hn::Max(old, front), old);
      hn::Store(now, f, out + at);
      least = hn::Min(least, now);
    }
  }
  if (covered == ~std::uint64_t{0}) tiles.farthest[flat] = hn::GetLane(hn::MinOfLanes(f, least));
}

// The spans of the scanlines of two rows of tiles as columns [begin, end), empty where nothing is covered.
struct Spans {
  alignas(32) std::array<std::int16_t, 2 * kTile> begin, end;
};

HWY_INLINE void store_spans(VF left, VF right, hn::Mask<F> in_rows, float width, std::size_t i, Spans& out) {
  const F f;
  const hn::RebindToSigned<F> i32;
  const hn::Rebind<std::int16_t, F> i16;
  // Pixel centres at integers and a half, both borders included.
  const auto zero = hn::Zero(f), limit = hn::Set(f, width), half = hn::Set(f, 0.5f);
  const auto begin = hn::Min(hn::Max(hn::Ceil(hn::Sub(left, half)), zero), limit);
  auto end = hn::Min(hn::Max(hn::Floor(hn::Add(right, half)), zero), limit);
  end = hn::IfThenElse(hn::And(in_rows, hn::Gt(end, begin)), end, zero);
  const auto start = hn::IfThenElse(hn::Gt(end, zero), begin, hn::Set(f, 16384.0f));
  hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, start)), i16, &out.begin[i]);
  hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, end)), i16, &out.end[i]);
}

HWY_INLINE Spans spans_of(const Convex& polygon, float first_y, float width) {
  const F f;
  Spans out;
  for (std::size_t i = 0; i < 2 * kTile; i += hn::Lanes(f)) {
    const auto y = hn::Add(hn::Set(f, first_y), hn::Load(f, kLine + i));
    auto left = hn::Set(f, polygon.left), right = hn::Set(f, polygon.right);
    for (std::size_t e = 0; e < polygon.left_edges; ++e) {
      left = hn::Max(left,
                     hn::Add(hn::Set(f, polygon.left_at[e]), hn::Mul(hn::Set(f, polygon.left_slope[e]), y)));
    }
    for (std::size_t e = 0; e < polygon.right_edges; ++e) {
      right = hn::Min(
          right, hn::Add(hn::Set(f, polygon.right_at[e]), hn::Mul(hn::Set(f, polygon.right_slope[e]), y)));
    }
    store_spans(left, right,
                hn::And(hn::Ge(y, hn::Set(f, polygon.top)), hn::Le(y, hn::Set(f, polygon.bottom))), width, i,
                out);
  }
  return out;
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE std::uint64_t pixels_of(const Spans& spans, std::size_t line, std::uint32_t x) {
  std::uint64_t pixels = 0;
  for (std::uint32_t row = 0; row < 8; ++row) {
    const auto column = [&](std::int16_t at) { return std::clamp(at - static_cast<int>(x), 0, 8); };
    const std::uint32_t from = 0xffu << column(spans.begin[line + row]) & 0xff,
                        beyond = 0xffu << column(spans.end[line + row]);
    pixels |= std::uint64_t{from & ~beyond} << (8 * row);
  }
  return pixels;
}

HWY_INLINE std::uint32_t first_column(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::min_element(&spans.begin[line], &spans.begin[line] + kTile));
}
HWY_INLINE std::uint32_t end_column(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::max_element(&spans.end[line], &spans.end[line] + kTile));
}
#else
// A byte a scanline of the tile that starts at column x, a bit a pixel.
HWY_INLINE std::uint64_t pixels_of(const Spans& spans, std::size_t line, std::uint32_t x) {
  const hn::FixedTag<std::int16_t, 8> i16;
  const hn::FixedTag<std::uint8_t, 8> half;
  const hn::FixedTag<std::uint8_t, 16> u8;
  // The bits from a column on.
  alignas(16) static constexpr std::uint8_t kFrom[16] = {0xff, 0xfe, 0xfc, 0xf8, 0xf0, 0xe0, 0xc0, 0x80, 0};
  const auto at = hn::Set(i16, static_cast<std::int16_t>(x)), zero = hn::Zero(i16), eight = hn::Set(i16, 8);
  const auto clamp = [&](const std::int16_t* columns) HWY_ATTR {
    return hn::DemoteTo(half, hn::Min(hn::Max(hn::Sub(hn::Load(i16, columns), at), zero), eight));
  };
  const auto both = hn::Combine(u8, clamp(&spans.end[line]), clamp(&spans.begin[line]));
  alignas(16) std::uint64_t bits[2];
  hn::Store(hn::TableLookupBytes(hn::Load(u8, kFrom), both), u8, reinterpret_cast<std::uint8_t*>(bits));
  return bits[0] & ~bits[1];
}

HWY_INLINE std::uint32_t first_column(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(i16, hn::Load(i16, &spans.begin[line]))));
}
HWY_INLINE std::uint32_t end_column(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(i16, hn::Load(i16, &spans.end[line]))));
}
#endif

// Rows top … bottom of what `spans_from` says of sixteen lines from a pixel centre on.
template <std::size_t kPlanes, class SpansFrom>
HWY_INLINE void draw_spans(DepthTiles& tiles, const Convex& polygon, float top, float bottom,
                           const SpansFrom& spans_from) {
  const TilePlanes planes = tile_planes<kPlanes>(polygon);
  const auto first = static_cast<std::uint32_t>(top) / kTile,
             last = static_cast<std::uint32_t>(bottom) / kTile;
  Spans spans;
  for (std::uint32_t ty = first; ty <= last; ++ty) {
    const std::size_t line = (ty - first) % 2 * kTile;
    if (line == 0) spans = spans_from(static_cast<float>(ty * kTile) + 0.5f);
    const std::uint32_t begin = first_column(spans, line), end = end_column(spans, line);
    for (std::uint32_t x = begin & ~(kTile - 1); x < end; x += kTile) {
      const std::uint64_t pixels = pixels_of(spans, line, x);
      if (pixels != 0) update_tile<kPlanes>(tiles, polygon, planes, x / kTile, ty, pixels);
    }
  }
}

template <std::size_t kPlanes>
HWY_INLINE void draw_with_planes(DepthTiles& tiles, const Convex& polygon, float top, float bottom) {
  draw_spans<kPlanes>(tiles, polygon, top, bottom, [&](float first_y) HWY_ATTR {
    return spans_of(polygon, first_y, static_cast<float>(tiles.width));
  });
}

HWY_INLINE void draw_polygon(DepthTiles& tiles, const Convex& polygon) {
  const float top = std::max(polygon.top, 0.5f),
              bottom = std::min(polygon.bottom, static_cast<float>(tiles.height) - 0.5f);
  if (!(top <= bottom) || polygon.left_edges == 0 || polygon.right_edges == 0) return;
  if (polygon.planes == 1) return draw_with_planes<1>(tiles, polygon, top, bottom);
  if (polygon.planes == 2) return draw_with_planes<2>(tiles, polygon, top, bottom);
  draw_with_planes<3>(tiles, polygon, top, bottom);
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
// The same for a rectangle of the image, in pixels.
HWY_INLINE bool hidden_rect(const DepthTiles& tiles, float x0, float y0, float x1, float y1, float nearness) {
  const float right = static_cast<float>(tiles.width) - 1, last = static_cast<float>(tiles.height) - 1;
  const auto within = [](float v, float most) {
    return static_cast<std::uint32_t>(v > 0 ? std::min(v, most) : 0.0f);  // 0 for what is not a number, too
  };
  return hidden_tiles(tiles, within(x0, right), within(y0, last), within(x1, right), within(y1, last),
                      nearness);
}

// A row of a projection times a vector of points about the eye.
HWY_INLINE VF dot_row(const Vec4& row, VF x, VF y, VF z) {
  const F f;
  return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(f, row.x), x), hn::Mul(hn::Set(f, row.y), y)),
                         hn::Mul(hn::Set(f, row.z), z)),
                 hn::Set(f, row.w));
}

// move_back() of a vector of planes.
HWY_INLINE VF moved_back(VF at, VF across, VF down, VF nearest) {
  const F f;
  const VF slant = hn::Mul(hn::Add(hn::Abs(across), hn::Abs(down)), hn::Set(f, 1.0f / 64));
  return hn::Sub(at, hn::Add(hn::Mul(hn::Set(f, 2e-5f), hn::Abs(nearest)), slant));
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
