// Rays down a wide tree together, for every SIMD width. Included by files that foreach_target compiles again
// and again.
#if defined(SIGHTLINE_RAYS_PACKET_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RAYS_PACKET_WALK_INL
#undef SIGHTLINE_RAYS_PACKET_WALK_INL
#else
#define SIGHTLINE_RAYS_PACKET_WALK_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <sightline/rays.hpp>

#include "library/geometry/simd-inl.hpp"
#include "library/rays/wide_bvh.hpp"
#include "library/rays/wide_walk-inl.hpp"

// Where there are no vectors, nothing is gained.
#if HWY_TARGET != HWY_SCALAR

HWY_BEFORE_NAMESPACE();
namespace sightline::rays::HWY_NAMESPACE {

// Vectors of four floats wait for each other: more rays give them more to do.
constexpr std::size_t kPacket = HWY_TARGET == HWY_WASM ? 32 : 16;

// Rays that go down the tree together: where a node's boxes are met by any of them is found for eight boxes
// at once, and a box that may be met is tested with all rays at once.
using P = hn::CappedTag<float, kPacket>;
using PU = hn::RebindToUnsigned<P>;
using VP = hn::Vec<P>;

struct Packet {
  alignas(64) float origin[3][kPacket], inverse[3][kPacket];
  alignas(64) float best[kPacket];
  alignas(64) std::uint32_t object[kPacket];
  alignas(16) float least[8], most[8];  // over all rays: origin, inverse, max_distance
  const PreparedRay* rays[kPacket];
};
static_assert(sizeof(PreparedRay) == 7 * sizeof(float));

constexpr int kFewestTogether = 4;  // rays; fewer go on one by one
constexpr int kFewestToBegin = 8;   // of an octant, where a packet parts: rays from anywhere share no way

using Q = hn::CappedTag<float, 4>;
using VQ = hn::Vec<Q>;

// Four rows of four to four columns.
HWY_INLINE void transpose(VQ (&v)[4]) {
  const Q q;
  const VQ a = hn::InterleaveLower(q, v[0], v[2]), b = hn::InterleaveLower(q, v[1], v[3]),
           c = hn::InterleaveUpper(q, v[0], v[2]), d = hn::InterleaveUpper(q, v[1], v[3]);
  v[0] = hn::InterleaveLower(q, a, b), v[1] = hn::InterleaveUpper(q, a, b);
  v[2] = hn::InterleaveLower(q, c, d), v[3] = hn::InterleaveUpper(q, c, d);
}

// Lays out packet.rays.
HWY_INLINE void lay_out(Packet& packet) {
  const Q q;
  // Origin and inverse.x; inverse and max_distance.
  const auto load = [&](std::size_t i, std::size_t half) HWY_ATTR {
    return hn::LoadU(q, reinterpret_cast<const float*>(packet.rays[i]) + 3 * half);
  };
  for (std::size_t half = 0; half < 2; ++half) {
    VQ least = load(0, half), most = least;
    for (std::size_t i = 0; i < kPacket; i += 4) {
      VQ rows[4] = {load(i, half), load(i + 1, half), load(i + 2, half), load(i + 3, half)};
      least = hn::Min(least, hn::Min(hn::Min(rows[0], rows[1]), hn::Min(rows[2], rows[3])));
      most = hn::Max(most, hn::Max(hn::Max(rows[0], rows[1]), hn::Max(rows[2], rows[3])));
      transpose(rows);
      auto& to = half == 0 ? packet.origin : packet.inverse;
      for (std::size_t axis = 0; axis < 3; ++axis) hn::Store(rows[axis], q, to[axis] + i);
      if (half == 1) hn::Store(rows[3], q, packet.best + i);
    }
    hn::Store(least, q, packet.least + 4 * half);
    hn::Store(most, q, packet.most + 4 * half);
  }
  std::fill_n(packet.object, kPacket, kNoObject);
}

// All rays of a packet along one axis, whose directions have the same sign there: bounds on what any of them
// computes for a plane. Products of bounds round as those within them do.
struct BeamSlab {
  VF first_origin, last_origin;  // the ray's that meets a first plane soonest, a last plane latest
  VF least, most;                // of the inverse directions
  std::size_t first, last;       // as in WideSlab
};

struct Beam {
  BeamSlab slabs[3];
  VF exit;
};

HWY_INLINE Beam beam_of(const Packet& packet) {
  const F f;
  Beam beam;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t low = axis * kWide, high = low + 3 * kWide;
    const float least = packet.least[4 + axis], most = packet.most[4 + axis];
    const VF origins[2] = {hn::Set(f, packet.least[axis]), hn::Set(f, packet.most[axis])};
    const bool backwards = least < 0;
    beam.slabs[axis] = {origins[!backwards], origins[backwards],     hn::Set(f, least),
                        hn::Set(f, most),    backwards ? high : low, backwards ? low : high};
  }
  beam.exit = hn::Set(f, packet.most[7]);
  return beam;
}

