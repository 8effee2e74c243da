// Culling by frustum: the groups of a node, then their chunks and objects, for one view or several.
#include "library/world/world_cull.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/world_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/world_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

void find_node_groups(const ChunkMap::Node& node, std::span<const SectorView> views,
                      std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                      std::vector<GroupEntry>& entries) {
  constexpr std::uint32_t kWordBits = 32;  // a bit a group
  std::array<ChunkBits, kMaxViews> bits;
  const auto& rows = node.group_boxes.sides;
  const auto count = static_cast<std::uint32_t>(node.groups.size());
  for (std::uint32_t first = 0; first < count; first += kWordBits) {
    const Sides sides{&rows[0][first], &rows[1][first], &rows[2][first],
                      &rows[3][first], &rows[4][first], &rows[5][first]};
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
      bits[v] = {};
      if (planes[v] == kOutside) continue;
      bits[v] = classify_boxes(sides, std::min(kWordBits, count - first), views[v], planes[v]);
      any |= bits[v].kept;
    }
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      GroupEntry entry{sector, node.groups[first + i], {}};
      entry.planes.fill(kOutside);
      for (std::size_t v = 0; v < views.size(); ++v) {
        if (bits[v].kept >> i & 1) entry.planes[v] = planes_of(bits[v], i);
      }
      entries.push_back(entry);
    }
  }
}

// How many of a group's chunks, from i on, can be read as one: they cross planes, are full but for the last,
// and lie one behind the other.
HWY_INLINE std::uint32_t run_of(const ChunkMap::Group& group, const ChunkBits& bits, std::uint32_t i) {
  using Group = ChunkMap::Group;
  std::uint32_t run = 1;
  for (; i + run < group.count && (bits.crossing >> (i + run) & 1); ++run) {
    const std::uint32_t last = group.count_and_size[i + run - 1], next = group.count_and_size[i + run];
    if (group.first_lane[i + run] != group.first_lane[i + run - 1] + ChunkMap::kCapacity ||
        (last & Group::kCount) != ChunkMap::kCapacity || ((last ^ next) & Group::kInOrder) != 0)
      break;
  }
  return run;
}

// Calls take(first, mask) for each vector of a run's objects: which of them all planes leave.
template <class TakeMask>
HWY_INLINE void test_run(const ChunkMap::ChunkView& run, const SectorView& view, const TakeMask& take) {
  const F f;
  struct Corner {
    const float *x, *y, *z;
  };
  const auto plane = [&](std::size_t p) HWY_ATTR { return spread(f, view.planes[p]); };
  const auto corner = [&](std::size_t p) {
    const auto& near = view.near_side[p];
    return Corner{run.side(near[0]), run.side(near[1]), run.side(near[2])};
  };
  const auto p0 = plane(0), p1 = plane(1), p2 = plane(2), p3 = plane(3), p4 = plane(4), p5 = plane(5);
  const Corner c0 = corner(0), c1 = corner(1), c2 = corner(2), c3 = corner(3), c4 = corner(4), c5 = corner(5);
  for (std::size_t i = 0; i < run.count; i += hn::Lanes(f)) {
    const auto from = [i](const auto& of, const Corner& c) HWY_ATTR {
      const F f;
      return distance(of, Points{hn::Load(f, c.x + i), hn::Load(f, c.y + i), hn::Load(f, c.z + i)});
    };
    // Left and right reject what lies behind the eye, too: all of a vector where neighbours stand together.
    const VF sides = lowest(hn::Zero(f), from(p0, c0), from(p1, c1));
    if (hn::AllFalse(f, not_behind(sides))) continue;
    take(i, not_behind(lowest(sides, from(p2, c2), from(p3, c3), from(p4, c4), from(p5, c5))));
  }
}

// Of a run with holes those that are left.
HWY_INLINE std::size_t cull_run(const ChunkMap::ChunkView& run, const SectorView& view,
                                ObjectId* HWY_RESTRICT out) {
  const U u;
  std::size_t kept = 0;
  test_run(run, view, [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    const auto ids = hn::Load(u, run.objects + i);
    auto keep = hn::And(hn::RebindMask(u, mask), are_objects(ids));
    if (i + hn::Lanes(u) > run.count) keep = hn::And(keep, hn::FirstN(u, run.count - i));
    kept += store_kept(u, ids, keep, out + kept);
  });
  return kept;
}

// The same where each id is one more than the last, so that none need be read.
HWY_INLINE std::size_t cull_in_order(const ChunkMap::ChunkView& run, const SectorView& view,
                                     ObjectId* HWY_RESTRICT out) {
  const U u;
  const auto first = hn::Iota(u, run.objects[0]);
  std::size_t kept = 0;
  test_run(run, view, [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    const auto ids = hn::Add(first, hn::Set(u, static_cast<std::uint32_t>(i)));
    kept += store_kept(u, ids, hn::RebindMask(u, mask), out + kept);
  });
  return kept;
}

