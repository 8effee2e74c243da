#include "library/rays/wide_rays.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <new>
#include <utility>

#include "library/geometry/mutant.h"

#ifndef SIGHTLINE_RAYS_WIDE_TURNS
#define SIGHTLINE_RAYS_WIDE_TURNS
namespace sightline::rays {
constexpr std::size_t kTurns = 16;  // rays that wait for memory together, where each goes its own way
}
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/rays/wide_rays.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/rays/wide_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::rays::HWY_NAMESPACE {

constexpr std::size_t kPacket = 16;

struct WideResult {
  float distance;
  ObjectId object;

  void offer(float t, ObjectId id) {
    if (t < distance ||
        (t == distance && (SIGHTLINE_MUTANT(ray_ties_to_the_higher) ? id > object : id < object)))
      distance = t, object = id;
  }
};

// As many rays as a vector has lanes, going down the tree together: a box is tested against all at once, and
// where few are left that meet a node, each goes on alone.
using P = hn::CappedTag<float, kPacket>;
using PU = hn::RebindToUnsigned<P>;
using VP = hn::Vec<P>;

struct Packet {
  alignas(64) float origin[3][kPacket], inverse[3][kPacket];
  alignas(64) float best[kPacket];
  alignas(64) std::uint32_t object[kPacket];
};

constexpr int kFewestTogether = 4;  // rays; fewer go on one by one

struct PacketSlab {
  VP origin, inverse;
  std::size_t first, last;
};

HWY_INLINE void spread_slabs(const Packet& packet, PacketSlab (&slabs)[3]) {
  const P p;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t low = axis * kWide, high = low + 3 * kWide;
    const bool backwards = packet.inverse[axis][0] < 0;
    slabs[axis] = {hn::Load(p, packet.origin[axis]), hn::Load(p, packet.inverse[axis]),
                   backwards ? high : low, backwards ? low : high};
  }
}

// intersect() of one box with all rays: which of them it meets no farther than `exit`, and where.
HWY_INLINE hn::Mask<P> meet(const PacketSlab (&slabs)[3], const float* planes, std::uint32_t lane, VP exit,
                            VP& entry) {
  const P p;
  entry = hn::Zero(p);
  for (const PacketSlab& slab : slabs) {
    const VP first = hn::Set(p, planes[slab.first + lane]), last = hn::Set(p, planes[slab.last + lane]);
    entry = hn::Max(hn::Mul(hn::Sub(first, slab.origin), slab.inverse), entry);
    exit = hn::Min(hn::Mul(hn::Sub(last, slab.origin), slab.inverse), exit);
  }
  return hn::Le(entry, exit);
}

// Each of the rays `going` by itself, from `start` down.
HWY_INLINE void walk_alone(const WideNode* nodes, std::uint32_t start, std::uint32_t going, Packet& packet,
                           const PreparedRay* const* rays, std::uint64_t* stack, Work& work) {
  for (; going != 0; going &= going - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(going));
    WideResult alone{packet.best[i], packet.object[i]};
    walk_as<false>(nodes, start, *rays[i], alone, stack, work);
    packet.best[i] = alone.distance, packet.object[i] = alone.object;
  }
}

// All directions have the same signs, and none is 0.
HWY_INLINE void cast_packet(const WideNode* nodes, Packet& packet, const PreparedRay* const* rays,
                            std::uint64_t* stack, std::uint32_t* stack_rays, Work& work) {
  const P p;
  const PU pu;
  PacketSlab slabs[3];
  spread_slabs(packet, slabs);
  VP best = hn::Load(p, packet.best);
  auto object = hn::Load(pu, packet.object);
  std::size_t waits = 0;
  std::uint32_t current = WideNode::kInner;
  bool found = true;
  while (found) {
    const WideNode& node = nodes[current & WideNode::kIndex];
    const bool leaf = (current & WideNode::kLeaf) != 0;
    (leaf ? work.leaves : work.inner) += hn::Lanes(p);
    const std::size_t before = waits;
    for (std::uint32_t lane = 0; lane < kWide; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == kNoObject) break;  // filled from the first lane on
      VP entry;
      const auto hit = meet(slabs, node.min_x.data(), lane, best, entry);
      if (leaf || child < WideNode::kInner) {
        const auto id = hn::Set(pu, child);
        const auto lower = hn::RebindMask(p, hn::Lt(id, object));
        const auto nearer = hn::And(hit, hn::Or(hn::Lt(entry, best), lower));
        best = hn::IfThenElse(nearer, entry, best);
        object = hn::IfThenElse(hn::RebindMask(pu, nearer), id, object);
        continue;
      }
      const std::uint32_t meeting = bits_of(p, hit);
      if (meeting == 0) continue;
      const auto far = hn::Set(p, std::numeric_limits<float>::max());
      const float nearest = hn::GetLane(hn::MinOfLanes(p, hn::IfThenElse(hit, entry, far)));
      const std::uint64_t waiting_entry = waiting(nearest, child);
      std::size_t at = waits++;
      for (; at > before && stack[at - 1] < waiting_entry; --at)
        stack[at] = stack[at - 1], stack_rays[at] = stack_rays[at - 1];
      stack[at] = waiting_entry, stack_rays[at] = meeting;
    }
    for (found = false; !found && waits > 0;) {
      const std::uint64_t next = stack[--waits];
      const float distance = std::bit_cast<float>(static_cast<std::uint32_t>(next >> 32));
      current = static_cast<std::uint32_t>(next);
      const std::uint32_t going = stack_rays[waits] & bits_of(p, hn::Ge(best, hn::Set(p, distance)));
      found = std::popcount(going) >= kFewestTogether;
      if (found || going == 0) continue;
      hn::Store(best, p, packet.best);
      hn::Store(object, pu, packet.object);
      walk_alone(nodes, current, going, packet, rays, stack + waits, work);
      best = hn::Load(p, packet.best);
      object = hn::Load(pu, packet.object);
    }
  }
  hn::Store(best, p, packet.best);
  hn::Store(object, pu, packet.object);
}