// test() of eight boxes with a whole beam: a bit for each that a ray of it may meet, and in t no more than
// any of them computes.
HWY_INLINE std::uint32_t test(const Beam& beam, const WideNode& node, float* HWY_RESTRICT t) {
  const F f;
  const float* planes = node.min_x.data();
  std::uint32_t bits = 0;
  for (std::size_t part = 0; part < kWide; part += hn::Lanes(f)) {
    VF entry = hn::Zero(f), exit = beam.exit;
    for (const BeamSlab& slab : beam.slabs) {
      const VF first = hn::Sub(hn::Load(f, planes + slab.first + part), slab.first_origin),
               last = hn::Sub(hn::Load(f, planes + slab.last + part), slab.last_origin);
      entry = hn::Max(hn::Min(hn::Mul(first, slab.least), hn::Mul(first, slab.most)), entry);
      exit = hn::Min(hn::Max(hn::Mul(last, slab.least), hn::Mul(last, slab.most)), exit);
    }
    hn::Store(entry, f, t + part);
    bits |= bits_of(f, hn::Le(entry, exit)) << part;
  }
  return bits;
}

// intersect() of one box with a vector of rays from `part` on: which of them it meets no farther than `exit`,
// and where.
HWY_INLINE hn::Mask<P> meet(const Packet& packet, const Beam& beam, const float* box, std::size_t part,
                            VP exit, VP& entry) {
  const P p;
  entry = hn::Zero(p);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const VP origin = hn::Load(p, packet.origin[axis] + part),
             inverse = hn::Load(p, packet.inverse[axis] + part);
    const VP first = hn::Set(p, box[beam.slabs[axis].first]), last = hn::Set(p, box[beam.slabs[axis].last]);
    entry = hn::Max(hn::Mul(hn::Sub(first, origin), inverse), entry);
    exit = hn::Min(hn::Mul(hn::Sub(last, origin), inverse), exit);
  }
  return hn::Le(entry, exit);
}

// Whether none of the vector of rays from `part` on is among those `going`, where a packet takes several.
HWY_INLINE bool all_over(std::uint32_t going, std::size_t part) {
  const P p;
  return hn::Lanes(p) < kPacket && (going >> part & ~(~0u << hn::Lanes(p))) == 0;
}

// Which of the rays `going` meet a box.
HWY_INLINE std::uint32_t meeting(const Packet& packet, const Beam& beam, const float* box,
                                 std::uint32_t going) {
  const P p;
  std::uint32_t bits = 0;
  for (std::size_t part = 0; part < kPacket; part += hn::Lanes(p)) {
    if (all_over(going, part)) continue;
    VP entry;
    bits |= bits_of(p, meet(packet, beam, box, part, hn::Load(p, packet.best + part), entry)) << part;
  }
  return bits & going;
}

// Offers an object's box to the rays `going`, and to others that can meet nothing.
HWY_INLINE void offer(Packet& packet, const Beam& beam, const float* box, std::uint32_t going,
                      ObjectId object) {
  const P p;
  const PU pu;
  for (std::size_t part = 0; part < kPacket; part += hn::Lanes(p)) {
    if (all_over(going, part)) continue;
    const VP best = hn::Load(p, packet.best + part);
    const auto had = hn::Load(pu, packet.object + part), id = hn::Set(pu, object);
    VP entry;
    const auto hit = meet(packet, beam, box, part, best, entry);
    const auto lower = hn::RebindMask(p, hn::Lt(id, had));
    const auto nearer = hn::And(hit, hn::Or(hn::Lt(entry, best), lower));
    if (bits_of(p, nearer) == 0) continue;  // most miss
    hn::Store(hn::IfThenElse(nearer, entry, best), p, packet.best + part);
    hn::Store(hn::IfThenElse(hn::RebindMask(pu, nearer), id, had), pu, packet.object + part);
  }
}