// Asks for the boxes of those of a group's chunks of movers, from `first` on and before `end`, that do not
// lie behind the one before: there processors do not foresee what is read next.
HWY_INLINE void ask_for_boxes(const EntryGroup& at, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t i = first; i < std::min(end, at.group.count); ++i) {
    if (i > 0 && at.group.first_lane[i] == at.group.first_lane[i - 1] + ChunkMap::kCapacity) continue;
    const ChunkMap::ChunkView chunk = at.map.chunk(at.group, i);
    for (std::size_t side = 0; side < 6; ++side) {
      for (std::uint32_t lane = 0; lane < chunk.count; lane += 16) hwy::Prefetch(chunk.side(side) + lane);
    }
    prefetch_ids(chunk);
  }
}

// The chunks of movers in a group, run by run. They nearly always cross all planes: all are asked.
HWY_NOINLINE std::size_t cull_movers(const EntryGroup& at, const ChunkBits& bits, PassCounts& counts,
                                     ObjectId* HWY_RESTRICT out) {
  constexpr std::uint32_t kAhead = 2;  // chunks
  std::size_t kept = 0;
  for (std::uint32_t i = 0, asked = 0; i < at.group.count;) {
    ask_for_boxes(at, asked, i + 1 + kAhead);
    asked = std::max(asked, i + 1 + kAhead);
    ChunkMap::ChunkView run = at.map.chunk(at.group, i);
    if ((bits.crossing >> i & 1) == 0) {
      if (bits.kept >> i & 1) kept += copy_objects(run, out + kept);
      ++i;
      continue;
    }
    const bool in_order = at.group.count_and_size[i] & ChunkMap::Group::kInOrder;
    i += run_of(at.group, bits, i);
    const ChunkMap::ChunkView last = at.map.chunk(at.group, i - 1);
    run.count = static_cast<std::uint32_t>(last.objects - run.objects) + last.count;
    counts.tested += run.count;
    kept += in_order ? cull_in_order(run, *at.views, out + kept) : cull_run(run, *at.views, out + kept);
  }
  return kept;
}

// The objects of a chunk that one view sees; writes up to a vector more. Returns how many there are.
HWY_INLINE std::size_t write_left(const ChunkMap::ChunkView& chunk, const ObjectBits& left,
                                  ObjectId* HWY_RESTRICT to) {
  const U u;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(u)) {
    const auto ids = hn::Load(u, chunk.objects + i);
    auto keep = mask_at(u, left, i);
    if (chunk.loose) keep = hn::And(keep, are_objects(ids));
    kept += store_kept(u, ids, keep, to + kept);
  }
  return kept;
}

PassCounts one_view(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* HWY_RESTRICT out) {
  PassCounts counts;
  ObjectId* end = out;
  Chunks chunks;
  CrossedBits left;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const GroupEntry& entry = entries[e];
    prefetch_group(input, entries, e);
    const EntryGroup at = group_of(input, entry);
    ChunkBits bits = classify_chunks(at.group, *at.views, entry.planes[0]);
    std::uint32_t parted = 0;
    if (input.columns) {
      prefetch_columns(input, entries, e);
      parted = ask_columns(input, at, *at.views, bits);
    }
    counts.chunks += at.group.count;
    if (ChunkMap::kHasPages && at.group.pool != 0 && parted == 0) {
      end += cull_movers(at, bits, counts, end);
      continue;
    }
    find_chunks(at, bits.kept, chunks);
    test_crossed(chunks, *at.views, entry.planes[0], bits, bits.kept, left);
    for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const bool crossing = bits.crossing >> i & 1;
      if (!crossing && (parted >> i & 1) == 0) {
        end += copy_chunk(chunk, end);
        continue;
      }
      counts.tested += chunk.count;
      if (!crossing) left[i] = first_objects(chunk.count);
      if (parted >> i & 1) left[i].keep(input.columns->objects(at.map, at.group, chunk, *at.views));
      end += write_left(chunk, left[i], end);
    }
  }
  counts.written = static_cast<std::size_t>(end - out);
  return counts;
}

// A byte a chunk of a group: the views in whose words the chunk's bit is set.
using ViewsOfChunk = std::array<std::uint8_t, kGroup>;

HWY_INLINE ViewsOfChunk turn(const std::array<std::uint32_t, kMaxViews>& words, std::size_t views) {
  const U u;
  alignas(64) ViewsOfChunk out;
  for (std::uint32_t i = 0; i < kGroup; i += static_cast<std::uint32_t>(hn::Lanes(u))) {
    const auto chunk = hn::Shl(hn::Set(u, 1), hn::Iota(u, i));
    auto of_chunk = hn::Zero(u);
    for (std::size_t v = 0; v < views; ++v) {
      const auto set = hn::TestBit(hn::Set(u, words[v]), chunk);
      of_chunk = hn::Or(of_chunk, hn::IfThenElseZero(set, hn::Set(u, 1u << v)));
    }
    store_masks(of_chunk, &out[i]);
  }
  return out;
}

