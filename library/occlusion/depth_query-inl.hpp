// Rectangles of pixels against the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_DEPTH_QUERY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_DEPTH_QUERY_INL
#undef SIGHTLINE_OCCLUSION_DEPTH_QUERY_INL
#else
#define SIGHTLINE_OCCLUSION_DEPTH_QUERY_INL
#endif

#include <bit>

#include "library/geometry/mutant.h"
#include "library/occlusion/coarse_tiles-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Columns and rows of pixels, last ones included.
struct PixelRange {
  std::uint32_t x0, y0, x1, y1;
};

// The least nearness of the range's pixels within tile (tx, ty).
HWY_INLINE VF least_in_tile(const DepthTiles& tiles, const PixelRange& range, std::uint32_t tx,
                            std::uint32_t ty) {
  const F f;
  const std::uint32_t left = std::max(range.x0, tx * kTile) - tx * kTile,
                      right = std::min(range.x1, tx * kTile + 7) - tx * kTile;
  const std::uint32_t low = std::max(range.y0, ty * kTile) - ty * kTile,
                      high = std::min(range.y1, ty * kTile + 7) - ty * kTile;
  std::uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left);
  if (SIGHTLINE_MUTANT(last_column_not_asked) && right > left) columns &= 0xffu >> (8 - right);
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - high))) & (~std::uint64_t{0} << (8 * low));
  const std::uint64_t wanted = columns * 0x0101010101010101u & rows;
  alignas(64) std::array<float, 64> room;
  const float* depth = pixels_of_tile(tiles, std::size_t{ty} * tiles.stride + tx, room);
  VF least = hn::Set(f, kInfinity);
  for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
    least = hn::Min(least,
                    hn::IfThenElse(mask_of(f, wanted >> i), hn::Load(f, depth + i), hn::Set(f, kInfinity)));
  }
  return least;
}

// Whether each pixel of the range has an occluder nearer than `nearness`. Of a few tiles: all are looked at,
// for whether one shows the range is anyone's guess.
HWY_INLINE bool hidden_in_few(const DepthTiles& tiles, const PixelRange& range, float nearness) {
  const F f;
  VF least = hn::Set(f, kInfinity);
  for (std::uint32_t ty = range.y0 / kTile; ty <= range.y1 / kTile; ++ty) {
    for (std::uint32_t tx = range.x0 / kTile; tx <= range.x1 / kTile; ++tx)
      least = hn::Min(least, least_in_tile(tiles, range, tx, ty));
  }
  return hn::AllFalse(f, hn::Le(least, hn::Set(f, nearness)));
}

// The same of those in row ty of tiles, some of which do not lie nearer as a whole.
HWY_INLINE bool hidden_in_row(const DepthTiles& tiles, const PixelRange& range, std::uint32_t ty, VF limit) {
  const F f;
  const std::uint32_t tx0 = range.x0 / kTile, tx1 = range.x1 / kTile;
  const float* farthest = &tiles.farthest[std::size_t{ty} * tiles.stride];
  const float* nearest = &tiles.nearest[std::size_t{ty} * tiles.stride];
  for (std::uint32_t tx = tx0; tx <= tx1; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
    const auto wanted = hn::FirstN(f, tx1 - tx + 1);
    const auto open = hn::And(wanted, hn::Le(hn::LoadU(f, farthest + tx), limit));
    // A tile of which nothing lies nearer shows what stands there.
    if (!hn::AllFalse(f, hn::And(open, hn::Lt(hn::LoadU(f, nearest + tx), limit)))) return false;
    for (std::uint32_t bits = bits_of(f, open); bits != 0; bits &= bits - 1) {
      const std::uint32_t t = tx + static_cast<std::uint32_t>(std::countr_zero(bits));
      if (!hn::AllFalse(f, hn::Le(least_in_tile(tiles, range, t, ty), limit))) return false;
    }
  }
  return true;
}

// The same of many tiles: most of what is asked for is hidden, and most tiles lie nearer as a whole.
HWY_INLINE bool hidden_in_many(const DepthTiles& tiles, const PixelRange& range, float nearness) {
  const F f;
  const VF limit = hn::Set(f, nearness), far = hn::Set(f, kInfinity);
  const std::uint32_t tx0 = range.x0 / kTile, columns = range.x1 / kTile + 1 - tx0,
                      lanes = static_cast<std::uint32_t>(hn::Lanes(f)), last = (columns - 1) / lanes * lanes;
  const auto wanted = hn::FirstN(f, columns - last);
  const float* row = &tiles.farthest[range.y0 / kTile * std::size_t{tiles.stride} + tx0];
  for (std::uint32_t ty = range.y0 / kTile; ty <= range.y1 / kTile; ++ty, row += tiles.stride) {
    VF least = hn::IfThenElse(wanted, hn::LoadU(f, row + last), far);
    for (std::uint32_t at = 0; at < last; at += lanes) least = hn::Min(least, hn::LoadU(f, row + at));
    if (hn::AllFalse(f, hn::Le(least, limit))) continue;
    if (!hidden_in_row(tiles, range, ty, limit)) return false;
  }
  return true;
}

