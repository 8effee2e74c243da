// Tiles of 2, 4, 8 and 16 tiles a side, made of what was drawn.
#include "library/geometry/mutant.h"
#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/coarse_tiles.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/image-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Of two rows the least of two columns each; of an odd number of columns the last alone. Reads up to two
// vectors beyond them, which the rows behind leave room for.
HWY_INLINE void make_row(const float* upper, const float* lower, std::uint32_t columns, float* out) {
  const F f;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(f));
  const auto load = [&](std::uint32_t at) HWY_ATTR {
    const VF least = hn::Min(hn::LoadU(f, upper + at), hn::LoadU(f, lower + at));
    return hn::IfThenElse(hn::FirstN(f, std::max(columns, at) - at), least, hn::Set(f, kInfinity));
  };
  for (std::uint32_t at = 0; at < columns; at += 2 * lanes) {
    const VF low = load(at), high = load(at + lanes);
#if HWY_TARGET == HWY_SCALAR
    const VF even = low, odd = high;
#else
    const VF even = hn::ConcatEven(f, high, low), odd = hn::ConcatOdd(f, high, low);
#endif
    hn::StoreU(hn::Min(even, odd), f, out + at / 2);
  }
}

void make_levels(DepthTiles& tiles) {
  std::uint32_t columns = tiles.columns, rows = tiles.rows;
  const float* from = tiles.farthest;
  for (std::uint32_t level = 1; level <= kCoarseLevels; ++level) {
    float* const to = tiles.farthest + std::size_t{tiles.first_row_of(level)} * tiles.stride;
    for (std::uint32_t row = 0; row < rows; row += 2) {
      const std::uint32_t next = SIGHTLINE_MUTANT(coarse_rows_skipped) ? row : std::min(row + 1, rows - 1);
      make_row(from + row * tiles.stride, from + next * tiles.stride, columns, to + row / 2 * tiles.stride);
    }
    from = to, columns = (columns + 1) / 2, rows = (rows + 1) / 2;
  }
  tiles.coarse->levels = kCoarseLevels;
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(make_levels);

void note_drawn(DepthTiles& tiles, std::size_t things) noexcept {
  constexpr std::size_t kTilesPerThing = 64;
  CoarseTiles& coarse = *tiles.coarse;
  coarse.drawn += things;
  if (coarse.drawn * kTilesPerThing < std::size_t{tiles.columns} * tiles.rows) return;
  coarse.drawn = 0;
  HWY_DYNAMIC_DISPATCH(make_levels)(tiles);
}

}  // namespace sightline::occlusion
#endif
