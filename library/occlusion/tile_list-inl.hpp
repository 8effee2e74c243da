// Tiles of polygons, gathered to be drawn pixel by pixel, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_TILE_LIST_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_TILE_LIST_INL
#undef SIGHTLINE_OCCLUSION_TILE_LIST_INL
#else
#define SIGHTLINE_OCCLUSION_TILE_LIST_INL
#endif

#include <algorithm>
#include <cmath>

#include "library/occlusion/image-inl.hpp"

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

// Polygons are looked at in steps of so many tiles, row by row.
constexpr std::uint32_t kStepColumns = 8, kStepRows = 2, kStepTiles = kStepColumns * kStepRows;

struct Step {
  std::uint32_t tx, ty, columns, rows;  // as many of them are asked for

  // A bit a tile that is asked for.
  [[nodiscard]] std::uint32_t asked() const {
    return ((1u << columns) - 1) * (rows == kStepRows ? 1u | 1u << kStepColumns : 1u);
  }
};

// Tiles of polygons that are to be drawn pixel by pixel. They are found first and drawn later, many at once,
// as a processor cannot guess how many a polygon has. In between the tiles hold less than was asked for,
// which is safe: what is drawn last is the same, whatever the order.
template <std::size_t kPlanes>
struct TileList {
  static constexpr std::size_t kMost = 512, kMostShapes = 32;
  struct Places {
    std::uint32_t tx, ty, shape;
  };
  // A place a tile of each step that was looked at: the pixels that its polygon has there, and its planes'
  // nearness at the first of them.
  alignas(64) std::array<std::uint64_t, kMost> pixels;
  alignas(64) std::array<std::array<float, kMost>, kPlanes> base;
  std::array<Places, kMost / kStepTiles> step;  // whose the places are
  std::array<PlaneTile<kPlanes>, kMostShapes> shapes;
  std::array<std::uint16_t, kMost + 8> listed;       // the places to be drawn; written eight at a time
  std::size_t size = 0, count = 0, shape_count = 0;  // places, those listed, and shapes
};

template <std::size_t kPlanes>
HWY_INLINE void draw_tile(DepthTiles& tiles, const TileList<kPlanes>& list, std::size_t at) {
  const F f;
  const typename TileList<kPlanes>::Places& step = list.step[at / kStepTiles];
  const PlaneTile<kPlanes>& of = list.shapes[step.shape];
  const std::size_t tx = step.tx + at % kStepColumns, ty = step.ty + at / kStepColumns % kStepRows,
                    tile = ty * tiles.stride + tx;
  const std::uint64_t pixels = list.pixels[at];
  float nearest = kInfinity;
  for (std::size_t p = 0; p < kPlanes; ++p) nearest = std::min(nearest, list.base[p][at] + of.most[p]);
  float* HWY_RESTRICT out = &tiles.nearness[tile * 64];
  // No branch on whether the tile was touched, which is hard to guess.
  const float was_nearest = tiles.nearest[tile];
  const bool touched = was_nearest > -kInfinity;
  if (touched & (tiles.plane.base[tile] > -kInfinity)) lay_plane(tiles.plane.of(tile), out);
  tiles.plane.base[tile] = -kInfinity;
  const std::size_t kind = std::size_t{tx + 1 == tiles.columns} | std::size_t{ty + 1 == tiles.rows} << 1;
  const std::array<const float*, 2> either{&tiles.untouched[kind * 64], out};
  const float* before = either[touched];
  tiles.nearest[tile] = std::max(was_nearest, nearest + std::fabs(nearest) * kTileRounding);
  VF base[kPlanes], two_down[kPlanes], least = hn::Set(f, kInfinity);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    base[p] = hn::Set(f, list.base[p][at]);
    two_down[p] = hn::Set(f, 2 * of.planes.down[p]);
  }
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    VF depth[kPlanes];
    for (std::size_t p = 0; p < kPlanes; ++p) depth[p] = hn::Add(base[p], hn::Load(f, &of.offset[p][i]));
    for (std::size_t pixel = i; pixel < 64; pixel += 16) {
      VF front = depth[0];
      for (std::size_t p = 1; p < kPlanes; ++p) front = hn::Min(front, depth[p]);
      for (std::size_t p = 0; p < kPlanes; ++p) depth[p] = hn::Add(depth[p], two_down[p]);
      const VF old = hn::Load(f, before + pixel);
      const VF now = hn::IfThenElse(mask_of(f, pixels >> pixel), hn::Max(old, front), old);
      hn::Store(now, f, out + pixel);
      least = hn::Min(least, now);
    }
  }
  tiles.farthest[tile] = hn::GetLane(hn::MinOfLanes(f, least));
}

// Draws what is listed.
template <std::size_t kPlanes>
HWY_NOINLINE void draw_listed(DepthTiles& tiles, TileList<kPlanes>& list) {
  for (std::size_t n = 0; n < list.count; ++n) draw_tile(tiles, list, list.listed[n]);
  list.size = list.count = list.shape_count = 0;
}

// Makes room for another step of the last shape.
template <std::size_t kPlanes>
HWY_INLINE void make_room(DepthTiles& tiles, TileList<kPlanes>& list) {
  if (list.size < list.kMost) return;
  const std::size_t last = list.shape_count - 1;
  draw_listed(tiles, list);
  list.shapes[list.shape_count++] = list.shapes[last];
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