// Each of the rays `going` by itself, from `start` down.
HWY_INLINE void walk_alone(const WideNode* nodes, std::uint32_t start, std::uint32_t going, Packet& packet,
                           std::uint64_t* stack, Work& work) {
  for (; going != 0; going &= going - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(going));
    WideResult alone{packet.best[i], packet.object[i]};
    walk(nodes, start, *packet.rays[i], alone, stack, work);
    packet.best[i] = alone.distance, packet.object[i] = alone.object;
  }
}

// Which of the rays `going` have met nothing nearer than `distance`.
HWY_INLINE std::uint32_t still_going(const Packet& packet, std::uint32_t going, float distance) {
  const P p;
  std::uint32_t bits = 0;
  for (std::size_t part = 0; part < kPacket; part += hn::Lanes(p))
    bits |= bits_of(p, hn::Ge(hn::Load(p, packet.best + part), hn::Set(p, distance))) << part;
  return bits & going;
}

// Their directions have the same signs, and none is 0. Others than those `going` can meet nothing.
void walk_together(const WideNode* nodes, Packet& packet, std::uint32_t going, std::uint64_t* stack,
                   std::uint32_t* stack_rays, Work& work) {
  const Beam beam = beam_of(packet);
  alignas(64) float t[kWide];
  std::size_t waits = 0;
  std::uint32_t current = WideNode::kInner;
  for (bool found = true; found;) {
    const WideNode& node = nodes[current & WideNode::kIndex];
    const float* planes = node.min_x.data();
    const bool leaf = (current & WideNode::kLeaf) != 0;
    (leaf ? work.leaves : work.inner) += static_cast<std::uint64_t>(std::popcount(going));
    const std::size_t before = waits;
    for (std::uint32_t bits = test(beam, node, t); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t child = node.child[lane];
      if (leaf || child < WideNode::kInner) {
        offer(packet, beam, planes + lane, going, child);
        continue;
      }
      const std::uint32_t met = meeting(packet, beam, planes + lane, going);
      if (met == 0) continue;
      const std::uint64_t entry = waiting(t[lane], child);
      std::size_t at = waits++;
      for (; at > before && stack[at - 1] < entry; --at)
        stack[at] = stack[at - 1], stack_rays[at] = stack_rays[at - 1];
      stack[at] = entry, stack_rays[at] = met;
    }
    for (found = false; !found && waits > 0;) {
      const std::uint64_t next = stack[--waits];
      const float distance = std::bit_cast<float>(static_cast<std::uint32_t>(next >> 32));
      current = static_cast<std::uint32_t>(next);
      going = still_going(packet, stack_rays[waits], distance);
      found = std::popcount(going) >= kFewestTogether;
      if (!found && going != 0) walk_alone(nodes, current, going, packet, stack + waits, work);
    }
  }
}

constexpr std::uint32_t kAll = ~0u >> (32 - kPacket);

// Whether all rays of a packet point into one octant, and none along a plane.
HWY_INLINE bool are_alike(const Packet& packet) {
  bool alike = true;
  for (std::size_t axis = 4; axis < 7; ++axis) alike &= packet.least[axis] > 0 || packet.most[axis] < 0;
  return alike;
}

// Which rays of a packet point into which octant, and in `parallel` those that point along a plane.
struct Octants {
  std::uint32_t rays[8] = {}, parallel = 0;

  explicit Octants(const Packet& packet) {
    const P p;
    std::uint32_t negative[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t part = 0; part < kPacket; part += hn::Lanes(p)) {
        const VP inverse = hn::Load(p, packet.inverse[axis] + part);
        negative[axis] |= bits_of(p, hn::Lt(inverse, hn::Zero(p))) << part;
        parallel |= bits_of(p, hn::Eq(inverse, hn::Zero(p))) << part;
      }
    }
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      rays[octant] = kAll & ~parallel;
      for (std::uint32_t axis = 0; axis < 3; ++axis)
        rays[octant] &= (octant >> axis & 1) != 0 ? negative[axis] : ~negative[axis];
    }
  }
};

}  // namespace sightline::rays::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // HWY_SCALAR

#endif
