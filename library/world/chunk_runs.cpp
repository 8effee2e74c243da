// Movers that are listed in the order in which they stand: whole rows of boxes at a time.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/chunk_runs.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/box_math.hpp"
#include "library/geometry/simd-inl.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/chunk_runs.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using U = hn::RebindToUnsigned<F>;
using geometry::HWY_NAMESPACE::bits_of;

// A bit a box that lies within the bounds, of at most 64.
HWY_INLINE std::uint64_t held_boxes(const std::array<const float*, 6>& from, const Box& bounds,
                                    std::uint32_t count) {
  const F f;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(f));
  const auto low_x = hn::Set(f, bounds.min.x), low_y = hn::Set(f, bounds.min.y),
             low_z = hn::Set(f, bounds.min.z), high_x = hn::Set(f, bounds.max.x),
             high_y = hn::Set(f, bounds.max.y), high_z = hn::Set(f, bounds.max.z);
  std::uint64_t bits = 0;
  std::uint32_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto at = [&](std::size_t side) HWY_ATTR { return hn::LoadU(f, from[side] + i); };
    const auto below = hn::Or(hn::Lt(at(0), low_x), hn::Or(hn::Lt(at(1), low_y), hn::Lt(at(2), low_z)));
    const auto above = hn::Or(hn::Gt(at(3), high_x), hn::Or(hn::Gt(at(4), high_y), hn::Gt(at(5), high_z)));
    bits |= std::uint64_t{bits_of(f, hn::Not(hn::Or(below, above)))} << i;
  }
  for (; i < count; ++i) {
    const bool held = from[0][i] >= bounds.min.x && from[1][i] >= bounds.min.y &&
                      from[2][i] >= bounds.min.z && from[3][i] <= bounds.max.x &&
                      from[4][i] <= bounds.max.y && from[5][i] <= bounds.max.z;
    bits |= std::uint64_t{held} << i;
  }
  return bits;
}

// Where the id stands among the next ones of a chunk; kNowhere beyond some vectors.
constexpr std::uint32_t kNowhere = 0xffffffffu;
HWY_INLINE std::uint32_t find_id(const ObjectId* ids, ObjectId wanted, std::uint32_t count) {
  const U u;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(u));
  constexpr std::uint32_t kReach = 32;
  const auto id = hn::Set(u, wanted);
  std::uint32_t i = 0;
  for (; i + lanes <= count && i < kReach; i += lanes) {
    const std::intptr_t at = hn::FindFirstTrue(u, hn::Eq(hn::LoadU(u, ids + i), id));
    if (at >= 0) return i + static_cast<std::uint32_t>(at);
  }
  for (; i < count && i < kReach; ++i) {
    if (ids[i] == wanted) return i;
  }
  return kNowhere;
}

// Writes from slot on; returns how many of the objects, and the slot behind the last.
std::uint32_t write_run(const MoverRun& run, std::uint32_t& slot, const ObjectId* HWY_RESTRICT objects,
                        const std::array<const float*, 6>& from, std::uint32_t count) {
  const F f;
  const U u;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(f));
  const std::uint64_t held = held_boxes(from, run.bounds, count);
  std::array<std::uint64_t, 2> moved{run.moved[0], run.moved[1]};
  const std::uint64_t whole = (std::uint64_t{1} << lanes) - 1;
  std::uint32_t i = 0, at = slot;
  bool dense = true;
  while (i < count) {
    // A vector of neighbours, as long as they follow one another.
    dense = dense && i + lanes <= count && at + lanes <= run.count && (held >> i & whole) == whole &&
            hn::AllTrue(u, hn::Eq(hn::LoadU(u, run.ids + at), hn::LoadU(u, objects + i)));
    if (dense) {
      const bool past_cache = run.past_cache && at % lanes == 0;
      for (std::size_t side = 0; side < 6; ++side) {
        const auto values = hn::LoadU(f, from[side] + i);
        float* const to = run.boxes + side * run.row + at;
        past_cache ? hn::Stream(values, f, to) : hn::StoreU(values, f, to);
      }
      moved[at / 64] |= whole << at % 64;
      if (at % 64 + lanes > 64) moved[1] |= whole >> (64 - at % 64);
      i += lanes, at += lanes;
      continue;
    }
    const std::uint32_t next = at < run.count ? find_id(run.ids + at, objects[i], run.count - at) : kNowhere;
    if (next == kNowhere || !(held >> i & 1)) break;
    at += next;
    for (std::size_t side = 0; side < 6; ++side) run.boxes[side * run.row + at] = from[side][i];
    moved[at / 64] |= std::uint64_t{1} << at % 64;
    ++i, ++at;
  }
  run.moved[0] = moved[0], run.moved[1] = moved[1];
  slot = at;
  return i;
}

