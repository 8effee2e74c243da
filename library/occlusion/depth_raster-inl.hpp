// Convex polygons into the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#undef SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#else
#define SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#endif

#include <bit>

#include "library/geometry/mutant.h"
#include "library/occlusion/spans-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// What a polygon hides: the least of its planes' nearness, at + x·across + y·down.
template <std::size_t kPlanes>
struct Planes {
  std::array<float, kPlanes> at, across, down;
};

// A polygon's planes, and their nearness from a tile's first pixel on over two rows of it: what is the same
// for all its tiles.
template <std::size_t kPlanes>
struct PlaneTile {
  Planes<kPlanes> planes;
  alignas(64) std::array<std::array<float, 16>, kPlanes> offset;
  std::array<float, kPlanes> most, least;  // of all eight rows
};

template <std::size_t kPlanes>
HWY_INLINE PlaneTile<kPlanes> tile_of(const Planes<kPlanes>& planes) {
  const F f;
  PlaneTile<kPlanes> out;
  out.planes = planes;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const VF across = hn::Set(f, planes.across[p]), down = hn::Set(f, planes.down[p]);
    for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
      hn::Store(hn::Add(hn::Mul(across, hn::Load(f, kColumn + i)), hn::Mul(down, hn::Load(f, kRow + i))), f,
                &out.offset[p][i]);
    }
    out.most[p] = std::max(0.0f, 7 * planes.across[p]) + std::max(0.0f, 7 * planes.down[p]);
    out.least[p] = std::min(0.0f, 7 * planes.across[p]) + std::min(0.0f, 7 * planes.down[p]);
  }
  return out;
}

// Draws into these pixels of tile (tx, ty).
template <std::size_t kPlanes>
HWY_INLINE void draw_tile(DepthTiles& tiles, const PlaneTile<kPlanes>& of, std::uint32_t tx, std::uint32_t ty,
                          std::uint64_t pixels) {
  const F f;
  const Planes<kPlanes>& planes = of.planes;
  const float x = static_cast<float>(tx * kTile) + 0.5f, y = static_cast<float>(ty * kTile) + 0.5f;
  std::array<float, kPlanes> base;
  float nearest = kInfinity;
  for (std::size_t p = 0; p < kPlanes; ++p) {
    base[p] = (planes.at[p] + x * planes.across[p]) + y * planes.down[p];
    nearest = std::min(nearest, base[p] + of.most[p]);
  }
  const std::size_t tile = std::size_t{ty} * tiles.stride + tx;
  if ((pixels == 0) | !(nearest > tiles.farthest[tile])) return;
  float* HWY_RESTRICT out = &tiles.nearness[tile * 64];
  if (tiles.nearest[tile] > -kInfinity && tiles.plane[tile].covers != 0) lay_plane(tiles.plane[tile], out);
  tiles.plane[tile].covers = 0;
  // No branch on whether the tile was touched, which is hard to guess.
  const std::size_t kind = std::size_t{tx + 1 == tiles.columns} | std::size_t{ty + 1 == tiles.rows} << 1;
  const float* before = &tiles.untouched[kind * 64];
  before = tiles.nearest[tile] > -kInfinity ? out : before;
  tiles.nearest[tile] = std::max(tiles.nearest[tile], nearest + std::fabs(nearest) * kTileRounding);
  VF least = hn::Set(f, kInfinity);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    VF depth[kPlanes];
    for (std::size_t p = 0; p < kPlanes; ++p)
      depth[p] = hn::Add(hn::Set(f, base[p]), hn::Load(f, &of.offset[p][i]));
    for (std::size_t at = i; at < 64; at += 16) {
      VF front = depth[0];
      for (std::size_t p = 1; p < kPlanes; ++p) front = hn::Min(front, depth[p]);
      for (std::size_t p = 0; p < kPlanes; ++p) depth[p] = hn::Add(depth[p], hn::Set(f, 2 * planes.down[p]));
      const VF old = hn::Load(f, before + at);
      const VF now = hn::IfThenElse(mask_of(f, pixels >> at), hn::Max(old, front), old);
      hn::Store(now, f, out + at);
      least = hn::Min(least, now);
    }
  }
  tiles.farthest[tile] = hn::GetLane(hn::MinOfLanes(f, least));
}