// The same of one.
HWY_INLINE bool hidden_in_one(const DepthTiles& tiles, const PixelRange& range, float nearness) {
  const VF least = least_in_tile(tiles, range, range.x0 / kTile, range.y0 / kTile);
  return hn::AllFalse(F(), hn::Le(least, hn::Set(F(), nearness)));
}

// Which of the ranges of `open` show something to who looks closer than at tiles, a bit each.
HWY_INLINE std::uint32_t look_closer(const DepthTiles& tiles, const PixelRanges& ranges, VF nearest,
                                     std::uint32_t open) {
  const F f;
  const I i32;
  alignas(64) std::array<std::int32_t, 16> left, right, top, bottom;
  alignas(64) std::array<float, 16> nearness;
  hn::Store(ranges.x0, i32, left.data()), hn::Store(ranges.x1, i32, right.data());
  hn::Store(ranges.y0, i32, top.data()), hn::Store(ranges.y1, i32, bottom.data());
  hn::Store(nearest, f, nearness.data());
  std::uint32_t seen = 0;
  const auto look = [&](std::uint32_t those, const auto& hides) HWY_ATTR {
    for (; those != 0; those &= those - 1) {
      const int i = std::countr_zero(those);
      const PixelRange range{static_cast<std::uint32_t>(left[i]), static_cast<std::uint32_t>(top[i]),
                             static_cast<std::uint32_t>(right[i]), static_cast<std::uint32_t>(bottom[i])};
      seen |= std::uint32_t{!hides(tiles, range, nearness[i])} << i;
    }
  };
  const auto in_one = hn::And(hn::Eq(ranges.tx0, ranges.tx1), hn::Eq(ranges.ty0, ranges.ty1));
  const std::uint32_t one = bits_of(f, hn::RebindMask(f, in_one)),
                      many = bits_of(f, hn::RebindMask(f, ranges.many));
  look(open & one, hidden_in_one);
  look(open & ~one & ~many, hidden_in_few);
  look(open & many, hidden_in_many);
  return seen;
}

// A vector of rectangles asked for, and what nearness nothing within them exceeds.
struct Question {
  Rectangles within;
  VF nearest;
  hn::Mask<F> sure;  // else the rectangle is not to be trusted, and what it stands for is visible
};

// What tiles alone say of a vector of rectangles, a bit each: which may be seen, and which only who looks
// closer knows.
struct Glance {
  PixelRanges ranges;
  std::uint32_t seen, open;
};

HWY_INLINE Glance glance(const DepthTiles& tiles, const Question& q) {
  const F f;
  const PixelBounds bounds = pixel_bounds(tiles, q.within);
  const auto finite =
      hn::And(hn::Lt(q.nearest, hn::Set(f, kInfinity)), hn::Gt(q.nearest, hn::Set(f, -kInfinity)));
  const auto sure = hn::And(q.sure, finite);
  const auto asked = hn::And(sure, bounds.some);
  // Those not asked for look at the first tile.
  Glance out{pixel_ranges(bounds, asked), 0, 0};  // where it stays: copies of many vectors take their time
  const PixelRanges& ranges = out.ranges;
  const auto behind_all = hn::Lt(q.nearest, farthest_within(tiles, ranges));
  const auto before_some = hn::Gt(q.nearest, least_at_corners(tiles, tiles.nearest, ranges));
  out.seen = bits_of(f, hn::Or(hn::Not(sure), hn::And(asked, before_some)));
  if (SIGHTLINE_MUTANT(unsure_questions_hidden)) out.seen = bits_of(f, hn::And(asked, before_some));
  out.open = bits_of(f, hn::AndNot(hn::Or(behind_all, before_some), asked));
  return out;
}

// visible[i] = 1 where thing i may be seen, else 0, for `count` of them, a vector at a time: question(from)
// asks for those that `from` points at, an array a coordinate.
template <std::size_t N, class Ask>
HWY_INLINE void answer_all(const DepthTiles& tiles, const std::array<const float*, N>& arrays,
                           std::size_t count, std::uint8_t* visible, const Ask& question) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t some = std::min(lanes, count - first);
    std::array<const float*, N> from = arrays;
    for (const float*& array : from) array += first;
    alignas(64) std::array<std::array<float, 16>, N> room;
    repeat_last(f, some, from, room);
    const Question asked = question(from);
    const auto [ranges, shown, open] = glance(tiles, asked);
    const std::uint32_t rest = open & ((1u << some) - 1),
                        seen = shown | (rest != 0 ? look_closer(tiles, ranges, asked.nearest, rest) : 0);
    for (std::size_t i = 0; i < some; ++i) visible[first + i] = seen >> i & 1;
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