// Whether boxes lie within two.
#if HWY_TARGET == HWY_SCALAR  // which has no vectors of four
class WithinBoth {
public:
  WithinBoth(const Box& a, const Box& b) : box_(geometry::intersected(a, b)) {}
  HWY_INLINE bool operator()(const Box& box) const { return geometry::holds(box_, box); }

private:
  Box box_;
};
#else
class WithinBoth {
public:
  WithinBoth(const Box& a, const Box& b)
      : low_(hn::Max(from_min_x(a), from_min_x(b))), high_(hn::Min(from_min_z(a), from_min_z(b))) {}
  HWY_INLINE bool operator()(const Box& box) const {
    const F4 f;
    const auto above = hn::Or(hn::Ge(from_min_x(box), low_), hn::Not(hn::FirstN(f, 3))),
               below = hn::Or(hn::Le(from_min_z(box), high_), hn::FirstN(f, 1));
    return hn::AllTrue(f, hn::And(above, below));
  }

private:
  using F4 = hn::FixedTag<float, 4>;
  // Of the first four and the last four coordinates three are asked for, the minima and the maxima.
  static HWY_INLINE hn::Vec<F4> from_min_x(const Box& box) { return hn::LoadU(F4(), &box.min.x); }
  static HWY_INLINE hn::Vec<F4> from_min_z(const Box& box) { return hn::LoadU(F4(), &box.min.z); }
  hn::Vec<F4> low_, high_;
};
#endif

std::uint32_t write_in_page(const PageRun& run, const ObjectId* objects, const Box* boxes,
                            std::uint32_t count) {
  const WithinBoth within(run.bounds, run.within);
  const ObjectId first = run.first;
  const ObjectId* const ids = run.ids;
  float* const low = run.boxes;
  float* const high = run.boxes + 3 * run.row;
  const std::size_t row = run.row;
  std::array<std::uint64_t, 2> moved{};
  std::uint32_t i = 0;
  for (; i < count; ++i) {
    const std::uint32_t slot = objects[i] - first;
    if (slot >= ChunkMap::kCapacity || (ids && ids[slot] != objects[i]) || !within(boxes[i])) break;
    const Box& box = boxes[i];
    low[slot] = box.min.x, low[row + slot] = box.min.y, low[2 * row + slot] = box.min.z;
    high[slot] = box.max.x, high[row + slot] = box.max.y, high[2 * row + slot] = box.max.z;
    moved[slot / 64] |= std::uint64_t{1} << slot % 64;
  }
  for (std::size_t word = 0; word < moved.size(); ++word) {
    run.woken += hwy::PopCount(moved[word] & ~run.moved[word]);
    run.moved[word] |= moved[word];
  }
  return i;
}

std::uint32_t take_out(ObjectId* objects, std::uint32_t count, const std::uint32_t* bits,
                       std::uint32_t words) {
  const U u;
  const hn::RebindToSigned<U> i32;
  const auto limit = hn::Set(u, words), hole = hn::Set(u, kNoObject);
  std::uint32_t taken = 0;
  for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(u))) {
    const auto ids = hn::Load(u, objects + i), word = hn::ShiftRight<5>(ids);
    auto in = hn::Lt(word, limit);
    if (i + hn::Lanes(u) > count) in = hn::And(in, hn::FirstN(u, count - i));
    const auto of = hn::BitCast(i32, hn::IfThenElseZero(in, word));
    const auto its = hn::Shr(hn::GatherIndex(u, bits, of), hn::And(ids, hn::Set(u, 31)));
    const auto out = hn::And(in, hn::Ne(hn::And(its, hn::Set(u, 1)), hn::Zero(u)));
    hn::Store(hn::IfThenElse(out, hole, ids), u, objects + i);
    taken += static_cast<std::uint32_t>(hn::CountTrue(u, out));
  }
  return taken;
}

