// What lies in rectangles of many tiles, by coarser ones, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_COARSE_TILES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_COARSE_TILES_INL
#undef SIGHTLINE_OCCLUSION_COARSE_TILES_INL
#else
#define SIGHTLINE_OCCLUSION_COARSE_TILES_INL
#endif

#include "library/occlusion/image-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// The finest level of which the tiles at a rectangle's corners are all that it reaches into: that of 2^n
// tiles a side for one that reaches so many tiles farther than its first.
HWY_INLINE VI level_of(const PixelRanges& r) {
  const F f;
  const I i32;
  const VI farther = hn::Max(hn::Sub(r.tx1, r.tx0), hn::Sub(r.ty1, r.ty0));
  // The logarithm, rounded up, by a float's exponent; of less than two 0.
  const VF number = hn::Max(hn::ConvertTo(f, hn::Sub(farther, hn::Set(i32, 1))), hn::Set(f, 0.5f));
  return hn::Sub(hn::ShiftRight<23>(hn::BitCast(i32, number)), hn::Set(i32, 126));
}

// No pixel of the rectangle is farther; -infinity where no level that is known says so.
SIGHTLINE_INLINE_IN_BOTH VF farthest_within(const DepthTiles& tiles, const PixelRanges& r) {
  const F f;
  if (hn::AllFalse(I(), r.many)) return least_at_corners(tiles, tiles.farthest, r);
  const I i32;
  const VI level = level_of(r), known = hn::Set(i32, static_cast<std::int32_t>(tiles.coarse->levels)),
           at = hn::Min(level, known), rows = hn::Set(i32, static_cast<std::int32_t>(2 * tiles.level_rows));
  // Shifts by a number a lane are dear where they are no instruction; floats hold all of these numbers.
  const VF part = hn::BitCast(f, hn::ShiftLeft<23>(hn::Sub(hn::Set(i32, 127), at)));
  const auto of_level = [&](VI of_tiles) HWY_ATTR {
    return hn::ConvertTo(i32, hn::Mul(hn::ConvertTo(f, of_tiles), part));
  };
  const VI first = hn::Sub(rows, of_level(rows));
  const VF least = least_where_crossed(tiles, tiles.farthest, of_level(r.tx0), of_level(r.tx1),
                                       hn::Add(first, of_level(r.ty0)), hn::Add(first, of_level(r.ty1)));
  return hn::IfThenElse(hn::RebindMask(f, hn::Gt(level, known)), hn::Set(f, -kInfinity), least);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
