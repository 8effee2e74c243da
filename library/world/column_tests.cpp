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
  if (!map.layer_summaries().empty()) {
    const LayerSummary& s = map.layer_summaries()[number];
    const auto wanted = hn::Set(u, view.layers);
    std::uint32_t some = 0, all = 0;
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(u)) {
      const auto shared = [&](const std::uint32_t* layers) HWY_ATTR {
        return bits_of(u, hn::Ne(hn::And(hn::Load(u, layers + i), wanted), hn::Zero(u)));
      };
      some |= static_cast<std::uint32_t>(shared(s.some.data())) << i;
      all |= static_cast<std::uint32_t>(shared(s.every.data())) << i;
    }
    out = {some, all};
  }
  if (map.distance_summaries().empty() || out.some == 0) return out;
  const DistanceSummary& s = map.distance_summaries()[number];
  const ChunkMap::Group& group = map.groups()[number];
  std::uint32_t some = 0, all = 0;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(f)) {
    const Distances d = distances_to(group, view, i);
    const auto reached = hn::And(hn::Ge(d.farthest, reach(&s.first_min[i], view)),
                                 hn::Lt(d.nearest, reach(&s.last_max[i], view)));
    const auto inside = hn::And(hn::Ge(d.nearest, reach(&s.last_min[i], view)),
                                hn::Lt(d.farthest, reach(&s.first_max[i], view)));
    some |= static_cast<std::uint32_t>(bits_of(f, reached)) << i;
    all |= static_cast<std::uint32_t>(bits_of(f, inside)) << i;
  }
  return {out.some & some, out.all & all};
}

ObjectBits test_chunk_objects(const ChunkMap& map, const ChunkMap::Group& group,
                              const ChunkMap::ChunkView& chunk, const SectorView& view) {
  const F f;
  const U u;
  const bool by_layers = !map.layer_summaries().empty(), by_distance = !map.distance_summaries().empty();
  const std::uint32_t* layers = by_layers ? map.layers_of(group, chunk) : nullptr;
  std::size_t step = 0;
  const float* metres = by_distance ? map.distances_of(group, chunk, step) : nullptr;
  const auto wanted = hn::Set(u, view.layers);
  return test_objects(chunk, nullptr, 0, [&](std::size_t i, hn::Mask<F> seen) HWY_ATTR {
    if (by_layers) {
      const auto shared = hn::Ne(hn::And(hn::Load(u, layers + i), wanted), hn::Zero(u));
      seen = hn::And(seen, hn::RebindMask(f, shared));
    }
    if (!by_distance) return seen;
    VF distance = hn::Zero(f);
    const auto add = [&](const float* low, const float* high, float eye) HWY_ATTR {
      const VF half = hn::Set(f, 0.5f);
      const VF centre = hn::Add(hn::Mul(half, hn::Load(f, low + i)), hn::Mul(half, hn::Load(f, high + i)));
      distance = hn::Add(distance, square(hn::Sub(centre, hn::Set(f, eye))));
    };
    add(chunk.min_x, chunk.max_x, view.distance_eye.x);
    add(chunk.min_y, chunk.max_y, view.distance_eye.y);
    add(chunk.min_z, chunk.max_z, view.distance_eye.z);
    return hn::And(seen, hn::And(hn::Ge(distance, reach(metres + i, view)),
                                 hn::Lt(distance, reach(metres + step + i, view))));
  });
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
