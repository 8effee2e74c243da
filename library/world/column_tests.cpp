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

ColumnBits layer_chunks(const ChunkMap& map, std::uint32_t number, const SectorView& view) {
  const U u;
  const std::uint32_t* rows = map.layer_rows(number);
  if (!rows) return {~0u, ~0u};
  const auto wanted = hn::Set(u, view.layers);
  ColumnBits out;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(u)) {
    const auto share = [&](std::size_t row) HWY_ATTR {
      const auto shared = hn::And(hn::Load(u, rows + row + i), wanted);
      return static_cast<std::uint32_t>(bits_of(u, hn::Ne(shared, hn::Zero(u)))) << i;
    };
    out.some |= share(LayerRows::kSome), out.all |= share(LayerRows::kEvery);
  }
  return out;
}

ColumnBits distance_chunks(const ChunkMap& map, std::uint32_t number, const SectorView& view) {
  const F f;
  const float* rows = map.distance_rows(number);
  ColumnBits out;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(f)) {
    const Distances d = distances_to(map.groups()[number], view, i);
    const auto between = [&](VF last, std::size_t min, VF first, std::size_t max) HWY_ATTR {
      const auto reached = hn::Ge(last, reach(rows + min + i, view)),
                 left = hn::Lt(first, reach(rows + max + i, view));
      return static_cast<std::uint32_t>(bits_of(f, hn::And(reached, left))) << i;
    };
    out.some |= between(d.farthest, DistanceRows::kFirstMin, d.nearest, DistanceRows::kLastMax);
    out.all |= between(d.nearest, DistanceRows::kLastMin, d.farthest, DistanceRows::kFirstMax);
  }
  return out;
}

ObjectBits layer_objects(const ChunkMap& map, const ChunkMap::Group& group, const ChunkMap::ChunkView& chunk,
                         const SectorView& view) {
  const U u;
  if (!map.layer_rows(0)) return {{~std::uint64_t{0}, ~std::uint64_t{0}}};
  const std::uint32_t* layers = map.layers_of(group, chunk);
  const auto wanted = hn::Set(u, view.layers);
  return bits_of_objects(chunk.count, [&](std::size_t i) HWY_ATTR {
    return hn::RebindMask(F(), hn::Ne(hn::And(hn::Load(u, layers + i), wanted), hn::Zero(u)));
  });
}

ObjectBits distance_objects(const ChunkMap& map, const ChunkMap::Group& group,
                            const ChunkMap::ChunkView& chunk, const SectorView& view) {
  std::size_t step = 0;
  const float* metres = map.distances_of(group, chunk, step);
  return bits_of_objects(chunk.count, [&](std::size_t i) HWY_ATTR {
    const VF distance = spheres_of(chunk, view.distance_eye, i).distance;
    return hn::And(hn::Ge(distance, reach(metres + i, view)),
                   hn::Lt(distance, reach(metres + step + i, view)));
  });
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(layer_chunks);
HWY_EXPORT(distance_chunks);
HWY_EXPORT(layer_objects);
HWY_EXPORT(distance_objects);

namespace {

ColumnBits chunks_by_layers(const ChunkMap& map, std::uint32_t group, const SectorView& view) {
  return HWY_DYNAMIC_DISPATCH(layer_chunks)(map, group, view);
}

ColumnBits chunks_by_both(const ChunkMap& map, std::uint32_t group, const SectorView& view) {
  const ColumnBits layers = chunks_by_layers(map, group, view);
  if (layers.some == 0) return layers;
  const ColumnBits near = HWY_DYNAMIC_DISPATCH(distance_chunks)(map, group, view);
  return {layers.some & near.some, layers.all & near.all};
}

ObjectBits objects_by_layers(const ChunkMap& map, const ChunkMap::Group& group,
                             const ChunkMap::ChunkView& chunk, const SectorView& view) {
  return HWY_DYNAMIC_DISPATCH(layer_objects)(map, group, chunk, view);
}

ObjectBits objects_by_both(const ChunkMap& map, const ChunkMap::Group& group,
                           const ChunkMap::ChunkView& chunk, const SectorView& view) {
  ObjectBits seen = objects_by_layers(map, group, chunk, view);
  seen.keep(HWY_DYNAMIC_DISPATCH(distance_objects)(map, group, chunk, view));
  return seen;
}

}  // namespace

constinit const ColumnTests kLayerTests{chunks_by_layers, objects_by_layers};
constinit const ColumnTests kDistanceTests{chunks_by_both, objects_by_both};

}  // namespace sightline::world
#endif