// Gives tiles [begin, end) of a row to a plane that covers them where it lies before all that they hold, and
// draws the others pixel by pixel.
HWY_INLINE void cover_tiles(DepthTiles& tiles, const PlaneTile<1>& of, std::uint32_t begin, std::uint32_t end,
                            std::uint32_t ty) {
  const F f;
  const Planes<1>& planes = of.planes;
  const VF at = hn::Set(f, planes.at[0]), across = hn::Set(f, planes.across[0]),
           below = hn::Set(f, (static_cast<float>(ty * kTile) + 0.5f) * planes.down[0]),
           rounding = hn::Set(f, kTileRounding), range = hn::Set(f, of.most[0] - of.least[0]);
  const VF columns = hn::Mul(hn::Load(f, kLine), hn::Set(f, static_cast<float>(kTile)));
  alignas(64) std::array<float, 16> bases;
  for (std::uint32_t tx = begin; tx < end; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
    const std::size_t tile = std::size_t{ty} * tiles.stride + tx;
    const VF x = hn::Add(hn::Set(f, static_cast<float>(tx * kTile) + 0.5f), columns);
    const VF base = hn::Add(hn::Add(at, hn::Mul(x, across)), below),
             nearest = hn::Add(base, hn::Set(f, of.most[0])),
             slack = hn::Mul(rounding, hn::Add(hn::Abs(base), range)),
             farthest = hn::Sub(hn::Add(base, hn::Set(f, of.least[0])), slack);
    const VF was_farthest = hn::LoadU(f, &tiles.farthest[tile]),
             was_nearest = hn::LoadU(f, &tiles.nearest[tile]);
    const auto shows = hn::And(hn::FirstN(f, end - tx), hn::Gt(nearest, was_farthest));
    const auto in_front = hn::And(shows, hn::Gt(farthest, was_nearest));
    hn::StoreU(hn::IfThenElse(in_front, farthest, was_farthest), f, &tiles.farthest[tile]);
    hn::StoreU(hn::IfThenElse(in_front, hn::Add(nearest, slack), was_nearest), f, &tiles.nearest[tile]);
    hn::Store(base, f, bases.data());
    for (std::uint32_t bits = bits_of(f, in_front); bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(bits));
      tiles.plane[tile + i] = {bases[i], planes.across[0], planes.down[0], 1};
    }
    for (std::uint32_t bits = bits_of(f, hn::AndNot(in_front, shows)); bits != 0; bits &= bits - 1)
      draw_tile(tiles, of, tx + static_cast<std::uint32_t>(std::countr_zero(bits)), ty, ~std::uint64_t{0});
  }
}

// Draws what `spans_from` says of sixteen lines from a pixel centre on, tile by tile.
template <std::size_t kPlanes, class SpansFrom>
HWY_INLINE void draw_spans(DepthTiles& tiles, const Planes<kPlanes>& planes, const TileRange& range,
                           const SpansFrom& spans_from) {
  const PlaneTile<kPlanes> of = tile_of(planes);
  Spans spans;
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ++ty) {
    const std::size_t line = (ty - range.begin_y) % 2 * kTile;
    if (line == 0) spans = spans_from(static_cast<float>(ty * kTile) + 0.5f);
    // Of a polygon more than a tile wide that lies aslant, a row of tiles holds only a part.
    const bool wide = range.end_x - range.begin_x > 1;
    const std::uint32_t begin_x = wide ? first_column(spans, line) / kTile : range.begin_x,
                        end_x = wide ? (end_column(spans, line) + kTile - 1) / kTile : range.end_x;
    const auto draw = [&](std::uint32_t begin, std::uint32_t end) HWY_ATTR {
      for (std::uint32_t tx = begin; tx < end; ++tx)
        draw_tile(tiles, of, tx, ty, pixels_of(spans, line, tx * kTile));
    };
    // Tiles that all lines cover; the last row's lines may end beyond the image.
    std::uint32_t full_x = end_x, full_end = end_x;
    if (kPlanes == 1 && end_x - begin_x > 1 && (ty + 1 < tiles.rows || tiles.height % kTile == 0)) {
      full_x = std::min(end_x, (last_begin(spans, line) + kTile - 1) / kTile);
      full_end = std::max(full_x, first_end(spans, line) / kTile);
    }
    draw(begin_x, full_x);
    if constexpr (kPlanes == 1) cover_tiles(tiles, of, full_x, full_end, ty);
    draw(full_end, end_x);
  }
}

