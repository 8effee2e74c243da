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

PassCounts filtered_views(const PassInput& input, std::span<const GroupEntry> entries,
                          ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks) {
  return cull_filtered(input, entries, ids, masks, NoNotes{});
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