// Several rays by turns: while a node of one is on its way from memory, the others go on.
struct Turn {
  WideSlabs slabs;
  Way way;
  WideResult best;
  std::size_t ray;
};

bool same_signs(const Packet& packet, std::size_t lanes) {
  for (const auto& inverse : packet.inverse) {
    for (std::size_t i = 0; i < lanes; ++i) {
      if (inverse[i] == 0 || (inverse[i] < 0) != (inverse[0] < 0)) return false;
    }
  }
  return true;
}

template <class Store>
HWY_INLINE void cast_by_turns(const WideNode* nodes, const PreparedRay* rays, const std::uint32_t* order,
                              std::size_t count, WideStack* stack, Work& work, const Store& store) {
  std::uint64_t* stacks[kTurns];
  for (std::size_t i = 0; i < kTurns; ++i)
    stacks[i] = stack->entries.data() + i * (stack->entries.size() / kTurns);
  std::size_t next = 0, going = 0;
  alignas(Turn) unsigned char memory[kTurns * sizeof(Turn)];
  Turn* turns = reinterpret_cast<Turn*>(memory);
  // Puts the next ray that needs a walk into a place; false where there is none.
  const auto begin = [&](std::size_t place) {
    while (next < count) {
      const std::size_t turn = next++;
      const PreparedRay& ray = rays[order ? order[turn] : turn];
      WideResult best{ray.max_distance, kNoObject};
      if (ray.inverse.x == 0 || ray.inverse.y == 0 || ray.inverse.z == 0) {
        walk_as<true>(nodes, WideNode::kInner, ray, best, stacks[place], work);
        store(turn, best.distance, best.object);
        continue;
      }
      new (&turns[place])
          Turn{{slab_of(ray.origin.x, ray.inverse.x, 0), slab_of(ray.origin.y, ray.inverse.y, 1),
                slab_of(ray.origin.z, ray.inverse.z, 2)},
               {WideNode::kInner},
               best,
               turn};
      return true;
    }
    return false;
  };
  while (going < kTurns && begin(going)) ++going;
  while (going > 0) {
    for (std::size_t place = 0; place < going;) {
      Turn& turn = turns[place];
      if (step<false>(nodes, turn.slabs, turn.way, turn.best, stacks[place], work)) {
        prefetch_lines(nodes[turn.way.current & WideNode::kIndex]);
        ++place;
        continue;
      }
      store(turn.ray, turn.best.distance, turn.best.object);
      if (begin(place)) {
        ++place;
      } else if (--going != place) {
        // The last one moves into the gap, and keeps its stack.
        new (&turns[place]) Turn(turns[going]);
        std::swap(stacks[place], stacks[going]);
      }
    }
  }
}

void cast(const WideNode* nodes, const PreparedRay* rays, const std::uint32_t* order, std::size_t count,
          bool together, ObjectId* object, float* distance, WideStack* stack, RayStats* stats) {
  Work work;
  std::uint64_t hits = 0;
  const std::size_t lanes = hn::Lanes(P());
  std::size_t r = 0;
  const auto at_turn = [&](std::size_t turn) { return order ? order[turn] : turn; };
  const auto store = [&](std::size_t turn, float t, ObjectId id) {
    const std::size_t at = at_turn(turn);
    const bool hit = id != kNoObject;
    object[at] = id;
    distance[at] = hit ? t : -1;
    hits += hit;
  };
  if (!together) {
    cast_by_turns(nodes, rays, order, count, stack, work, store);
    r = count;
  }
  while (r < count) {
    Packet packet;
    const PreparedRay* members[kPacket];
    if (lanes >= 8 && count - r >= lanes) {
      for (std::size_t i = 0; i < lanes; ++i) {
        const PreparedRay& ray = rays[at_turn(r + i)];
        members[i] = &ray;
        packet.origin[0][i] = ray.origin.x, packet.inverse[0][i] = ray.inverse.x;
        packet.origin[1][i] = ray.origin.y, packet.inverse[1][i] = ray.inverse.y;
        packet.origin[2][i] = ray.origin.z, packet.inverse[2][i] = ray.inverse.z;
        packet.best[i] = ray.max_distance, packet.object[i] = kNoObject;
      }
      if (same_signs(packet, lanes)) {
        cast_packet(nodes, packet, members, stack->entries.data(), stack->rays.data(), work);
        for (std::size_t i = 0; i < lanes; ++i) store(r + i, packet.best[i], packet.object[i]);
        r += lanes;
        continue;
      }
    }
    const PreparedRay& ray = rays[at_turn(r)];
    WideResult best{ray.max_distance, kNoObject};
    walk(nodes, WideNode::kInner, ray, best, stack->entries.data(), work);
    store(r, best.distance, best.object);
    ++r;
  }
  stats->hits += hits;
  stats->nodes += work.inner * kWide;
  stats->boxes += work.leaves * kWide;
}

}  // namespace sightline::rays::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::rays {