HWY_INLINE void draw_polygon(DepthTiles& tiles, const Convex& polygon, const TileRange& range) {
  if (polygon.left_edges == 0 || polygon.right_edges == 0) return;
  draw_spans<1>(tiles, {{polygon.at}, {polygon.across}, {polygon.down}}, range, [&](float first_y) HWY_ATTR {
    return spans_of(polygon, first_y, static_cast<float>(tiles.width));
  });
}

// The same without the pixels of some bands.
HWY_INLINE void draw_polygon(DepthTiles& tiles, const Convex& polygon, const TileRange& range,
                             const Bands& without) {
  if (without.count == 0) return draw_polygon(tiles, polygon, range);
  if (polygon.left_edges == 0 || polygon.right_edges == 0) return;
  const auto width = static_cast<float>(tiles.width);
  const PlaneTile<1> of = tile_of<1>({{polygon.at}, {polygon.across}, {polygon.down}});
  std::array<Spans, Bands::kMost> left_out;
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ++ty) {
    const float first_y = static_cast<float>(ty * kTile) + 0.5f;
    const Spans spans = spans_of(polygon, first_y, width);
    std::size_t bands = 0;
    for (std::size_t i = 0; i < without.count; ++i) {
      if (without.top[i] <= first_y + 7 && without.bottom[i] >= first_y)
        left_out[bands++] = spans_of(without, i, first_y, width);
    }
    const std::uint32_t end_x = std::min(range.end_x, (end_column(spans, 0) + kTile - 1) / kTile);
    for (std::uint32_t tx = std::max(range.begin_x, first_column(spans, 0) / kTile); tx < end_x; ++tx) {
      std::uint64_t pixels = pixels_of(spans, 0, tx * kTile);
      for (std::size_t i = 0; i < bands; ++i) pixels &= ~pixels_of(left_out[i], 0, tx * kTile);
      if (pixels == ~std::uint64_t{0})
        cover_tiles(tiles, of, tx, tx + 1, ty);
      else
        draw_tile(tiles, of, tx, ty, pixels);
    }
  }
}

// Whether all of the tiles lie nearer than `nearness`; false where one would need a closer look.
HWY_INLINE bool hidden_tiles(const DepthTiles& tiles, const TileRange& range, float nearness) {
  const F f;
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ++ty) {
    const float* row = &tiles.farthest[std::size_t{ty} * tiles.stride];
    for (std::uint32_t tx = range.begin_x; tx < range.end_x; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
      const auto open = hn::Lt(hn::LoadU(f, row + tx), limit);
      if (!hn::AllFalse(f, hn::And(open, hn::FirstN(f, range.end_x - tx)))) return false;
    }
  }
  return true;
}

// Planes moved away by what rounding can have brought them nearer: of the numbers, and of the pixel's place
// on a surface seen edge on; and to where they are farthest as far from a pixel's centre as it counts.
HWY_INLINE VF moved_back(const DepthTiles& tiles, VF at, VF across, VF down, VF nearest) {
  const F f;
  const VF slant = hn::Mul(hn::Add(hn::Abs(across), hn::Abs(down)), hn::Set(f, kPixelPlay + tiles.margin));
  if (SIGHTLINE_MUTANT(occluders_a_step_too_near))
    return hn::Add(at, hn::Mul(hn::Set(f, kNearnessRounding), hn::Abs(nearest)));
  return hn::Sub(at, hn::Add(hn::Mul(hn::Set(f, kNearnessRounding), hn::Abs(nearest)), slant));
}

// How far inside its outline an occluder must hold a pixel centre whose outline reaches `widest` pixels far.
HWY_INLINE VF inset_of(const DepthTiles& tiles, VF widest) {
  const F f;
  if (SIGHTLINE_MUTANT(outlines_not_inset)) return hn::Zero(f);
  return hn::Add(hn::Set(f, kInset + tiles.margin), hn::Mul(hn::Set(f, kInsetGrowth), widest));
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
