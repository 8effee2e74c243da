// Culling by frustum: the groups of a node, then their chunks and objects, for one view or several.
#include "library/world/world_cull.hpp"

#include <bit>
#include <cstring>

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
  constexpr std::uint32_t kSome = 32;
  std::array<ChunkBits, kMaxViews> bits;
  const auto& rows = node.group_boxes.sides;
  const auto count = static_cast<std::uint32_t>(node.groups.size());
  for (std::uint32_t first = 0; first < count; first += kSome) {
    const Sides sides{&rows[0][first], &rows[1][first], &rows[2][first],
                      &rows[3][first], &rows[4][first], &rows[5][first]};
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
      bits[v] = {};
      if (planes[v] == kOutside) continue;
      bits[v] = classify_boxes(sides, std::min(kSome, count - first), views[v], planes[v]);
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

// Of the group that comes after the next, for by then it will have arrived.
HWY_INLINE void prefetch_group(const PassInput& input, std::span<const GroupEntry> entries, std::size_t e) {
  if (e + 2 >= entries.size()) return;
  const GroupEntry& entry = entries[e + 2];
  const auto* from = reinterpret_cast<const std::uint8_t*>(&input.maps[entry.sector]->groups()[entry.group]);
  for (std::size_t at = 0; at < sizeof(ChunkMap::Group); at += 64) hwy::Prefetch(from + at);
}

PassCounts one_view(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* HWY_RESTRICT out) {
  PassCounts counts;
  ObjectId* at = out;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const GroupEntry& entry = entries[e];
    prefetch_group(input, entries, e);
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Group& group = map.groups()[entry.group];
    const SectorView& view = input.views[entry.sector];
    const ChunkBits bits = classify_chunks(group, view, entry.planes[0]);
    counts.chunks += group.count;
    // Memory is what this waits for: the whole group's is asked for before any of it is used.
    std::array<ChunkMap::ChunkView, kGroup> chunks;
    std::array<PlaneSet, kGroup> planes;
    std::size_t kept = 0;
    for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      chunks[kept] = map.chunk(group, i);
      planes[kept] = planes_of(bits, i, entry.planes[0]);
      prefetch_ids(chunks[kept]);
      ++kept;
    }
    for (std::size_t k = 0; k < kept; ++k) {
      const ChunkMap::ChunkView& chunk = chunks[k];
      if (planes[k] == 0) {
        copy_ids(chunk.objects, chunk.count, at);
        at += chunk.count;
      } else {
        counts.tested += chunk.count;
        Corner corners[Frustum::sides];
        at += cull_chunk(chunk, corners, corners_of(chunk, view, planes[k], corners), at);
      }
    }
  }
  counts.written = static_cast<std::size_t>(at - out);
  return counts;
}

// One value for all of a chunk's objects. Writes up to 63 more than count.
HWY_INLINE void fill_masks(std::uint8_t mask, std::size_t count, std::uint8_t* HWY_RESTRICT to) {
  const hn::ScalableTag<std::uint8_t> u8;
  for (std::size_t i = 0; i < count; i += hn::Lanes(u8)) hn::StoreU(hn::Set(u8, mask), u8, to + i);
}

// Views that may see a part of a chunk, and which of its objects they do see.
struct ChunkViews {
  std::size_t count = 0;
  std::array<std::uint8_t, kMaxViews> bits{};  // of a mask
  std::array<ObjectBits, kMaxViews> seen;
};

HWY_INLINE void store_masks(hn::Vec<U> masks, std::uint8_t* HWY_RESTRICT to) {
  const hn::Rebind<std::uint8_t, U> bytes;
  hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(hn::RebindToSigned<U>(), masks)), bytes, to);
}

// The objects of a chunk that views see: ids and masks, behind one another.
HWY_INLINE std::size_t write_seen(const ChunkMap::ChunkView& chunk, const ChunkViews& views,
                                  ObjectId* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) {
  const U u;
  const std::size_t lanes = hn::Lanes(u);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.count; i += lanes) {
    auto mask = hn::Zero(u);
    for (std::size_t k = 0; k < views.count; ++k)
      mask = hn::Or(mask, hn::IfThenElseZero(mask_at(u, views.seen[k], i), hn::Set(u, views.bits[k])));
    auto keep = hn::Ne(mask, hn::Zero(u));
    if (i + lanes > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    hn::StoreU(hn::Compress(hn::Load(u, chunk.objects + i), keep), u, out + kept);
    if (masks) store_masks(hn::Compress(mask, keep), masks + kept);
    kept += hn::CountTrue(u, keep);
  }
  return kept;
}

