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

// cull_chunk() of a chunk with holes or of movers. By itself, as worlds that stand still never come here.
HWY_NOINLINE std::size_t cull_loose_chunk(const ChunkMap::ChunkView& chunk, const Corner* corners,
                                          std::size_t planes, ObjectId* HWY_RESTRICT out) {
  if (planes == 0) return copy_chunk(chunk, out);
  const U u;
  std::size_t kept = 0;
  const auto take = [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    const auto ids = hn::Load(u, chunk.objects + i);
    auto keep = hn::And(hn::RebindMask(u, mask), are_objects(ids));
    if (i + hn::Lanes(u) > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    kept += store_kept(u, ids, keep, out + kept);
  };
  if (planes == Frustum::sides) {
    test_planes<Frustum::sides>(corners, planes, chunk.count, take);
  } else {
    test_planes(corners, planes, chunk.count, take);
  }
  return kept;
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

// The same where each id is one more than the last, so that none need be read.
HWY_INLINE std::size_t cull_in_order(const ChunkMap::ChunkView& chunk, const Corner* corners,
                                     ObjectId* HWY_RESTRICT out) {
  const U u;
  const auto first = hn::Iota(u, chunk.objects[0]);
  std::size_t kept = 0;
  test_planes<Frustum::sides>(corners, Frustum::sides, chunk.count,
                              [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
                                const auto ids = hn::Add(first, hn::Set(u, static_cast<std::uint32_t>(i)));
                                kept += store_kept(u, ids, hn::RebindMask(u, mask), out + kept);
                              });
  return kept;
}

// The chunks of movers in a group, run by run. They nearly always cross all planes: all are asked.
HWY_NOINLINE std::size_t cull_movers(const EntryGroup& at, const ChunkBits& bits, PassCounts& counts,
                                     ObjectId* HWY_RESTRICT out) {
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < at.group.count;) {
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
    Corner corners[Frustum::sides];
    corners_of(run, *at.views, kAllPlanes, corners);
    kept += in_order ? cull_in_order(run, corners, out + kept)
                     : cull_loose_chunk(run, corners, Frustum::sides, out + kept);
  }
  return kept;
}

// cull_chunk() of a chunk of which the columns leave a part.
HWY_NOINLINE std::size_t cull_parted_chunk(const PassInput& input, const EntryGroup& at,
                                           const ChunkMap::ChunkView& chunk, PlaneSet planes,
                                           ObjectId* HWY_RESTRICT out) {
  const U u;
  Corner corners[Frustum::sides];
  const ObjectBits seen = input.columns->objects(at.map, at.group, chunk, *at.views);
  std::size_t kept = 0;
  const auto take = [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    const auto ids = hn::Load(u, chunk.objects + i);
    auto keep = hn::And(hn::And(hn::RebindMask(u, mask), mask_at(u, seen, i)), are_objects(ids));
    if (i + hn::Lanes(u) > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    kept += store_kept(u, ids, keep, out + kept);
  };
  test_planes<0>(corners, corners_of(chunk, *at.views, planes, corners), chunk.count, take);
  return kept;
}

PassCounts one_view(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* HWY_RESTRICT out) {
  PassCounts counts;
  ObjectId* end = out;
  std::array<ChunkMap::ChunkView, kGroup> chunks;
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
    for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const PlaneSet planes = planes_of(bits, i, entry.planes[0]);
      if (parted >> i & 1) {
        counts.tested += chunk.count;
        end += cull_parted_chunk(input, at, chunk, planes, end);
      } else if (chunk.loose) {
        Corner corners[Frustum::sides];
        if (planes != 0) counts.tested += chunk.count;
        end += cull_loose_chunk(chunk, corners, corners_of(chunk, *at.views, planes, corners), end);
      } else if (planes == 0) {
        copy_ids(chunk.objects, chunk.count, end);
        end += chunk.count;
      } else {
        counts.tested += chunk.count;
        Corner corners[Frustum::sides];
        end += cull_chunk(chunk, corners, corners_of(chunk, *at.views, planes, corners), end);
      }
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

// Tests chunk i of a group object by object, for views that it crosses.
struct CrossedChunk {
  const PassInput& input;
  const GroupEntry& entry;
  const SectorView* views;
  const GroupBits& bits;
  const ChunkMap::ChunkView& chunk;
  std::uint32_t i;  // the chunk's place in the group

  HWY_INLINE std::size_t corners(int v, Corner* out) const {
    return corners_of(chunk, views[v], planes_of(bits.bits[v], i, entry.planes[v]), out);
  }

  // One view alone: its mask is the same for all.
  HWY_INLINE std::size_t write_one(int v, std::size_t kept, ObjectId* HWY_RESTRICT ids,
                                   std::uint8_t* HWY_RESTRICT masks) const {
    Corner planes[Frustum::sides];
    const std::size_t crossed = corners(v, planes);
    const std::size_t count = chunk.loose ? cull_loose_chunk(chunk, planes, crossed, ids + kept)
                                          : cull_chunk(chunk, planes, crossed, ids + kept);
    if (masks) fill_masks(input.bits[v], count, masks + kept);
    return count;
  }

  HWY_INLINE void test(std::uint32_t crossed_by, ChunkViews& out) const {
    out.count = 0;
    for (; crossed_by != 0; crossed_by &= crossed_by - 1) {
      const int v = std::countr_zero(crossed_by);
      Corner planes[Frustum::sides];
      const std::size_t count = corners(v, planes);
      out.bits[out.count] = input.bits[v];
      out.seen[out.count++] =
          test_objects(chunk, planes, count, [](std::size_t, hn::Mask<F> m) HWY_ATTR { return m; });
    }
  }
};

// Several views, frustum only.
PassCounts frustum_views(const PassInput& input, std::span<const GroupEntry> entries,
                         ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks) {
  PassCounts counts;
  std::size_t kept = 0;
  GroupBits bits;
  std::array<ChunkMap::ChunkView, kGroup> chunks;
  ChunkViews crossed;
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
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const std::uint8_t whole = mask_bits[seen_by[i]], by = crossed_by[i];
      if (by == 0 || (whole != 0 && masks == nullptr)) {
        kept += write_whole(chunk, whole, kept, ids, masks);
        continue;
      }
      const CrossedChunk crossing{input, entry, at.views, bits, chunk, i};
      if (whole == 0 && std::has_single_bit(by)) {
        counts.tested += chunk.count;
        kept += crossing.write_one(std::countr_zero(by), kept, ids, masks);
        continue;
      }
      crossing.test(by, crossed);
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
