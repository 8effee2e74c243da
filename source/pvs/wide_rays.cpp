#include "pvs/wide_rays.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pvs/wide_rays.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::pvs::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using partition::kWide;
using partition::WideNode;
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
    std::uint8_t some[8] = {};
    hn::StoreMaskBits(f, hit, some);
    bits |= std::uint32_t{some[0]} << part;
  }
  return bits;
}

// What waits: the distance's bits above, so that entries sort by it, and the child below.
HWY_INLINE std::uint64_t waiting(float distance, std::uint32_t child) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | child;
}

struct WideResult {
  float distance;
  ObjectId object;

  void offer(float t, ObjectId id) {
    if (t < distance || (t == distance && id < object)) distance = t, object = id;
  }
};

template <bool kParallel>
HWY_INLINE WideResult cast_one(const WideNode* nodes, const PreparedRay& ray, std::uint64_t* stack,
                               std::uint64_t& inner, std::uint64_t& leaves) {
  constexpr std::size_t x = 0, y = kWide, z = 2 * kWide, far = 3 * kWide;
  const WideSlab slabs[3] = {{ray.origin.x, ray.inverse.x, x, x + far},
                             {ray.origin.y, ray.inverse.y, y, y + far},
                             {ray.origin.z, ray.inverse.z, z, z + far}};
  alignas(64) float t[kWide];
  WideResult best{ray.max_distance, kNoObject};
  std::size_t waits = 0;
  std::uint32_t current = WideNode::kInner;
  while (true) {
    const WideNode& node = nodes[current & WideNode::kIndex];
    std::uint32_t bits = test<kParallel>(slabs, node, best.distance, t);
    if (current & WideNode::kLeaf) {
      ++leaves;
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        best.offer(t[lane], node.child[lane]);
      }
    } else {
      ++inner;
      const std::size_t before = waits;
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        const std::uint32_t child = node.child[lane];
        if (child < WideNode::kInner) {
          best.offer(t[lane], child);
          continue;
        }
        // Farthest at the bottom.
        const std::uint64_t entry = waiting(t[lane], child);
        std::size_t at = waits++;
        for (; at > before && stack[at - 1] < entry; --at) stack[at] = stack[at - 1];
        stack[at] = entry;
      }
    }
    // What is equally far may still hold a lower id.
    float distance;
    do {
      if (waits == 0) return best;
      const std::uint64_t next = stack[--waits];
      distance = std::bit_cast<float>(static_cast<std::uint32_t>(next >> 32));
      current = static_cast<std::uint32_t>(next);
    } while (distance > best.distance);
  }
}

void cast(const WideNode* nodes, const PreparedRay* rays, std::size_t count, ObjectId* object,
          float* distance, std::uint64_t* stack, RayStats* stats) {
  std::uint64_t inner = 0, leaves = 0, hits = 0;
  for (std::size_t r = 0; r < count; ++r) {
    const PreparedRay& ray = rays[r];
    const bool parallel = ray.inverse.x == 0 || ray.inverse.y == 0 || ray.inverse.z == 0;
    const WideResult best = parallel ? cast_one<true>(nodes, ray, stack, inner, leaves)
                                     : cast_one<false>(nodes, ray, stack, inner, leaves);
    const bool hit = best.object != kNoObject;
    object[r] = best.object;
    distance[r] = hit ? best.distance : -1;
    hits += hit;
  }
  stats->hits += hits;
  stats->nodes += inner * kWide;
  stats->boxes += leaves * kWide;
}

}  // namespace sightline::pvs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::pvs {

HWY_EXPORT(cast);

void cast_wide(const partition::WideBvh& bvh, std::span<const PreparedRay> rays, std::span<ObjectId> object,
               std::span<float> distance, WideStack& stack, RayStats& stats) {
  stats.rays += rays.size();
  if (bvh.nodes().empty()) {
    for (std::size_t r = 0; r < rays.size(); ++r) object[r] = kNoObject, distance[r] = -1;
    return;
  }
  if (stack.entries.size() < bvh.stack_size()) stack.entries.resize(bvh.stack_size());
  HWY_DYNAMIC_DISPATCH(cast)
  (bvh.nodes().data(), rays.data(), rays.size(), object.data(), distance.data(), stack.entries.data(),
   &stats);
}

void cast_wide(const partition::WideBvh& bvh, std::span<const PreparedRay> rays, WideStack& stack,
               RayHits& hits) {
  hits.reset(rays.size());
  hits.stats.rays = 0;
  cast_wide(bvh, rays, hits.object, hits.distance, stack, hits.stats);
}

}  // namespace sightline::pvs
#endif
