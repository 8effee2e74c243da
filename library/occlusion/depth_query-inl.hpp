// Rectangles of pixels against the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_DEPTH_QUERY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_DEPTH_QUERY_INL
#undef SIGHTLINE_CULLING_DEPTH_QUERY_INL
#else
#define SIGHTLINE_CULLING_DEPTH_QUERY_INL
#endif

#include "library/occlusion/depth_raster-inl.hpp"

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
  const std::uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left);
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - high))) & (~std::uint64_t{0} << (8 * low));
  const std::uint64_t wanted = columns * 0x0101010101010101u & rows;
  const float* depth = &tiles.nearness[(std::size_t{ty} * tiles.stride + tx) * 64];
  VF least = hn::Set(f, kInfinity);
  for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
    least =
        hn::Min(least, hn::IfThenElse(pixels_at(wanted, i), hn::Load(f, depth + i), hn::Set(f, kInfinity)));
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

// The same of many tiles.
HWY_INLINE bool hidden_in_many(const DepthTiles& tiles, const PixelRange& range, float nearness) {
  const F f;
  const std::uint32_t tx0 = range.x0 / kTile, tx1 = range.x1 / kTile, ty0 = range.y0 / kTile,
                      ty1 = range.y1 / kTile;
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = ty0; ty <= ty1; ++ty) {
    const float* farthest = &tiles.farthest[std::size_t{ty} * tiles.stride];
    const float* nearest = &tiles.nearest[std::size_t{ty} * tiles.stride];
    for (std::uint32_t tx = tx0; tx <= tx1; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
      const auto wanted = hn::FirstN(f, tx1 - tx + 1);
      const auto open = hn::And(wanted, hn::Le(hn::LoadU(f, farthest + tx), limit));
      // A tile of which nothing lies nearer shows what stands there.
      if (!hn::AllFalse(f, hn::And(open, hn::Lt(hn::LoadU(f, nearest + tx), limit)))) return false;
      for (std::uint32_t bits = bits_of(open); bits != 0; bits &= bits - 1) {
        const std::uint32_t t = tx + static_cast<std::uint32_t>(std::countr_zero(bits));
        if (!hn::AllFalse(f, hn::Le(least_in_tile(tiles, range, t, ty), limit))) return false;
      }
    }
  }
  return true;
}

// A vector of rectangles of the image, in pixels, and what nearness nothing within them exceeds.
struct Rectangles {
  VF left, right, top, bottom, nearest;
  hn::Mask<F> sure;  // else the rectangle is not to be trusted, and what it stands for is visible
};

// visible[i] = 1 where some pixel centre of rectangle i may see past the occluders, else 0; of the first
// `count`.
HWY_INLINE void test_rectangles(const DepthTiles& tiles, const Rectangles& r, std::size_t count,
                                std::uint8_t* visible) {
  const F f;
  const hn::RebindToSigned<F> i32;
  // Pixel centres c with low <= c <= high, as columns and rows [first, last].
  const VF half = hn::Set(f, 0.5f), zero = hn::Zero(f);
  const VF columns = hn::Set(f, static_cast<float>(tiles.width) - 1),
           rows = hn::Set(f, static_cast<float>(tiles.height) - 1);
  const auto first = [&](VF low) HWY_ATTR { return hn::Max(hn::Ceil(hn::Sub(low, half)), zero); };
  const auto last = [&](VF high, VF limit)
                        HWY_ATTR { return hn::Min(hn::Floor(hn::Sub(high, half)), limit); };
  const VF fx0 = first(r.left), fy0 = first(r.top), fx1 = last(r.right, columns), fy1 = last(r.bottom, rows);
  const auto finite =
      hn::And(hn::Lt(r.nearest, hn::Set(f, kInfinity)), hn::Gt(r.nearest, hn::Set(f, -kInfinity)));
  const auto sure = hn::And(r.sure, finite);
  const auto covers = hn::And(hn::Le(fx0, fx1), hn::Le(fy0, fy1));
  const auto asked = hn::And(sure, covers);
  // Those not asked for look at the first tile.
  const auto pixel = [&](VF at) HWY_ATTR { return hn::ConvertTo(i32, hn::IfThenElseZero(asked, at)); };
  const auto x0 = pixel(fx0), y0 = pixel(fy0), x1 = pixel(fx1), y1 = pixel(fy1);
  // What the tiles of the corners say, which are all tiles of a small rectangle.
  const auto tx0 = hn::ShiftRight<3>(x0), tx1 = hn::ShiftRight<3>(x1), ty0 = hn::ShiftRight<3>(y0),
             ty1 = hn::ShiftRight<3>(y1);
  const auto stride = hn::Set(i32, static_cast<std::int32_t>(tiles.stride));
  const auto row0 = hn::Mul(ty0, stride), row1 = hn::Mul(ty1, stride);
  const auto least = [&](const geometry::AlignedVector<float>& of) HWY_ATTR {
    const auto at = [&](auto row, auto column)
                        HWY_ATTR { return hn::GatherIndex(f, of.data(), hn::Add(row, column)); };
    return hn::Min(hn::Min(at(row0, tx0), at(row0, tx1)), hn::Min(at(row1, tx0), at(row1, tx1)));
  };
  const auto one = hn::Set(i32, 1);
  const auto large = hn::Or(hn::Gt(hn::Sub(tx1, tx0), one), hn::Gt(hn::Sub(ty1, ty0), one));
  const auto behind_all = hn::AndNot(hn::RebindMask(f, large), hn::Lt(r.nearest, least(tiles.farthest)));
  const auto before_some = hn::Gt(r.nearest, least(tiles.nearest));
  const auto open = hn::AndNot(hn::Or(behind_all, before_some), asked);
  std::uint32_t seen = bits_of(hn::Or(hn::Not(sure), hn::And(asked, before_some)));
  const std::uint32_t rest = bits_of(open) & ((1u << count) - 1);
  if (rest != 0) {
    alignas(64) std::array<std::int32_t, 16> left, right, top, bottom;
    alignas(64) std::array<float, 16> nearest;
    hn::Store(x0, i32, left.data()), hn::Store(x1, i32, right.data());
    hn::Store(y0, i32, top.data()), hn::Store(y1, i32, bottom.data());
    hn::Store(r.nearest, f, nearest.data());
    const auto look_closer = [&](std::uint32_t those, const auto& hides) HWY_ATTR {
      for (; those != 0; those &= those - 1) {
        const int i = std::countr_zero(those);
        const PixelRange range{static_cast<std::uint32_t>(left[i]), static_cast<std::uint32_t>(top[i]),
                               static_cast<std::uint32_t>(right[i]), static_cast<std::uint32_t>(bottom[i])};
        seen |= std::uint32_t{!hides(tiles, range, nearest[i])} << i;
      }
    };
    const std::uint32_t one_tile = bits_of(hn::RebindMask(f, hn::And(hn::Eq(tx0, tx1), hn::Eq(ty0, ty1))));
    const std::uint32_t many = bits_of(hn::RebindMask(f, large));
    look_closer(rest & one_tile, [](const DepthTiles& t, const PixelRange& range, float nearness) HWY_ATTR {
      const VF least = least_in_tile(t, range, range.x0 / kTile, range.y0 / kTile);
      return hn::AllFalse(F(), hn::Le(least, hn::Set(F(), nearness)));
    });
    look_closer(rest & ~one_tile & ~many, hidden_in_few);
    look_closer(rest & many, hidden_in_many);
  }
  for (std::size_t i = 0; i < count; ++i) visible[i] = seen >> i & 1;
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
