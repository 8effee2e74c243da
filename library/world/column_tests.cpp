// Layers and distances: what all objects of a chunk have in common decides for a group of chunks at once, and
// the rows of columns beside a chunk's boxes for its objects.
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/column_tests.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/world_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

HWY_INLINE VF square(VF v) {
  return hn::Mul(v, v);
}

// A scale that turns a metre of a range into a view's.
HWY_INLINE VF reach(const float* metres, const SectorView& view) {
  const F f;
  return square(hn::Mul(hn::Load(f, metres), hn::Set(f, view.distance_scale)));
}

// The square of the distance from the eye to the nearest and to the farthest place that an object's centre
// may have in a box. Each step rounds as it does for an object, and grows with what it is given: so no object
// lies outside of what they say.
struct Distances {
  VF nearest, farthest;
};
HWY_INLINE Distances distances_to(const ChunkMap::Group& group, const SectorView& view, std::size_t i) {
  const F f;
  Distances out{hn::Zero(f), hn::Zero(f)};
  const auto add = [&](std::size_t axis, float eye) HWY_ATTR {
    const VF low = hn::Sub(hn::Load(f, &group.bounds[axis][i]), hn::Set(f, eye)),
             high = hn::Sub(hn::Load(f, &group.bounds[axis + 3][i]), hn::Set(f, eye));
    const VF between = hn::Max(hn::Max(low, hn::Neg(high)), hn::Zero(f));
    out.nearest = hn::Add(out.nearest, square(between));
    out.farthest =
        hn::Add(out.farthest, SIGHTLINE_MUTANT(chunks_by_their_nearest) ? square(between)
                                                                        : hn::Max(square(low), square(high)));
  };
  add(0, view.distance_eye.x), add(1, view.distance_eye.y), add(2, view.distance_eye.z);
  return out;
}

ColumnBits test_chunks(const ChunkMap& map, std::uint32_t number, const SectorView& view) {
  const F f;
  const U u;
  ColumnBits out{~0u, ~0u};
  if (const std::uint32_t* rows = map.layer_rows(number)) {
    const auto wanted = hn::Set(u, view.layers);
    out = {};
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(u)) {
      const auto share = [&](std::size_t row) HWY_ATTR {
        const auto shared = hn::And(hn::Load(u, rows + row + i), wanted);
        return static_cast<std::uint32_t>(bits_of(u, hn::Ne(shared, hn::Zero(u)))) << i;
      };
      out.some |= share(LayerRows::kSome), out.all |= share(LayerRows::kEvery);
    }
  }
  const float* rows = map.distance_rows(number);
  if (!rows || out.some == 0) return out;
  ColumnBits near;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(f)) {
    const Distances d = distances_to(map.groups()[number], view, i);
    const auto between = [&](VF last, std::size_t min, VF first, std::size_t max) HWY_ATTR {
      const auto reached = hn::Ge(last, reach(rows + min + i, view)),
                 left = hn::Lt(first, reach(rows + max + i, view));
      return static_cast<std::uint32_t>(bits_of(f, hn::And(reached, left))) << i;
    };
    near.some |= between(d.farthest, DistanceRows::kFirstMin, d.nearest, DistanceRows::kLastMax);
    near.all |= between(d.nearest, DistanceRows::kLastMin, d.farthest, DistanceRows::kFirstMax);
  }
  return {out.some & near.some, out.all & near.all};
}

ObjectBits test_chunk_objects(const ChunkMap& map, const ChunkMap::Group& group,
                              const ChunkMap::ChunkView& chunk, const SectorView& view) {
  const F f;
  const U u;
  const std::uint32_t* layers = map.layer_rows(0) ? map.layers_of(group, chunk) : nullptr;
  std::size_t step = 0;
  const float* metres = map.distance_rows(0) ? map.distances_of(group, chunk, step) : nullptr;
  const auto wanted = hn::Set(u, view.layers);
  ObjectBits out;
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(f)) {
    auto seen = hn::FirstN(f, hn::Lanes(f));
    if (layers) seen = hn::RebindMask(f, hn::Ne(hn::And(hn::Load(u, layers + i), wanted), hn::Zero(u)));
    if (metres) {
      VF distance = hn::Zero(f);
      const auto add = [&](const float* low, const float* high, float eye) HWY_ATTR {
        const VF half = hn::Set(f, 0.5f);
        const VF centre = hn::Add(hn::Mul(half, hn::Load(f, low + i)), hn::Mul(half, hn::Load(f, high + i)));
        distance = hn::Add(distance, square(hn::Sub(centre, hn::Set(f, eye))));
      };
      add(chunk.min_x, chunk.max_x, view.distance_eye.x);
      add(chunk.min_y, chunk.max_y, view.distance_eye.y);
      add(chunk.min_z, chunk.max_z, view.distance_eye.z);
      const auto in_range = hn::And(hn::Ge(distance, reach(metres + i, view)),
                                    hn::Lt(distance, reach(metres + step + i, view)));
      seen = hn::And(seen, in_range);
    }
    out.words[i / 64] |= std::uint64_t{bits_of(f, seen)} << i % 64;
  }
  return out;
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(test_chunks);
HWY_EXPORT(test_chunk_objects);

namespace {

ColumnBits chunks(const ChunkMap& map, std::uint32_t group, const SectorView& view) {
  return HWY_DYNAMIC_DISPATCH(test_chunks)(map, group, view);
}

ObjectBits objects(const ChunkMap& map, const ChunkMap::Group& group, const ChunkMap::ChunkView& chunk,
                   const SectorView& view) {
  return HWY_DYNAMIC_DISPATCH(test_chunk_objects)(map, group, chunk, view);
}

}  // namespace

const ColumnTests& column_tests() noexcept {
  static constexpr ColumnTests tests{chunks, objects};
  return tests;
}

}  // namespace sightline::world
#endif