// Boxes are pairs of points: their coordinates are taken apart, then minima and maxima.
float lay_out(const float* boxes, std::size_t count, geometry::BoxBlock& out) {
  std::size_t i = 0;
  float reach = 0;
#if HWY_TARGET != HWY_SCALAR  // which has no pairs to take apart
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  auto most = hn::Zero(f);
  for (; i + lanes <= count; i += lanes) {
    hn::Vec<F> x[2], y[2], z[2];
    for (std::size_t half = 0; half < 2; ++half)
      hn::LoadInterleaved3(f, boxes + 6 * i + half * 3 * lanes, x[half], y[half], z[half]);
    const auto part = [&](std::size_t side, const hn::Vec<F>* both) HWY_ATTR {
      const auto low = hn::ConcatEven(f, both[1], both[0]), high = hn::ConcatOdd(f, both[1], both[0]);
      hn::Store(low, f, &out.values[side][i]);
      hn::Store(high, f, &out.values[side + 3][i]);
      most = hn::Max(most, hn::Max(hn::Neg(low), high));
    };
    part(0, x), part(1, y), part(2, z);
  }
  reach = hn::GetLane(hn::MaxOfLanes(f, most));
#endif
  for (; i < count; ++i) {
    for (std::size_t side = 0; side < 6; ++side) {
      const float value = out.values[side][i] = boxes[6 * i + side];
      reach = std::max(reach, side < 3 ? -value : value);
    }
  }
  return reach;
}

#if HWY_TARGET != HWY_SCALAR
// The lanes from the third on of two vectors one behind the other.
HWY_INLINE hn::Vec<F> three_on(hn::Vec<F> low, hn::Vec<F> high) {
  constexpr std::uint32_t kLanes = hn::MaxLanes(F());
  const F f;
  const U u;
  const auto from = hn::IndicesFromVec(f, hn::And(hn::Iota(u, 3), hn::Set(u, kLanes - 1)));
  return hn::IfThenElse(hn::FirstN(f, kLanes - 3), hn::TableLookupLanes(low, from),
                        hn::TableLookupLanes(high, from));
}
#endif

// Of so many boxes, how many come before the first that begins with a cache line, or none. From there on no
// load crosses two lines: processors that see nothing but such as do foresee badly which lines are next.
HWY_INLINE std::size_t before_line(const float* boxes, std::size_t count) {
  constexpr std::size_t kLine = 64, kMost = kLine / 8;
  std::size_t i = 0;
  while (i < kMost && reinterpret_cast<std::uintptr_t>(boxes + 6 * i) % kLine != 0) ++i;
  return i < kMost ? std::min(i, count) : 0;
}

