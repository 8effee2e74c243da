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

  [[nodiscard]] std::uint32_t count() const { return (end_x - begin_x) * (end_y - begin_y); }
};

// The tiles that hold the pixel centres of a rectangle, in pixels; none where there is no such centre.
SIGHTLINE_INLINE_IN_BOTH TileRange tiles_of(const DepthTiles& tiles, float left, float right, float top,
                                            float bottom) {
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

// Narrows spans to an edge, as Convex has it.
HWY_INLINE void narrow(VF y, float slope, float left_at, float right_at, VF& left, VF& right) {
  const F f;
  const VF along = hn::Mul(hn::Set(f, slope), y);
  left = hn::Max(left, hn::Add(hn::Set(f, left_at), along));
  right = hn::Min(right, hn::Add(hn::Set(f, right_at), along));
}

// Narrows spans to edges of which each bounds its own lines alone.
HWY_INLINE void narrow_by_lines(VF y, const Convex& polygon, VF& left, VF& right) {
  const F f;
  for (std::size_t e = 0; e < polygon.edges; ++e) {
    VF its_left = left, its_right = right;
    narrow(y, polygon.slope[e], polygon.left_at[e], polygon.right_at[e], its_left, its_right);
    const auto its = hn::And(hn::Ge(y, hn::Set(f, polygon.from[e])), hn::Le(y, hn::Set(f, polygon.to[e])));
    left = hn::IfThenElse(its, its_left, left), right = hn::IfThenElse(its, its_right, right);
  }
}

HWY_INLINE Spans spans_of(const Convex& polygon, float first_y, float width) {
  const F f;
  Spans out;
  for (std::size_t i = 0; i < 2 * kTile; i += hn::Lanes(f)) {
    const auto y = hn::Add(hn::Set(f, first_y), hn::Load(f, kLine + i));
    auto left = hn::Set(f, polygon.left), right = hn::Set(f, polygon.right);
    if (polygon.by_lines) {
      narrow_by_lines(y, polygon, left, right);
    } else {
      for (std::size_t e = 0; e < polygon.edges; ++e)
        narrow(y, polygon.slope[e], polygon.left_at[e], polygon.right_at[e], left, right);
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
    for (std::size_t e = 0; e < kEdges; ++e)
      narrow(y, of.slope[e][i], of.left_at[e][i], of.right_at[e][i], left, right);
    store_spans(left, right, hn::And(hn::Ge(y, hn::Set(f, of.top[i])), hn::Le(y, hn::Set(f, of.bottom[i]))),
                width, line, out);
  }
  return out;
}

// Columns of tiles that the spans hold, and of those the columns that all of them hold whole, if any.
struct TileColumns {
  std::uint32_t begin, end;
  std::uint32_t begin_whole = 0, end_whole = 0;
};

// Of tiles, a bit each: whether some, whether all of their pixels are set.
struct Held {
  std::uint32_t some = 0, all = 0;
};

// The tiles whose pixels fit a vector, a word each: a byte a scanline, a bit a pixel.
#if HWY_TARGET == HWY_SCALAR
using Words = hn::Rebind<std::uint64_t, F>;
#else
using Words = hn::Repartition<std::uint64_t, hn::CappedTag<std::uint8_t, 64> >;
#endif
constexpr std::size_t kWords = hn::MaxLanes(Words());

HWY_INLINE void add_held(hn::Vec<Words> pixels, std::size_t tile, Held& out) {
  const Words words;
  if constexpr (kWords == 1) {
    const std::uint64_t its = hn::GetLane(pixels);
    out.some |= std::uint32_t{its != 0} << tile, out.all |= std::uint32_t{its == ~std::uint64_t{0}} << tile;
    return;
  }
  out.some |= bits_of(words, hn::Ne(pixels, hn::Zero(words))) << tile;
  out.all |= bits_of(words, hn::Eq(pixels, hn::Set(words, ~std::uint64_t{0}))) << tile;
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE TileColumns columns_of(const Spans& spans) {
  const auto begin = std::min_element(spans.begin.begin(), spans.begin.end());
  const auto end = std::max_element(spans.end.begin(), spans.end.end());
  const auto last_begin = std::max_element(spans.begin.begin(), spans.begin.end());
  const auto first_end = std::min_element(spans.end.begin(), spans.end.end());
  return {static_cast<std::uint32_t>(*begin) / kTile, (static_cast<std::uint32_t>(*end) + kTile - 1) / kTile,
          (static_cast<std::uint32_t>(*last_begin) + kTile - 1) / kTile,
          static_cast<std::uint32_t>(*first_end) / kTile};
}
#else
SIGHTLINE_INLINE_IN_BOTH TileColumns columns_of(const Spans& spans) {
  const hn::FixedTag<std::int16_t, 8> i16;
  const auto begin = hn::Load(i16, &spans.begin[0]), more_begin = hn::Load(i16, &spans.begin[8]),
             end = hn::Load(i16, &spans.end[0]), more_end = hn::Load(i16, &spans.end[8]);
  const auto least = [&](auto p, auto q) HWY_ATTR {
    return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(i16, hn::Min(p, q))));
  };
  const auto most = [&](auto p, auto q) HWY_ATTR {
    return static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(i16, hn::Max(p, q))));
  };
  return {least(begin, more_begin) / kTile, (most(end, more_end) + kTile - 1) / kTile,
          (most(begin, more_begin) + kTile - 1) / kTile, least(end, more_end) / kTile};
}
#endif

