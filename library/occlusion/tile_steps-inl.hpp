// Tiles in steps of sixteen: those that a plane covers are given to it, the others gathered, for every SIMD
// width. Included by files that foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_TILE_STEPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_TILE_STEPS_INL
#undef SIGHTLINE_OCCLUSION_TILE_STEPS_INL
#else
#define SIGHTLINE_OCCLUSION_TILE_STEPS_INL
#endif

#include "library/occlusion/bit_places.hpp"
#include "library/occlusion/spans-inl.hpp"
#include "library/occlusion/tile_list-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Where a step's tiles begin, in pixels from the first one's.
struct StepOffsets {
  alignas(64) std::array<float, kStepTiles> x{}, y{};

  constexpr StepOffsets() {
    for (std::uint32_t i = 0; i < kStepTiles; ++i) {
      const std::uint32_t column = i % kStepColumns, row = i / kStepColumns;
      x[i] = static_cast<float>(column * kTile), y[i] = static_cast<float>(row * kTile);
    }
  }
};
constexpr StepOffsets kStepOffsets;

// A vector of a step's tiles, from the i-th on, a value each; rows not asked for repeat the first.
HWY_INLINE VF load_step(const DepthTiles& tiles, const float* of, const Step& step, std::uint32_t i) {
  const F f;
  of += std::size_t{step.ty} * tiles.stride + step.tx;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(F()) == kStepTiles) {
    const hn::Half<F> half;
    return hn::Combine(f, hn::LoadU(half, of + (step.rows - 1) * tiles.stride), hn::LoadU(half, of));
  }
#endif
  return hn::LoadU(f, of + std::size_t{i / kStepColumns} * tiles.stride + i % kStepColumns);
}

// Writes those of them whose bits are set. Blended by hand: a masked store is microcoded on some processors.
HWY_INLINE void store_step(const DepthTiles& tiles, VF values, std::uint32_t those, const Step& step,
                           std::uint32_t i, float* of) {
  const F f;
  of += std::size_t{step.ty} * tiles.stride + step.tx;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(F()) == kStepTiles) {
    const hn::Half<F> half;
    float* below = of + (step.rows - 1) * tiles.stride;
    const auto blend = [&](auto now, std::uint32_t bits, float* at) HWY_ATTR {
      hn::StoreU(hn::IfThenElse(mask_of(half, bits), now, hn::LoadU(half, at)), half, at);
    };
    blend(hn::LowerHalf(half, values), those, of);
    if (step.rows == kStepRows) blend(hn::UpperHalf(half, values), those >> kStepColumns, below);
    return;
  }
#endif
  of += std::size_t{i / kStepColumns} * tiles.stride + i % kStepColumns;
  const bool all = those == (1u << hn::Lanes(f)) - 1;
  hn::StoreU(all ? values : hn::IfThenElse(mask_of(f, those), values, hn::LoadU(f, of)), f, of);
}

// Of a vector of a step's tiles, gives those of `full`, which the plane covers, to the plane where it lies
// before all that they hold. Returns their bits.
HWY_INLINE std::uint32_t cover_tiles(DepthTiles& tiles, const PlaneTile<1>& of, const Step& step,
                                     std::uint32_t i, VF base, std::uint32_t full) {
  const F f;
  const VF slack = hn::Mul(hn::Set(f, kTileRounding),
                           hn::Add(hn::Abs(base), hn::Set(f, of.most[0] - of.least[0]))),
           farthest = hn::Sub(hn::Add(base, hn::Set(f, of.least[0])), slack),
           nearest = hn::Add(hn::Add(base, hn::Set(f, of.most[0])), slack);
  const std::uint32_t in_front =
      full & bits_of(f, hn::Gt(farthest, load_step(tiles, tiles.nearest, step, i)));
  if (in_front == 0) return 0;
  store_step(tiles, farthest, in_front, step, i, tiles.farthest);
  store_step(tiles, nearest, in_front, step, i, tiles.nearest);
  store_step(tiles, base, in_front, step, i, tiles.plane.base);
  store_step(tiles, hn::Set(f, of.planes.across[0]), in_front, step, i, tiles.plane.across);
  store_step(tiles, hn::Set(f, of.planes.down[0]), in_front, step, i, tiles.plane.down);
  return in_front;
}

// Appends the places from `first` on that the bits of a byte name; writes eight.
HWY_INLINE std::size_t append_places(std::uint32_t first, std::uint32_t bits, std::uint16_t* out) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < 8; ++i) out[i] = static_cast<std::uint16_t>(first + kBitPlaces.of[bits][i]);
#else
  const hn::FixedTag<std::uint16_t, 8> u16;
  const hn::FixedTag<std::uint8_t, 8> u8;
  const auto places = hn::PromoteTo(u16, hn::LoadU(u8, kBitPlaces.of[bits].data()));
  hn::StoreU(hn::Add(places, hn::Set(u16, static_cast<std::uint16_t>(first))), u16, out);
#endif
  return kBitPlaces.count[bits];
}

// Lists those of a step's tiles, whose pixels the list has at its end, in which its last shape shows, but
// those that its plane covers.
template <std::size_t kPlanes>
SIGHTLINE_INLINE_IN_BOTH void take_step(DepthTiles& tiles, const Step& step, const Held& held,
                                        TileList<kPlanes>& list) {
  const F f;
  const auto size = static_cast<std::uint32_t>(list.size);
  const PlaneTile<kPlanes>& of = list.shapes[list.shape_count - 1];
  const VF x0 = hn::Set(f, static_cast<float>(step.tx * kTile) + 0.5f),
           y0 = hn::Set(f, static_cast<float>(step.ty * kTile) + 0.5f);
  std::uint32_t shown = 0;
  // The last row's lines may end beyond the image.
  const bool may_cover = kPlanes == 1 && (step.ty + step.rows < tiles.rows || tiles.height % kTile == 0);
  for (std::uint32_t i = 0; i < kStepTiles; i += static_cast<std::uint32_t>(hn::Lanes(f))) {
    const std::uint32_t those = (1u << hn::Lanes(f)) - 1, some = (held.some & step.asked()) >> i & those;
    if (hn::Lanes(f) < kStepTiles && some == 0) continue;
    const VF x = hn::Add(x0, hn::Load(f, &kStepOffsets.x[i])),
             y = hn::Add(y0, hn::Load(f, &kStepOffsets.y[i]));
    VF nearest = hn::Set(f, kInfinity), base = nearest;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      base = hn::Add(hn::Add(hn::Set(f, of.planes.at[p]), hn::Mul(x, hn::Set(f, of.planes.across[p]))),
                     hn::Mul(y, hn::Set(f, of.planes.down[p])));
      nearest = hn::Min(nearest, hn::Add(base, hn::Set(f, of.most[p])));
      hn::Store(base, f, &list.base[p][size + i]);
    }
    std::uint32_t shows = some & bits_of(f, hn::Gt(nearest, load_step(tiles, tiles.farthest, step, i)));
    if constexpr (kPlanes == 1) {
      const std::uint32_t full = may_cover ? shows & held.all >> i : 0;
      if (full != 0) shows &= ~cover_tiles(tiles, of, step, i, base, full);
    }
    shown |= shows << i;
  }
  if (shown == 0) return;  // and the next step takes its place
  list.count += append_places(size, shown & 0xff, &list.listed[list.count]);
  list.count += append_places(size + 8, shown >> 8, &list.listed[list.count]);
  list.step[size / kStepTiles] = {step.tx, step.ty, static_cast<std::uint32_t>(list.shape_count - 1)};
  list.size += kStepTiles;
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