// The bits of a mask that each set of views stands for.
HWY_INLINE std::array<std::uint8_t, 1 << kMaxViews> bits_of_views(const PassInput& input) {
  std::array<std::uint8_t, 1 << kMaxViews> out{};
  for (std::size_t set = 0; set < std::size_t{1} << input.view_count; ++set) {
    for (std::size_t v = 0; v < input.view_count; ++v) out[set] |= set >> v & 1 ? input.bits[v] : 0;
  }
  return out;
}

// What the views see of a group: a word a view, a bit a chunk.
struct GroupBits {
  std::array<ChunkBits, kMaxViews> bits;  // of the views that do not miss the group
  std::array<std::uint32_t, kMaxViews> whole{}, crossing{};
};

// Returns the chunks that some view may see.
HWY_INLINE std::uint32_t classify_group(const PassInput& input, const GroupEntry& entry, const EntryGroup& at,
                                        GroupBits& out) {
  std::uint32_t any = 0;
  for (std::size_t v = 0; v < input.view_count; ++v) {
    out.whole[v] = out.crossing[v] = 0;
    if (entry.planes[v] == kOutside) continue;
    out.bits[v] = classify_chunks(at.group, at.views[v], entry.planes[v]);
    any |= out.bits[v].kept;
    out.crossing[v] = out.bits[v].crossing, out.whole[v] = out.bits[v].kept & ~out.bits[v].crossing;
  }
  return any;
}

using CrossedByView = std::array<CrossedBits, kMaxViews>;

// What each view leaves of the chunks that it crosses. Without masks, who is seen whole by one view need not
// be asked for others.
HWY_INLINE void test_views(const PassInput& input, const GroupEntry& entry, const SectorView* views,
                           const GroupBits& bits, bool masks, const Chunks& chunks, CrossedByView& left) {
  std::uint32_t asked = ~0u;
  for (std::size_t v = 0; v < input.view_count && !masks; ++v) asked &= ~bits.whole[v];
  for (std::size_t v = 0; v < input.view_count; ++v) {
    if (bits.crossing[v] != 0) test_crossed(chunks, views[v], entry.planes[v], bits.bits[v], asked, left[v]);
  }
}

// Of chunk i, for the views that cross it.
HWY_INLINE void gather(const PassInput& input, std::uint32_t views, std::uint32_t i,
                       const CrossedByView& left, ChunkViews& out) {
  out.count = 0;
  for (; views != 0; views &= views - 1) {
    const int v = std::countr_zero(views);
    out.bits[out.count] = input.bits[v];
    out.seen[out.count++] = left[v][i];
  }
}

// Several views, frustum only.
PassCounts frustum_views(const PassInput& input, std::span<const GroupEntry> entries,
                         ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks) {
  PassCounts counts;
  std::size_t kept = 0;
  GroupBits bits;
  Chunks chunks;
  ChunkViews crossed;
  CrossedByView left;
  const auto mask_bits = bits_of_views(input);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const GroupEntry& entry = entries[e];
    prefetch_group(input, entries, e);
    const EntryGroup at = group_of(input, entry);
    std::uint32_t any = classify_group(input, entry, at, bits);
    counts.chunks += at.group.count;
    const ViewsOfChunk seen_by = turn(bits.whole, input.view_count),
                       crossed_by = turn(bits.crossing, input.view_count);
    find_chunks(at, any, chunks);
    test_views(input, entry, at.views, bits, masks != nullptr, chunks, left);
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const std::uint8_t whole = mask_bits[seen_by[i]], by = crossed_by[i];
      if (by == 0 || (whole != 0 && masks == nullptr)) {
        kept += write_whole(chunk, whole, kept, ids, masks);
        continue;
      }
      if (whole == 0 && std::has_single_bit(by)) {
        const int v = std::countr_zero(by);
        counts.tested += chunk.count;
        const std::size_t count = write_left(chunk, left[v][i], ids + kept);
        if (masks) fill_masks(input.bits[v], count, masks + kept);
        kept += count;
        continue;
      }
      gather(input, by, i, left, crossed);
      counts.tested += crossed.count * chunk.count;
      kept += write_parts(chunk, whole, crossed, kept, ids, masks);
    }
  }
  counts.written = kept;
  return counts;
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(one_view);
HWY_EXPORT(frustum_views);
HWY_EXPORT(find_node_groups);

void find_groups(const ChunkMap::Node& node, std::span<const SectorView> views,
                 std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                 std::vector<GroupEntry>& entries) noexcept {
  HWY_DYNAMIC_DISPATCH(find_node_groups)(node, views, planes, sector, entries);
}

PassCounts cull_groups(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* out,
                       std::uint8_t* masks) noexcept {
  if (input.levels) return input.levels->cull(input, entries, out, masks);
  bool plain = input.hidden.empty();
  for (const SectorView& view : input.views) plain = plain && view.area_scale == 0 && !view.occluders;
  const bool alone = input.view_count == 1 && !masks;
  if (!plain || (input.columns && !alone)) return cull_filtered_groups(input, entries, out, masks);
  if (alone) return HWY_DYNAMIC_DISPATCH(one_view)(input, entries, out);
  return HWY_DYNAMIC_DISPATCH(frustum_views)(input, entries, out, masks);
}

}  // namespace sightline::world
#endif