// Six floats a box, and three further on stands what is no less; three vectors repeat the order.
bool are_sound(const float* values, std::size_t boxes, float reach) {
  const auto one_by_one = [=](std::size_t first, std::size_t end) {
    bool sound = true;
    for (std::size_t i = first; i < end; i += 6) {
      for (std::size_t k = i; k < i + 3; ++k)
        sound = sound && values[k] <= values[k + 3] && values[k] >= -reach && values[k + 3] <= reach;
    }
    return sound;
  };
  std::size_t i = ChunkMap::kHasPages ? 6 * before_line(values, boxes) : 0;
  if (i > 0 && !one_by_one(0, i)) return false;
#if HWY_TARGET != HWY_SCALAR
  constexpr std::size_t kVectors = 3, kStep = kVectors * hn::MaxLanes(F());
  const F f;
  const hn::RebindToSigned<F> i32;
  const std::size_t lanes = hn::Lanes(f);
  alignas(64) std::array<std::int32_t, kStep> minima;
  for (std::size_t k = 0; k < kStep; ++k) minima[k] = k % 6 < 3 ? -1 : 0;
  // As whole numbers all that is no number is greater than what is one.
  const auto magnitude = hn::Set(i32, 0x7fffffff);
  auto greatest = hn::Zero(i32);
  auto least = hn::Zero(f);
  for (; i + kStep + 3 <= 6 * boxes; i += kStep) {
    hn::Vec<F> low[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) low[v] = hn::LoadU(f, values + i + v * lanes);
    // Or g++ reads them anew wherever they are used, no longer in their order.
    std::atomic_signal_fence(std::memory_order_acq_rel);
    for (std::size_t v = 0; v < kVectors; ++v) {
      auto high = three_on(low[v], low[std::min(v + 1, kVectors - 1)]);
      // Short ones are read as quickly.
      if constexpr (hn::MaxLanes(F()) == 4) high = hn::LoadU(f, values + i + v * lanes + 3);
      const auto is_minimum = hn::BitCast(f, hn::Load(i32, &minima[v * lanes]));
      greatest = hn::Max(greatest, hn::And(hn::BitCast(i32, low[v]), magnitude));
      least = hn::Min(least, hn::And(hn::Sub(high, low[v]), is_minimum));
    }
  }
  if (hn::GetLane(hn::MaxOfLanes(i32, greatest)) > std::bit_cast<std::int32_t>(reach) ||
      !(hn::GetLane(hn::MinOfLanes(f, least)) >= 0))
    return false;
#endif
  return one_by_one(i, 6 * boxes);
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(write_run);
HWY_EXPORT(are_sound);
HWY_EXPORT(lay_out);
HWY_EXPORT(take_out);
HWY_EXPORT(write_in_page);

std::uint32_t take_out(ObjectId* objects, std::uint32_t count, std::span<const std::uint32_t> bits) noexcept {
  return HWY_DYNAMIC_DISPATCH(take_out)(objects, count, bits.data(), static_cast<std::uint32_t>(bits.size()));
}

std::uint32_t write_in_page(const PageRun& run, std::span<const ObjectId> objects,
                            const Box* boxes) noexcept {
  return HWY_DYNAMIC_DISPATCH(write_in_page)(run, objects.data(), boxes,
                                             static_cast<std::uint32_t>(objects.size()));
}

bool boxes_are_sound(std::span<const Box> boxes) noexcept {
  // The greatest float that is not beyond kWorldReach.
  constexpr auto kReach = static_cast<float>(kWorldReach);
  static_assert(static_cast<double>(kReach) <= kWorldReach);
  return boxes.empty() || HWY_DYNAMIC_DISPATCH(are_sound)(&boxes[0].min.x, boxes.size(), kReach);
}

float lay_out_structs(std::span<const Box> boxes, geometry::BoxBlock& out) noexcept {
  return HWY_DYNAMIC_DISPATCH(lay_out)(&boxes[0].min.x, boxes.size(), out);
}

std::uint32_t ChunkMap::move_run(std::uint32_t& chunk, std::uint32_t& slot, const ObjectId* objects,
                                 const geometry::BoxBlock& boxes, std::size_t first, std::uint32_t count,
                                 bool past_cache) noexcept {
  Chunk& c = chunks_[chunk];
  if (c.pool != kMovers || slot >= c.count) return 0;
  std::array<const float*, 6> from;
  for (std::size_t side = 0; side < 6; ++side) from[side] = boxes.values[side].data() + first;
  const MoverRun run{c.bounds, ids(c), lanes(c, 0), step(c), c.count, c.moved.data(), past_cache};
  const std::uint32_t moved = HWY_DYNAMIC_DISPATCH(write_run)(run, slot, objects, from, count);
  in_runs_ += moved, ++changes_[kMovers];
  if (slot == kCapacity && c.next != kNone) chunk = c.next, slot = 0;
  return moved;
}

}  // namespace sightline::world
#endif