// The masks of a chunk that the views of `whole` see all of: nothing to leave out. Writes up to 63 more.
HWY_INLINE void write_masks(const ChunkMap::ChunkView& chunk, std::uint8_t whole, const ChunkViews& views,
                            std::uint8_t* HWY_RESTRICT masks) {
  const hn::CappedTag<std::uint8_t, 64> bytes;
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(bytes)) {
    auto mask = hn::Set(bytes, whole);
    for (std::size_t k = 0; k < views.count; ++k) {
      const auto seen = mask_at(bytes, views.seen[k], i);
      mask = hn::Or(mask, hn::IfThenElseZero(seen, hn::Set(bytes, views.bits[k])));
    }
    hn::StoreU(mask, bytes, masks + i);
  }
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

// Several views, frustum only.
PassCounts frustum_views(const PassInput& input, std::span<const GroupEntry> entries,
                         ObjectId* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) {
  PassCounts counts;
  std::size_t kept = 0;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<std::uint32_t, kMaxViews> whole{}, crossing{};
  std::array<ChunkMap::ChunkView, kGroup> chunks;
  ChunkViews crossed;
  std::array<std::uint8_t, 1 << kMaxViews> bits_of_views;  // of a mask
  for (std::size_t set = 0; set < bits_of_views.size(); ++set) {
    bits_of_views[set] = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) bits_of_views[set] |= set >> v & 1 ? input.bits[v] : 0;
  }
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const GroupEntry& entry = entries[e];
    prefetch_group(input, entries, e);
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Group& group = map.groups()[entry.group];
    const SectorView* views = &input.views[entry.sector * input.view_count];
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) {
      whole[v] = crossing[v] = 0;
      if (entry.planes[v] == kOutside) continue;
      bits[v] = classify_chunks(group, views[v], entry.planes[v]);
      any |= bits[v].kept;
      crossing[v] = bits[v].crossing, whole[v] = bits[v].kept & ~bits[v].crossing;
    }
    counts.chunks += group.count;
    const ViewsOfChunk seen_by = turn(whole, input.view_count), crossed_by = turn(crossing, input.view_count);
    // Memory is what this waits for: the whole group's is asked for before any of it is used.
    for (std::uint32_t rest = any; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      chunks[i] = map.chunk(group, i);
      prefetch_ids(chunks[i]);
    }
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const std::uint8_t whole = bits_of_views[seen_by[i]];
      if (crossed_by[i] == 0 || (whole != 0 && masks == nullptr)) {
        copy_ids(chunk.objects, chunk.count, out + kept);
        if (masks) fill_masks(whole, chunk.count, masks + kept);
        kept += chunk.count;
        continue;
      }
      if (whole == 0 && std::has_single_bit(crossed_by[i])) {
        // One view alone: its mask is the same for all.
        const int v = std::countr_zero(crossed_by[i]);
        Corner corners[Frustum::sides];
        const std::size_t planes =
            corners_of(chunk, views[v], planes_of(bits[v], i, entry.planes[v]), corners);
        const std::size_t count = cull_chunk(chunk, corners, planes, out + kept);
        if (masks) fill_masks(input.bits[v], count, masks + kept);
        counts.tested += chunk.count;
        kept += count;
        continue;
      }
      crossed.count = 0;
      for (std::uint32_t by = crossed_by[i]; by != 0; by &= by - 1) {
        const int v = std::countr_zero(by);
        Corner corners[Frustum::sides];
        const std::size_t planes =
            corners_of(chunk, views[v], planes_of(bits[v], i, entry.planes[v]), corners);
        crossed.bits[crossed.count] = input.bits[v];
        crossed.seen[crossed.count++] =
            test_objects(chunk, corners, planes, [](std::size_t, hn::Mask<F> m) HWY_ATTR { return m; });
      }
      counts.tested += crossed.count * chunk.count;
      if (whole != 0) {
        copy_ids(chunk.objects, chunk.count, out + kept);
        write_masks(chunk, whole, crossed, masks + kept);
        kept += chunk.count;
      } else {
        kept += write_seen(chunk, crossed, out + kept, masks ? masks + kept : nullptr);
      }
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
  bool plain = true;
  for (const SectorView& view : input.views) plain = plain && view.area_scale == 0 && !view.occluders;
  if (!plain) return cull_filtered_groups(input, entries, out, masks);
  if (input.view_count == 1 && !masks) return HWY_DYNAMIC_DISPATCH(one_view)(input, entries, out);
  return HWY_DYNAMIC_DISPATCH(frustum_views)(input, entries, out, masks);
}

}  // namespace sightline::world
#endif
