// Culling by frustum: the blocks of a node, then their chunks and objects, for one view or several.
#include "culling/world_cull.hpp"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/world_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "culling/world_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

void find_node_blocks(const ChunkMap::Node& node, std::span<const SectorView> views,
                      std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                      std::vector<BlockEntry>& entries) {
  constexpr std::uint32_t kSome = 32;
  std::array<ChunkBits, kMaxViews> bits;
  const auto& rows = node.block_boxes.sides;
  const auto count = static_cast<std::uint32_t>(node.blocks.size());
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
      BlockEntry entry{sector, node.blocks[first + i], {}};
      entry.planes.fill(kOutside);
      for (std::size_t v = 0; v < views.size(); ++v) {
        if (bits[v].kept >> i & 1) entry.planes[v] = planes_of(bits[v], i);
      }
      entries.push_back(entry);
    }
  }
}

// Of the block that comes after the next, for by then it will have arrived.
HWY_INLINE void prefetch_block(const PassInput& input, std::span<const BlockEntry> entries, std::size_t e) {
  if (e + 2 >= entries.size()) return;
  const BlockEntry& entry = entries[e + 2];
  const auto* from = reinterpret_cast<const std::uint8_t*>(&input.maps[entry.sector]->blocks()[entry.block]);
  for (std::size_t at = 0; at < sizeof(ChunkMap::Block); at += 64) hwy::Prefetch(from + at);
}

PassCounts one_view(const PassInput& input, std::span<const BlockEntry> entries, ObjectId* HWY_RESTRICT out) {
  PassCounts counts;
  ObjectId* at = out;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const BlockEntry& entry = entries[e];
    prefetch_block(input, entries, e);
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Block& block = map.blocks()[entry.block];
    const SectorView& view = input.views[entry.sector];
    const ChunkBits bits = classify_chunks(block, view, entry.planes[0]);
    counts.chunks += block.count;
    // Memory is what this waits for: the whole block's is asked for before any of it is used.
    std::array<ChunkMap::ChunkView, kBlock> chunks;
    std::array<PlaneSet, kBlock> planes;
    std::size_t kept = 0;
    for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      chunks[kept] = map.chunk(block, i);
      planes[kept] = planes_of(bits, i);
      prefetch(chunks[kept], view, planes[kept]);
      ++kept;
    }
    for (std::size_t k = 0; k < kept; ++k) {
      const ChunkMap::ChunkView& chunk = chunks[k];
      if (planes[k] == 0) {
        copy_ids(chunk.objects, chunk.count, at);
        at += chunk.count;
      } else {
        counts.tested += chunk.count;
        at += cull_chunk(chunk, view, planes[k], at);
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

// What the frustums of some views say of one chunk.
struct ChunkViews {
  std::uint8_t whole = 0;  // views that see all of it
  std::size_t crossed = 0;
  std::array<std::uint8_t, kMaxViews> view{};  // of those that may see a part
  std::array<std::size_t, kMaxViews> corners{};
  std::array<std::array<Corner, Frustum::sides>, kMaxViews> corner;
};

// The objects of a chunk that views cross: ids and masks, behind one another.
HWY_INLINE std::size_t cull_chunk(const ChunkMap::ChunkView& chunk, const ChunkViews& seen,
                                  ObjectId* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) {
  const F f;
  const U u;
  const hn::Rebind<std::uint8_t, U> bytes;
  const std::size_t lanes = hn::Lanes(f);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.count; i += lanes) {
    auto mask = hn::Set(u, seen.whole);
    for (std::size_t k = 0; k < seen.crossed; ++k) {
      const auto in_view = hn::RebindMask(u, inside(seen.corner[k].data(), seen.corners[k], i));
      mask = hn::Or(mask, hn::IfThenElseZero(in_view, hn::Set(u, 1u << seen.view[k])));
    }
    auto keep = hn::Ne(mask, hn::Zero(u));
    if (i + lanes > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    hn::StoreU(hn::Compress(hn::Load(u, chunk.objects + i), keep), u, out + kept);
    if (masks)
      hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(hn::RebindToSigned<U>(), hn::Compress(mask, keep))), bytes,
                 masks + kept);
    kept += hn::CountTrue(u, keep);
  }
  return kept;
}

