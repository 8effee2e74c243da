// Which pixels of the tiles a polygon covers, scanline by scanline, for every SIMD width. Included by files
// that foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_SPANS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_SPANS_INL
#undef SIGHTLINE_OCCLUSION_SPANS_INL
#else
#define SIGHTLINE_OCCLUSION_SPANS_INL
#endif

#include <algorithm>
#include <cmath>

#include "library/occlusion/convex.hpp"
#include "library/occlusion/image-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

alignas(64) constexpr float kLine[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Tiles [begin_x, end_x) × [begin_y, end_y).
struct TileRange {
  std::uint32_t begin_x, end_x, begin_y, end_y;
};

// The tiles that hold the pixel centres of a rectangle, in pixels; none where there is no such centre.
HWY_INLINE TileRange tiles_of(const DepthTiles& tiles, float left, float right, float top, float bottom) {
  const auto first = [](float low, std::uint32_t least) {
    return std::ceil(std::max(low, static_cast<float>(least) + 0.5f) - 0.5f);
  };
  const auto last = [](float high, std::uint32_t end) {
    return std::floor(std::min(high, static_cast<float>(end) - 0.5f) - 0.5f);
  };
  const float x0 = first(left, 0), x1 = last(right, tiles.width), y0 = first(top, tiles.first_row),
              y1 = last(bottom, tiles.end_row);
  if (!(x0 <= x1 && y0 <= y1)) return {};
  return {static_cast<std::uint32_t>(x0) / kTile, static_cast<std::uint32_t>(x1) / kTile + 1,
          static_cast<std::uint32_t>(y0) / kTile, static_cast<std::uint32_t>(y1) / kTile + 1};
}

// The spans of the scanlines of two rows of tiles as columns [begin, end); nothing where begin >= end.
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
  const auto end = hn::Min(hn::Max(hn::Floor(hn::Add(right, half)), zero), limit);
  // Where there is no row the span begins behind all others.
  const auto start = hn::IfThenElse(in_rows, begin, hn::Set(f, 16384.0f));
  hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, start)), i16, &out.begin[i]);
  hn::Store(hn::DemoteTo(i16, hn::ConvertTo(i32, hn::IfThenElseZero(in_rows, end))), i16, &out.end[i]);
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

// The same of a band.
HWY_INLINE Spans spans_of(const Bands& bands, std::size_t i, float first_y, float width) {
  const F f;
  Spans out;
  const VF at = hn::Set(f, bands.at[i]), slope = hn::Set(f, bands.slope[i]), half = hn::Set(f, bands.half[i]);
  for (std::size_t line = 0; line < 2 * kTile; line += hn::Lanes(f)) {
    const VF y = hn::Add(hn::Set(f, first_y), hn::Load(f, kLine + line));
    const VF middle = hn::Add(at, hn::Mul(slope, y));
    store_spans(hn::Max(hn::Set(f, bands.left[i]), hn::Sub(middle, half)),
                hn::Min(hn::Set(f, bands.right[i]), hn::Add(middle, half)),
                hn::And(hn::Ge(y, hn::Set(f, bands.top[i])), hn::Le(y, hn::Set(f, bands.bottom[i]))), width,
                line, out);
  }
  return out;
}

// The same of outline i among many, a lane each, whose every edge bounds it on either side.
template <std::size_t kEdges, class Outlines>
HWY_INLINE Spans spans_of(const Outlines& of, std::size_t i, float first_y, float width) {
  const F f;
  Spans out;
  for (std::size_t line = 0; line < 2 * kTile; line += hn::Lanes(f)) {
    const VF y = hn::Add(hn::Set(f, first_y), hn::Load(f, kLine + line));
    VF left = hn::Set(f, of.left[i]), right = hn::Set(f, of.right[i]);
    for (std::size_t e = 0; e < kEdges; ++e) {
      const VF along = hn::Mul(hn::Set(f, of.slope[e][i]), y);
      left = hn::Max(left, hn::Add(hn::Set(f, of.left_at[e][i]), along));
      right = hn::Min(right, hn::Add(hn::Set(f, of.right_at[e][i]), along));
    }
    store_spans(left, right, hn::And(hn::Ge(y, hn::Set(f, of.top[i])), hn::Le(y, hn::Set(f, of.bottom[i]))),
                width, line, out);
  }
  return out;
}

// The columns that the spans of a tile's scanlines hold, and those from which on and up to which all hold
// them; and of the tile that starts at column x the pixels,
// a byte a scanline, a bit a pixel.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE std::uint32_t first_column(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::min_element(&spans.begin[line], &spans.begin[line] + kTile));
}
HWY_INLINE std::uint32_t end_column(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::max_element(&spans.end[line], &spans.end[line] + kTile));
}
HWY_INLINE std::uint32_t last_begin(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::max_element(&spans.begin[line], &spans.begin[line] + kTile));
}
HWY_INLINE std::uint32_t first_end(const Spans& spans, std::size_t line) {
  return static_cast<std::uint32_t>(*std::min_element(&spans.end[line], &spans.end[line] + kTile));
}
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
#else
HWY_INLINE std::uint32_t first_column(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(i16, hn::Load(i16, &spans.begin[line]))));
}
HWY_INLINE std::uint32_t end_column(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(i16, hn::Load(i16, &spans.end[line]))));
}
HWY_INLINE std::uint32_t last_begin(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(i16, hn::Load(i16, &spans.begin[line]))));
}
HWY_INLINE std::uint32_t first_end(const Spans& spans, std::size_t line) {
  const hn::FixedTag<std::int16_t, 8> i16;
  return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(i16, hn::Load(i16, &spans.end[line]))));
}
HWY_INLINE std::uint64_t pixels_of(const Spans& spans, std::size_t line, std::uint32_t x) {
  const hn::FixedTag<std::int16_t, 8> i16;
  const hn::FixedTag<std::uint8_t, 8> half;
  const hn::FixedTag<std::uint8_t, 16> u8;
  // The bits from a column on.
  alignas(16) static constexpr std::uint8_t kFrom[16] = {0xff, 0xfe, 0xfc, 0xf8, 0xf0, 0xe0, 0xc0, 0x80, 0};
  const auto at = hn::Set(i16, static_cast<std::int16_t>(x));
  const auto column = [&](const std::int16_t* columns)
                          HWY_ATTR { return hn::DemoteTo(half, hn::Sub(hn::Load(i16, columns), at)); };
  const auto both =
      hn::Min(hn::Combine(u8, column(&spans.end[line]), column(&spans.begin[line])), hn::Set(u8, 8));
  alignas(16) std::uint64_t bits[2];
  hn::Store(hn::TableLookupBytes(hn::Load(u8, kFrom), both), u8, reinterpret_cast<std::uint8_t*>(bits));
  return bits[0] & ~bits[1];
}
#endif

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
