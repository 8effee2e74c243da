#include "library/rays/wide_rays.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <new>
#include <utility>

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

#include "library/rays/packet_walk-inl.hpp"
#include "library/rays/wide_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::rays::HWY_NAMESPACE {

// Several rays by turns: while a node of one is on its way from memory, the others go on.
struct Turn {
  WideSlabs slabs;
  Way way;
  WideResult best;
  std::size_t ray;  // its index
};

// What rays met, by their indices.
struct Answers {
  ObjectId* object;
  float* distance;
  std::uint64_t hits = 0;

  void store(std::size_t ray, float t, ObjectId id) {
    const bool hit = id != kNoObject;
    object[ray] = id;
    distance[ray] = hit ? t : -1;
    hits += hit;
  }
};

// The rays at order[0] … order[count - 1], or the first `count` where there is no order.
HWY_INLINE void cast_by_turns(const WideNode* nodes, const PreparedRay* rays, const std::uint32_t* order,
                              std::size_t count, WideStack& stack, Work& work, Answers& answers) {
  std::uint64_t* stacks[kTurns];
  for (std::size_t i = 0; i < kTurns; ++i)
    stacks[i] = stack.entries.data() + i * (stack.entries.size() / kTurns);
  std::size_t next = 0, going = 0;
  alignas(Turn) unsigned char memory[kTurns * sizeof(Turn)];
  Turn* turns = reinterpret_cast<Turn*>(memory);
  // Puts the next ray that needs a walk into a place; false where there is none.
  const auto begin = [&](std::size_t place) {
    for (; next < count; ++next) {
      const std::size_t index = order ? order[next] : next;
      const PreparedRay& ray = rays[index];
      WideResult best{ray.max_distance, kNoObject};
      if (ray.inverse.x != 0 && ray.inverse.y != 0 && ray.inverse.z != 0) {
        new (&turns[place])
            Turn{{slab_of(ray.origin.x, ray.inverse.x, 0), slab_of(ray.origin.y, ray.inverse.y, 1),
                  slab_of(ray.origin.z, ray.inverse.z, 2)},
                 {WideNode::kInner},
                 best,
                 index};
        ++next;
        return true;
      }
      walk_as<true>(nodes, WideNode::kInner, ray, best, stacks[place], work);
      answers.store(index, best.distance, best.object);
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
      answers.store(turn.ray, turn.best.distance, turn.best.object);
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

#if HWY_TARGET != HWY_SCALAR
// Casts rays in packets of neighbours that point into one octant.
struct Packets {
  const WideNode* nodes;
  const PreparedRay* rays;
  WideStack& stack;
  Work& work;
  Answers& answers;

  Packets(const WideNode* of, const PreparedRay* given, WideStack& its_stack, Work& its_work, Answers& to)
      : nodes(of), rays(given), stack(its_stack), work(its_work), answers(to) {}

  // Sixteen rays.
  void cast(const std::uint32_t* all) {
    Packet packet;
    lay_out_rays(packet, all, kPacket);
    if (are_alike(packet)) return walk(packet, all, kPacket);
    const Octants octants(packet);
    leave_alone(all, octants.parallel);
    for (std::size_t octant = 0; octant < 8; ++octant) {
      std::uint32_t bits = octants.rays[octant], &count = waiting[octant];
      if (std::popcount(bits) < kFewestToBegin) {
        leave_alone(all, bits);
        continue;
      }
      for (; bits != 0; bits &= bits - 1) parted[octant][count++] = all[std::countr_zero(bits)];
      if (count < kPacket) continue;
      lay_out_rays(packet, parted[octant], kPacket);
      walk(packet, parted[octant], kPacket);
      count -= kPacket;
      std::copy_n(parted[octant] + kPacket, count, parted[octant]);
    }
  }
  // Those that still wait.
  void finish() {
    for (std::size_t octant = 0; octant < 8; ++octant) {
      if (waiting[octant] == 0) continue;
      Packet packet;
      lay_out_rays(packet, parted[octant], waiting[octant]);
      walk(packet, parted[octant], waiting[octant]);
    }
  }
  void leave_alone(const std::uint32_t* all, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) stack.alone.push_back(all[std::countr_zero(bits)]);
  }

private:
  // Of packets that parted, by octant: they go on with those of the next packets that part.
  std::uint32_t parted[8][2 * kPacket], waiting[8] = {};

  // The places of those that lack go to the first, and are over before they begin.
  void lay_out_rays(Packet& packet, const std::uint32_t* all, std::size_t count) const {
    for (std::size_t i = 0; i < kPacket; ++i) packet.rays[i] = &rays[all[i < count ? i : 0]];
    lay_out(packet);
    std::fill(packet.best + count, packet.best + kPacket, -1.0f);
  }
  void walk(Packet& packet, const std::uint32_t* all, std::size_t count) {
    walk_together(nodes, packet, ~0u >> (32 - count), stack.entries.data(), stack.rays.data(), work);
    for (std::size_t i = 0; i < count; ++i) answers.store(all[i], packet.best[i], packet.object[i]);
  }
};

// Whoever has no company is left to go by turns.
HWY_INLINE void cast_together(const WideNode* nodes, const PreparedRay* rays, const std::uint32_t* order,
                              std::size_t count, WideStack& stack, Work& work, Answers& answers) {
  stack.alone.clear();
  Packets packets(nodes, rays, stack, work, answers);
  std::uint32_t all[kPacket];
  for (std::size_t first = 0; first < count; first += kPacket) {
    const std::size_t some = std::min(kPacket, count - first);
    for (std::size_t i = 0; i < some; ++i)
      all[i] = order ? order[first + i] : static_cast<std::uint32_t>(first + i);
    some == kPacket ? packets.cast(all) : packets.leave_alone(all, (1u << some) - 1);
  }
  packets.finish();
  cast_by_turns(nodes, rays, stack.alone.data(), stack.alone.size(), stack, work, answers);
}
#else
constexpr auto cast_together = cast_by_turns;
#endif

void cast(const WideNode* nodes, const PreparedRay* rays, const std::uint32_t* order, std::size_t count,
          bool together, ObjectId* object, float* distance, WideStack* stack, RayStats* stats) {
  Work work;
  Answers answers{object, distance};
  together ? cast_together(nodes, rays, order, count, *stack, work, answers)
           : cast_by_turns(nodes, rays, order, count, *stack, work, answers);
  stats->hits += answers.hits;
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
