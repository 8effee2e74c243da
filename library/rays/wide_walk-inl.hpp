// One ray down a wide tree, for every SIMD width. Included by files that foreach_target compiles again and
// again.
#if defined(SIGHTLINE_RAYS_WIDE_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RAYS_WIDE_WALK_INL
#undef SIGHTLINE_RAYS_WIDE_WALK_INL
#else
#define SIGHTLINE_RAYS_WIDE_WALK_INL
#endif

#include <hwy/highway.h>

#include <bit>

#include <sightline/rays.hpp>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/mutant.h"
#include "library/geometry/simd-inl.hpp"
#include "library/rays/wide_bvh.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::rays::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using geometry::prefetch_lines;
using geometry::HWY_NAMESPACE::bits_of;
using F = hn::CappedTag<float, kWide>;
using VF = hn::Vec<F>;

// One slab of a ray, spread over the lanes: which of a box's planes it meets first is the same for all boxes.
struct WideSlab {
  VF origin, inverse;
  std::size_t first, last;  // offset in floats from the node's start to the planes met first and last
  bool parallel;

  WideSlab(float o, float i, std::size_t low, std::size_t high)
      : origin(hn::Set(F(), o)),
        inverse(hn::Set(F(), i)),
        first(i < 0 ? high : low),
        last(i < 0 ? low : high),
        parallel(i == 0) {}
};

// intersect() of eight boxes: writes their distances, returns a bit for each that is hit no farther than
// `limit`.
template <bool kParallel>
HWY_INLINE std::uint32_t test(const WideSlab (&slabs)[3], const WideNode& node, float limit,
                              float* HWY_RESTRICT t) {
  const F f;
  const float* planes = node.min_x.data();
  std::uint32_t bits = 0;
  for (std::size_t part = 0; part < kWide; part += hn::Lanes(f)) {
    VF entry = hn::Zero(f), exit = hn::Set(f, limit);
    auto inside = hn::Eq(entry, entry);
    for (const WideSlab& slab : slabs) {
      const VF first = hn::Load(f, planes + slab.first + part), last = hn::Load(f, planes + slab.last + part);
      if (kParallel && slab.parallel) {
        inside = hn::And(inside, hn::And(hn::Ge(slab.origin, first), hn::Le(slab.origin, last)));
        continue;
      }
      entry = hn::Max(hn::Mul(hn::Sub(first, slab.origin), slab.inverse), entry);
      exit = hn::Min(hn::Mul(hn::Sub(last, slab.origin), slab.inverse), exit);
    }
    auto hit = hn::Le(entry, exit);
    if (kParallel) hit = hn::And(hit, inside);
    hn::Store(entry, f, t + part);
    bits |= bits_of(f, hit) << part;
  }
  return bits;
}

// What waits: the distance's bits above, so that entries sort by it, and the child below.
HWY_INLINE std::uint64_t waiting(float distance, std::uint32_t child) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | child;
}

// The nearest box so far, of equally near ones the lowest.
struct WideResult {
  float distance;
  ObjectId object;

  void offer(float t, ObjectId id) {
    if (t < distance ||
        (t == distance && (SIGHTLINE_MUTANT(ray_ties_to_the_higher) ? id > object : id < object)))
      distance = t, object = id;
  }
};

struct Work {
  std::uint64_t inner = 0, leaves = 0;  // nodes looked at, times rays
};

using WideSlabs = WideSlab[3];

HWY_INLINE WideSlab slab_of(float origin, float inverse, std::size_t axis) {
  return {origin, inverse, axis * kWide, (axis + 3) * kWide};
}

// Where a ray is on its way down: the node it looks at, and what waits.
struct Way {
  std::uint32_t current;
  std::size_t waits = 0;
};

// Looks at one node, offers each box that is met to `found`, and goes on to the nearest that waits. `found`
// says in `distance` up to where that matters. False at the end of the way.
template <bool kParallel, class Found>
HWY_INLINE bool step(const WideNode* nodes, const WideSlabs& slabs, Way& way, Found& found,
                     std::uint64_t* stack, Work& work) {
  alignas(64) float t[kWide];
  const WideNode& node = nodes[way.current & WideNode::kIndex];
  std::uint32_t bits = test<kParallel>(slabs, node, found.distance, t);
  if (way.current & WideNode::kLeaf) {
    ++work.leaves;
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      found.offer(t[lane], node.child[lane]);
    }
  } else {
    ++work.inner;
    const std::size_t before = way.waits;
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t child = node.child[lane];
      if (child < WideNode::kInner) {
        found.offer(t[lane], child);
        continue;
      }
      // Farthest at the bottom.
      const std::uint64_t entry = waiting(t[lane], child);
      std::size_t at = way.waits++;
      for (; at > before && stack[at - 1] < entry; --at) stack[at] = stack[at - 1];
      stack[at] = entry;
    }
  }
  // What is equally far may still hold a lower id.
  float distance;
  do {
    if (way.waits == 0) return false;
    const std::uint64_t next = stack[--way.waits];
    distance = std::bit_cast<float>(static_cast<std::uint32_t>(next >> 32));
    way.current = static_cast<std::uint32_t>(next);
  } while (SIGHTLINE_MUTANT(ray_ties_not_looked_for) ? distance >= found.distance
                                                     : distance > found.distance);
  return true;
}

// Walks what is below `start` with one ray, nearest nodes first.
template <bool kParallel, class Found>
HWY_INLINE void walk_as(const WideNode* nodes, std::uint32_t start, const PreparedRay& ray, Found& found,
                        std::uint64_t* stack, Work& work) {
  const WideSlabs slabs = {slab_of(ray.origin.x, ray.inverse.x, 0), slab_of(ray.origin.y, ray.inverse.y, 1),
                           slab_of(ray.origin.z, ray.inverse.z, 2)};
  Way way{start};
  while (step<kParallel>(nodes, slabs, way, found, stack, work)) {
  }
}

template <class Found>
HWY_INLINE void walk(const WideNode* nodes, std::uint32_t start, const PreparedRay& ray, Found& found,
                     std::uint64_t* stack, Work& work) {
  const bool parallel = ray.inverse.x == 0 || ray.inverse.y == 0 || ray.inverse.z == 0;
  parallel ? walk_as<true>(nodes, start, ray, found, stack, work)
           : walk_as<false>(nodes, start, ray, found, stack, work);
}

}  // namespace sightline::rays::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
