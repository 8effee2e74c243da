// Rectangles of pixels against the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_DEPTH_QUERY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_DEPTH_QUERY_INL
#undef SIGHTLINE_CULLING_DEPTH_QUERY_INL
#else
#define SIGHTLINE_CULLING_DEPTH_QUERY_INL
#endif

#include "culling/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

// Whether each wanted pixel of a tile has an occluder nearer than `nearness`; tile (tx, ty).
HWY_INLINE bool hidden_in_tile(const DepthTiles& tiles, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1,
                               std::uint32_t y1, float nearness, std::uint32_t tx, std::uint32_t ty) {
  const F f;
  const std::size_t tile = std::size_t{ty} * tiles.stride + tx;
  if (nearness < tiles.farthest[tile]) return true;
  if (!(nearness <= tiles.nearest[tile])) return false;
  // The rectangle's pixels within the tile.
  const std::uint32_t left = std::max(x0, tx * kTile) - tx * kTile,
                      right = std::min(x1, tx * kTile + 7) - tx * kTile;
  const std::uint32_t low = std::max(y0, ty * kTile) - ty * kTile,
                      high = std::min(y1, ty * kTile + 7) - ty * kTile;
  const std::uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left);
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - high))) & (~std::uint64_t{0} << (8 * low));
  const std::uint64_t wanted = columns * 0x0101010101010101u & rows;
  const VF limit = hn::Set(f, nearness);
  const float* depth = &tiles.nearness[tile * 64];
  // The least nearness of the wanted pixels, by which one guess of a branch is enough.
  VF least = hn::Set(f, kInfinity);
  for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
    least =
        hn::Min(least, hn::IfThenElse(pixels_at(wanted, i), hn::Load(f, depth + i), hn::Set(f, kInfinity)));
  }
  return hn::AllFalse(f, hn::Le(least, limit));
}

// Whether each pixel centre of the columns and rows, last ones included, has an occluder nearer than
// `nearness`.
HWY_INLINE bool hidden(const DepthTiles& tiles, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1,
                       std::uint32_t y1, float nearness) {
  const F f;
  const std::uint32_t tx0 = x0 / kTile, tx1 = x1 / kTile, ty0 = y0 / kTile, ty1 = y1 / kTile;
  if (tx0 == tx1 && ty0 == ty1) return hidden_in_tile(tiles, x0, y0, x1, y1, nearness, tx0, ty0);
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = ty0; ty <= ty1; ++ty) {
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
        if (!hidden_in_tile(tiles, x0, y0, x1, y1, nearness, t, ty)) return false;
      }
    }
  }
  return true;
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