// The pixels of `count` tiles of a row from column x on, of the eight spans from `line` on. Writes whole
// vectors, and says something of their last tiles, too.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Held store_pixels(const Spans& spans, std::size_t line, std::uint32_t x, std::size_t count,
                             std::uint64_t* HWY_RESTRICT out) {
  Held held;
  for (std::size_t tile = 0; tile < count; ++tile) {
    const int first = static_cast<int>(x + tile * kTile);
    out[tile] = 0;
    for (std::uint32_t row = 0; row < kTile; ++row) {
      const auto column = [&](std::int16_t at) { return std::clamp(at - first, 0, 8); };
      const std::uint32_t from = 0xffu << column(spans.begin[line + row]) & 0xff,
                          beyond = 0xffu << column(spans.end[line + row]);
      out[tile] |= std::uint64_t{from & ~beyond} << (8 * row);
    }
    add_held(hn::Set(Words(), out[tile]), tile, held);
  }
  return held;
}
#else
// Of eight scanlines a byte each, how far beyond column x they lie, at every tile of a vector.
HWY_INLINE hn::Vec<Words> columns_from(const std::int16_t* columns, std::uint32_t x) {
  const hn::FixedTag<std::int16_t, 8> i16;
  const hn::Rebind<std::uint8_t, decltype(i16)> u8;
  const auto beyond = hn::Sub(hn::Load(i16, columns), hn::Set(i16, static_cast<std::int16_t>(x)));
  const hn::Repartition<std::uint64_t, decltype(u8)> word;
  return hn::Set(Words(), hn::GetLane(hn::BitCast(word, hn::DemoteTo(u8, beyond))));
}

HWY_INLINE Held store_pixels(const Spans& spans, std::size_t line, std::uint32_t x, std::size_t count,
                             std::uint64_t* HWY_RESTRICT out) {
  const Words words;
  const hn::Repartition<std::uint8_t, Words> u8;
  // The bits from a column on.
  alignas(16) static constexpr std::uint8_t kFrom[16] = {0xff, 0xfe, 0xfc, 0xf8, 0xf0, 0xe0, 0xc0, 0x80, 0};
  // The columns at which tiles begin, eight lanes a tile.
  constexpr std::uint64_t kEach = 0x0101010101010101u * kTile;
  alignas(64) static constexpr std::uint64_t kFirst[8] = {0,         kEach,     2 * kEach, 3 * kEach,
                                                          4 * kEach, 5 * kEach, 6 * kEach, 7 * kEach};
  const auto begin = hn::BitCast(u8, columns_from(&spans.begin[line], x)),
             end = hn::BitCast(u8, columns_from(&spans.end[line], x));
  const auto from = hn::LoadDup128(u8, kFrom), tile_width = hn::Set(u8, kTile);
  Held held;
  for (std::size_t tile = 0; tile < count; tile += kWords) {
    const auto first = hn::BitCast(u8, hn::Load(words, kFirst + tile));
    const auto bits_from = [&](hn::Vec<decltype(u8)> column) HWY_ATTR {
      return hn::TableLookupBytes(from, hn::Min(hn::SaturatedSub(column, first), tile_width));
    };
    const auto pixels = hn::BitCast(words, hn::AndNot(bits_from(end), bits_from(begin)));
    hn::StoreU(pixels, words, out + tile);
    add_held(pixels, tile, held);
  }
  return held;
}
#endif

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