HWY_EXPORT(cast);

namespace {

// With many more objects than rays even neighbours part soon, and a packet only drags them along.
bool go_together(const rays::WideBvh& bvh, std::size_t rays) {
  constexpr std::size_t kObjectsARay = 16;
  return bvh.size() < kObjectsARay * rays;
}

// Enough for rays by turns; and a ray that leaves its packet walks on above what waits for the packet.
void grow(WideStack& stack, const rays::WideBvh& bvh) {
  const std::size_t room = kTurns * std::size_t{bvh.stack_size()};
  if (stack.entries.size() < room) stack.entries.resize(room), stack.rays.resize(room);
}

}  // namespace

void cast_wide(const rays::WideBvh& bvh, std::span<const PreparedRay> rays,
               std::span<const std::uint32_t> order, std::span<ObjectId> object, std::span<float> distance,
               WideStack& stack, RayStats& stats) {
  const std::size_t count = order.empty() ? rays.size() : order.size();
  stats.rays += count;
  if (bvh.nodes().empty()) {
    for (std::size_t r = 0; r < rays.size(); ++r) object[r] = kNoObject, distance[r] = -1;
    return;
  }
  grow(stack, bvh);
  HWY_DYNAMIC_DISPATCH(cast)
  (bvh.nodes().data(), rays.data(), order.empty() ? nullptr : order.data(), count, go_together(bvh, count),
   object.data(), distance.data(), &stack, &stats);
}

void cast_wide(const rays::WideBvh& bvh, const RayGrid& grid, WideStack& stack, RayHits& hits) {
  hits.reset(grid.size());
  hits.stats.rays = 0;
  cast_wide(bvh, grid.prepared, grid.order, hits.object, hits.distance, stack, hits.stats);
}

namespace {

// Rays that jobs cast some of at a time, each the next that nobody has begun. The pieces are the same for any
// number of jobs, and so are the packets: the work is, too.
struct SharedRays {
  static constexpr std::size_t kPiece = 1024;

  const rays::WideBvh& bvh;
  std::span<const PreparedRay> rays;
  std::span<const std::uint32_t> order;  // all rays
  ObjectId* object;
  float* distance;
  std::span<WideStack> stacks;
  bool together;
  std::atomic<std::size_t> next{0};
  std::atomic<std::uint64_t> met{0}, nodes{0}, boxes{0};

  void cast_pieces(std::uint32_t job) {
    WideStack& stack = stacks[job];
    grow(stack, bvh);
    RayStats stats;
    const std::size_t count = order.size();
    for (std::size_t at; (at = next.fetch_add(kPiece, std::memory_order_relaxed)) < count;) {
      HWY_DYNAMIC_DISPATCH(cast)
      (bvh.nodes().data(), rays.data(), order.data() + at, std::min(kPiece, count - at), together, object,
       distance, &stack, &stats);
    }
    met += stats.hits, nodes += stats.nodes, boxes += stats.boxes;
  }
};

}  // namespace

void cast_wide(const rays::WideBvh& bvh, std::span<const PreparedRay> rays,
               std::span<const std::uint32_t> order, const JobSystem& jobs, std::span<WideStack> stacks,
               std::span<ObjectId> object, std::span<float> distance, RayStats& stats) {
  stats.rays += order.size();
  std::fill_n(object.begin(), rays.size(), kNoObject);
  std::fill_n(distance.begin(), rays.size(), -1.0f);
  if (bvh.nodes().empty()) return;
  SharedRays shared{bvh, rays, order, object.data(), distance.data(), stacks, go_together(bvh, order.size())};
  const auto run = [](void* data, std::uint32_t job) { static_cast<SharedRays*>(data)->cast_pieces(job); };
  const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(jobs.threads, stacks.size()));
  if (jobs.run && count > 1) {
    jobs.run(jobs.user, count, run, &shared);
  } else {
    run(&shared, 0);
  }
  stats.hits += shared.met, stats.nodes += shared.nodes, stats.boxes += shared.boxes;
}

void cast_wide(const rays::WideBvh& bvh, const RayGrid& grid, const JobSystem& jobs,
               std::span<WideStack> stacks, RayHits& hits) {
  hits.object.resize(grid.size()), hits.distance.resize(grid.size());
  hits.stats = {};
  cast_wide(bvh, grid.prepared, grid.order, jobs, stacks, hits.object, hits.distance, hits.stats);
}

}  // namespace sightline::rays
#endif
