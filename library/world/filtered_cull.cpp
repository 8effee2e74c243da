// Culling by frustum, contribution and occlusion, for any views.
#include "library/world/world_cull.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/filtered_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/filtered_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

// What find_hidden_chunks() does for a view and a group.
HWY_INLINE std::uint32_t hidden_of(const PassInput& input, const EntryGroup& at, const SectorView& view,
                                   PlaneSet planes, std::uint8_t mask_bits, ChunkTally& tally) {
  if (planes == kOutside) return 0;
  ChunkBits bits = classify_chunks(at.group, view, planes);
  const std::uint32_t parted = input.columns ? ask_columns(input, at, view, bits) : 0;
  if (bits.kept == 0) return 0;
  ChunkAnswers visible;
  visible.fill(1);
  if (view.occluders) {
    ask_chunks(at.group, view, visible);
    tally.asked += at.group.count;
  }
  std::uint32_t hidden = 0;
  for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    const ChunkMap::ChunkView chunk = at.map.chunk(at.group, i);
    if (visible[i]) {
      tally.left += chunk.count;
      continue;
    }
    hidden |= 1u << i;
    ++tally.hidden;
    // Of a chunk that the frustum crosses, that the columns part or that has holes, nobody knows without
    // looking at its objects.
    if (((bits.crossing | parted) >> i & 1) == 0 && !chunk.loose && view.area_scale == 0)
      tally.saved += static_cast<std::uint64_t>(std::popcount(mask_bits)) * chunk.count;
  }
  return hidden;
}

ChunkTally hidden_chunks(const PassInput& input, std::span<const GroupEntry> entries, std::uint32_t* hidden) {
  ChunkTally tally;
  for (const GroupEntry& entry : entries) {
    const EntryGroup at = group_of(input, entry);
    for (std::size_t v = 0; v < input.view_count; ++v)
      *hidden++ = hidden_of(input, at, at.views[v], entry.planes[v], input.bits[v], tally);
  }
  return tally;
}

// Any views, any tests.
PassCounts filtered_views(const PassInput& input, std::span<const GroupEntry> entries,
                          ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks) {
  PassCounts counts;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<std::uint32_t, kMaxViews> parted;
  ChunkViews parts;
  std::array<ChunkMap::ChunkView, kGroup> chunks;
  // What occlusion drops counts once for each of the caller's views that are the same.
  const auto count_occluded = [&](std::size_t v, std::uint64_t objects) {
    counts.occluded += static_cast<std::uint64_t>(std::popcount(input.bits[v])) * objects;
  };
  const std::uint32_t* hidden = input.hidden.empty() ? nullptr : input.hidden.data();
  for (const GroupEntry& entry : entries) {
    const EntryGroup at = group_of(input, entry);
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) {
      std::uint64_t dropped = 0;
      bits[v] = filter_chunks(input, at, at.views[v], entry.planes[v], hidden ? hidden++ : nullptr, parted[v],
                              dropped);
      count_occluded(v, dropped);
      any |= bits[v].kept;
    }
    counts.chunks += at.group.count;
    find_chunks(at, any, chunks);
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      const ChunkViewers viewers = viewers_of(input, at, bits, parted, i);
      const std::size_t before = counts.written;
      if (viewers.part == 0 || (viewers.whole != 0 && masks == nullptr)) {
        counts.written += write_whole(chunk, viewers.whole, counts.written, ids, masks);
      } else {
        parts.count = 0;
        for (std::uint32_t rest = viewers.part; rest != 0; rest &= rest - 1) {
          const auto v = static_cast<std::size_t>(std::countr_zero(rest));
          ObjectBits& seen = parts.seen[parts.count];
          parts.bits[parts.count++] = input.bits[v];
          counts.tested += chunk.count;
          view_objects(chunk, at.views[v], planes_of(bits[v], i), seen);
          if (parted[v] >> i & 1) seen.keep(input.columns->objects(at.map, at.group, chunk, at.views[v]));
          if (at.views[v].occluders) count_occluded(v, drop_hidden_objects(chunk, at.views[v], seen));
        }
        counts.written += write_parts(chunk, viewers.whole, parts, counts.written, ids, masks);
      }
      if (input.levels) input.levels->note(chunk, at.views, ids + before, counts.written - before);
    }
  }
  return counts;
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(filtered_views);
HWY_EXPORT(hidden_chunks);

ChunkTally find_hidden_chunks(const PassInput& input, std::span<const GroupEntry> entries,
                              std::uint32_t* hidden) noexcept {
  return HWY_DYNAMIC_DISPATCH(hidden_chunks)(input, entries, hidden);
}

PassCounts cull_filtered_groups(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* out,
                                std::uint8_t* masks) noexcept {
  return HWY_DYNAMIC_DISPATCH(filtered_views)(input, entries, out, masks);
}

}  // namespace sightline::world
#endif