// Several views, frustum only.
PassCounts frustum_views(const PassInput& input, std::span<const BlockEntry> entries,
                         ObjectId* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) {
  PassCounts counts;
  std::size_t kept = 0;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<ChunkMap::ChunkView, kBlock> chunks;
  ChunkViews seen;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const BlockEntry& entry = entries[e];
    prefetch_block(input, entries, e);
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Block& block = map.blocks()[entry.block];
    const SectorView* views = &input.views[entry.sector * input.view_count];
    std::uint32_t any = 0, crossed = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) {
      bits[v] = {};
      if (entry.planes[v] != kOutside) bits[v] = classify_chunks(block, views[v], entry.planes[v]);
      any |= bits[v].kept, crossed |= bits[v].crossing;
    }
    counts.chunks += block.count;
    for (std::uint32_t rest = any; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      chunks[i] = map.chunk(block, i);
      prefetch(chunks[i], views[0], 0);
      if ((crossed >> i & 1) == 0) continue;
      for (std::size_t v = 0; v < input.view_count; ++v) {
        if (bits[v].crossing >> i & 1) prefetch(chunks[i], views[v], planes_of(bits[v], i));
      }
    }
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      seen.whole = 0, seen.crossed = 0;
      for (std::size_t v = 0; v < input.view_count; ++v) {
        const std::uint32_t in = bits[v].kept >> i & 1, crosses = bits[v].crossing >> i & 1;
        seen.whole |= static_cast<std::uint8_t>((in & ~crosses) << v);
        seen.view[seen.crossed] = static_cast<std::uint8_t>(v);
        seen.crossed += crosses;
      }
      if (seen.crossed == 0 || (seen.whole != 0 && masks == nullptr)) {
        copy_ids(chunk.objects, chunk.count, out + kept);
        if (masks) fill_masks(seen.whole, chunk.count, masks + kept);
        kept += chunk.count;
        continue;
      }
      counts.tested += seen.crossed * chunk.count;
      for (std::size_t k = 0; k < seen.crossed; ++k) {
        const std::size_t v = seen.view[k];
        seen.corners[k] = corners_of(chunk, views[v], planes_of(bits[v], i), seen.corner[k].data());
      }
      if (seen.whole == 0 && seen.crossed == 1) {
        // One view alone: its mask is the same for all.
        const std::size_t v = seen.view[0];
        const std::size_t count = cull_chunk(chunk, views[v], planes_of(bits[v], i), out + kept);
        if (masks) fill_masks(static_cast<std::uint8_t>(1u << v), count, masks + kept);
        kept += count;
        continue;
      }
      kept += cull_chunk(chunk, seen, out + kept, masks ? masks + kept : nullptr);
    }
  }
  counts.written = kept;
  return counts;
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::culling {
using partition::ChunkMap;
HWY_EXPORT(one_view);
HWY_EXPORT(frustum_views);
HWY_EXPORT(find_node_blocks);

void find_blocks(const ChunkMap::Node& node, std::span<const SectorView> views,
                 std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                 std::vector<BlockEntry>& entries) noexcept {
  HWY_DYNAMIC_DISPATCH(find_node_blocks)(node, views, planes, sector, entries);
}

PassCounts cull_blocks(const PassInput& input, std::span<const BlockEntry> entries, ObjectId* out,
                       std::uint8_t* masks) noexcept {
  bool plain = true;
  for (const SectorView& view : input.views) plain = plain && view.area_scale == 0 && !view.occluders;
  if (!plain) return cull_filtered_blocks(input, entries, out, masks);
  if (input.view_count == 1 && !masks) return HWY_DYNAMIC_DISPATCH(one_view)(input, entries, out);
  return HWY_DYNAMIC_DISPATCH(frustum_views)(input, entries, out, masks);
}

}  // namespace sightline::culling
#endif
