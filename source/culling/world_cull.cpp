#include "culling/world_cull.hpp"

#include <bit>
#include <cstring>

#include <sightline/culling.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/world_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using partition::ChunkMap;
using F = hn::CappedTag<float, 16>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;

constexpr std::size_t kBlock = ChunkMap::kBlockCapacity;

// signed_distance() of a vector of points: mul and add apart, in its order, so that it rounds alike.
HWY_INLINE VF distance(const Plane& plane, VF x, VF y, VF z) {
  const F f;
  const VF xy = hn::Add(hn::Mul(hn::Set(f, plane.normal.x), x), hn::Mul(hn::Set(f, plane.normal.y), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(f, plane.normal.z), z)), hn::Set(f, plane.distance));
}

// A bit a lane, from the lowest.
HWY_INLINE std::uint32_t bits_of(hn::Mask<F> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(F(), mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((1u << hn::Lanes(F())) - 1);
}

// What one view sees of a block's chunks, a bit a chunk.
struct ChunkBits {
  std::uint32_t kept = 0;                              // not outside
  std::uint32_t crossing = 0;                          // some plane
  std::array<std::uint32_t, Frustum::sides> planes{};  // crossing this one
};

// The bounds of a block's chunks or a node's blocks, from the lane at which a bit 0 stands.
using Sides = std::array<const float*, 6>;

HWY_INLINE Sides sides_of(const ChunkMap::Block& block) {
  const auto& b = block.bounds;
  return {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data()};
}

// At most 32 boxes, readable up to the next multiple of 16.
HWY_INLINE ChunkBits classify_boxes(const Sides& sides, std::uint32_t count, const SectorView& view,
                                    PlaneSet planes) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  const std::uint32_t all = count == 32 ? ~0u : (1u << count) - 1;
  std::uint32_t outside = 0;
  ChunkBits out;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    const Plane& plane = view.frustum.planes[p];
    const auto &near = view.near_side[p], &far = view.far_side[p];
    for (std::size_t i = 0; i < count; i += lanes) {
      const VF high = distance(plane, hn::Load(f, sides[near[0]] + i), hn::Load(f, sides[near[1]] + i),
                               hn::Load(f, sides[near[2]] + i));
      const VF low = distance(plane, hn::Load(f, sides[far[0]] + i), hn::Load(f, sides[far[1]] + i),
                              hn::Load(f, sides[far[2]] + i));
      outside |= bits_of(hn::Lt(high, hn::Zero(f))) << i;
      out.planes[p] |= bits_of(hn::Lt(low, hn::Zero(f))) << i;
    }
    if ((all & ~outside) == 0) return {};
  }
  out.kept = all & ~outside;
  for (std::uint32_t& crossing : out.planes) out.crossing |= crossing &= out.kept;
  return out;
}

HWY_INLINE ChunkBits classify_chunks(const ChunkMap::Block& block, const SectorView& view, PlaneSet planes) {
  return classify_boxes(sides_of(block), block.count, view, planes);
}

// The planes among `from` that a chunk crosses.
HWY_INLINE PlaneSet planes_of(const ChunkBits& bits, std::uint32_t chunk) {
  PlaneSet planes = 0;
  for (std::uint32_t p = 0; p < Frustum::sides; ++p)
    planes |= static_cast<PlaneSet>((bits.planes[p] >> chunk & 1) << p);
  return planes;
}

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

// Writes up to 15 values more than count, which kCullPadding and the chunks' own padding leave room for.
HWY_INLINE void copy_ids(const ObjectId* HWY_RESTRICT from, std::size_t count, ObjectId* HWY_RESTRICT to) {
  const U u;
  for (std::size_t i = 0; i < count; i += hn::Lanes(u)) hn::StoreU(hn::Load(u, from + i), u, to + i);
}

struct Corner {
  const float *x, *y, *z;
  const Plane* plane;
};

HWY_INLINE std::size_t corners_of(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes,
                                  Corner* out) {
  const float* sides[6] = {chunk.min_x, chunk.min_y, chunk.min_z, chunk.max_x, chunk.max_y, chunk.max_z};
  std::size_t count = 0;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    const auto& near = view.near_side[p];
    out[count++] = {sides[near[0]], sides[near[1]], sides[near[2]], &view.frustum.planes[p]};
  }
  return count;
}

HWY_INLINE hn::Mask<F> inside(const Corner* corners, std::size_t count, std::size_t i) {
  const F f;
  VF worst = hn::Zero(f);
  for (std::size_t c = 0; c < count; ++c) {
    worst = hn::Min(worst, distance(*corners[c].plane, hn::Load(f, corners[c].x + i),
                                    hn::Load(f, corners[c].y + i), hn::Load(f, corners[c].z + i)));
  }
  return hn::Ge(worst, hn::Zero(f));
}

HWY_INLINE void prefetch(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes) {
  for (std::uint32_t i = 0; i < chunk.count; i += 16) hwy::Prefetch(chunk.objects + i);
  if (planes == 0) return;
  Corner corners[Frustum::sides];
  const std::size_t count = corners_of(chunk, view, planes, corners);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::uint32_t i = 0; i < chunk.count; i += 16) {
      hwy::Prefetch(corners[c].x + i), hwy::Prefetch(corners[c].y + i), hwy::Prefetch(corners[c].z + i);
    }
  }
}

// One view, frustum only: ids straight into `out`.
HWY_INLINE std::size_t cull_chunk(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes,
                                  ObjectId* HWY_RESTRICT out) {
  const F f;
  const U u;
  const std::size_t lanes = hn::Lanes(f);
  Corner corners[Frustum::sides];
  const std::size_t count = corners_of(chunk, view, planes, corners);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.count; i += lanes) {
    auto mask = inside(corners, count, i);
    if (i + lanes > chunk.count) mask = hn::And(mask, hn::FirstN(f, chunk.count - i));
    const auto keep = hn::RebindMask(u, mask);
    // Packed in a register and stored whole: the packing store is microcoded on some processors.
    hn::StoreU(hn::Compress(hn::Load(u, chunk.objects + i), keep), u, out + kept);
    kept += hn::CountTrue(u, keep);
  }
  return kept;
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
      kept += cull_chunk(chunk, seen, out + kept, masks ? masks + kept : nullptr);
    }
  }
  counts.written = kept;
  return counts;
}

// A bit an object of a chunk.
struct alignas(16) ObjectBits {
  std::array<std::uint8_t, ChunkMap::kCapacity / 8 + 4> bytes{};

  [[nodiscard]] std::uint8_t at(std::size_t i) const {
    return static_cast<std::uint8_t>(bytes[i / 8] >> (i % 8));
  }
};

HWY_INLINE hn::Mask<F> mask_at(const ObjectBits& bits, std::size_t i) {
  std::uint8_t from[8] = {bits.at(i), bits.bytes[i / 8 + 1]};
  if (hn::Lanes(F()) < 8) from[0] &= (1u << hn::Lanes(F())) - 1;
  return hn::LoadMaskBits(F(), from);
}

// The objects of a chunk that a view sees, by frustum and contribution.
HWY_INLINE void view_objects(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes,
                             ObjectBits& out) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  Corner corners[Frustum::sides];
  const std::size_t count = corners_of(chunk, view, planes, corners);
  out = {};
  for (std::size_t i = 0; i < chunk.count; i += lanes) {
    auto mask = inside(corners, count, i);
    if (view.area_scale > 0) {
      // π·r²·f² / d² >= min_area without the division; a bounding sphere that holds the eye always passes.
      const VF half = hn::Set(f, 0.5f);
      const auto square = [&](const float* low, const float* high, float eye, VF& radius,
                              VF& distance) HWY_ATTR {
        const VF a = hn::Mul(half, hn::Load(f, low + i)), b = hn::Mul(half, hn::Load(f, high + i));
        const VF extent = hn::Sub(b, a), offset = hn::Sub(hn::Add(a, b), hn::Set(f, eye));
        radius = hn::Add(radius, hn::Mul(extent, extent));
        distance = hn::Add(distance, hn::Mul(offset, offset));
      };
      VF radius = hn::Zero(f), distance = hn::Zero(f);
      square(chunk.min_x, chunk.max_x, view.eye.x, radius, distance);
      square(chunk.min_y, chunk.max_y, view.eye.y, radius, distance);
      square(chunk.min_z, chunk.max_z, view.eye.z, radius, distance);
      const VF limit = view.orthographic ? hn::Set(f, 1.0f) : distance;
      const auto large = hn::Ge(hn::Mul(radius, hn::Set(f, view.area_scale)), limit);
      mask = hn::And(mask, hn::Or(large, hn::Le(distance, radius)));
    }
    if (i + lanes > chunk.count) mask = hn::And(mask, hn::FirstN(f, chunk.count - i));
    const std::uint32_t bits = bits_of(mask) << (i % 8);
    out.bytes[i / 8] |= static_cast<std::uint8_t>(bits);
    out.bytes[i / 8 + 1] |= static_cast<std::uint8_t>(bits >> 8);
  }
}

// Takes out the chunks whose bounds the occluders hide.
void drop_hidden_chunks(const ChunkMap& map, const ChunkMap::Block& block, const SectorView& view,
                        ChunkBits& bits, PassCounts& counts) {
  const auto& b = block.bounds;
  std::array<std::uint8_t, kBlock> visible;
  query_boxes(*view.occluders, view.projection,
              {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data(), block.count},
              visible.data());
  for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (visible[i]) continue;
    bits.kept &= ~(1u << i);
    counts.occluded += map.chunk(block.chunks[i]).count;
  }
}

// Takes out the objects that the occluders hide, of those that the view sees otherwise.
void drop_hidden_objects(const ChunkMap::ChunkView& chunk, const SectorView& view, ObjectBits& seen,
                         PassCounts& counts) {
  std::array<std::uint8_t, ChunkMap::kCapacity> visible;
  query_boxes(*view.occluders, view.projection,
              {chunk.min_x, chunk.min_y, chunk.min_z, chunk.max_x, chunk.max_y, chunk.max_z, chunk.count},
              visible.data());
  for (std::uint32_t i = 0; i < chunk.count; ++i) {
    if (visible[i] || (seen.at(i) & 1) == 0) continue;
    seen.bytes[i / 8] &= static_cast<std::uint8_t>(~(1u << (i % 8)));
    ++counts.occluded;
  }
}

// Any views, any tests.
PassCounts many_views(const PassInput& input, std::span<const BlockEntry> entries, ObjectId* HWY_RESTRICT out,
                      std::uint8_t* HWY_RESTRICT masks) {
  const F f;
  const U u;
  const hn::Rebind<std::uint8_t, U> bytes;
  const std::size_t lanes = hn::Lanes(f);
  PassCounts counts;
  std::size_t kept = 0;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<ObjectBits, kMaxViews> seen;
  std::array<ChunkMap::ChunkView, kBlock> chunks;
  for (const BlockEntry& entry : entries) {
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Block& block = map.blocks()[entry.block];
    const SectorView* views = &input.views[entry.sector * input.view_count];
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) {
      bits[v] = {};
      if (entry.planes[v] != kOutside) bits[v] = classify_chunks(block, views[v], entry.planes[v]);
      if (views[v].occluders && bits[v].kept != 0) drop_hidden_chunks(map, block, views[v], bits[v], counts);
      any |= bits[v].kept;
    }
    counts.chunks += block.count;
    for (std::uint32_t rest = any; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      chunks[i] = map.chunk(block, static_cast<std::uint32_t>(i));
      PlaneSet planes = 0;
      std::size_t crossed_by = 0;
      for (std::size_t v = 0; v < input.view_count; ++v) {
        if ((bits[v].crossing >> i & 1) == 0) continue;
        planes = planes_of(bits[v], static_cast<std::uint32_t>(i));
        crossed_by = v;
      }
      prefetch(chunks[i], views[crossed_by], planes);
    }
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      std::uint8_t whole = 0, part = 0;  // views
      for (std::size_t v = 0; v < input.view_count; ++v) {
        if ((bits[v].kept >> i & 1) == 0) continue;
        const bool all = (bits[v].crossing >> i & 1) == 0 && views[v].area_scale == 0 && !views[v].occluders;
        (all ? whole : part) |= static_cast<std::uint8_t>(1u << v);
      }
      if (part == 0 || (whole != 0 && masks == nullptr)) {
        copy_ids(chunk.objects, chunk.count, out + kept);
        if (masks) std::memset(masks + kept, whole, chunk.count);
        kept += chunk.count;
        continue;
      }
      for (std::uint32_t rest = part; rest != 0; rest &= rest - 1) {
        const int v = std::countr_zero(rest);
        counts.tested += chunk.count;
        view_objects(chunk, views[v], planes_of(bits[v], i), seen[v]);
        if (views[v].occluders) drop_hidden_objects(chunk, views[v], seen[v], counts);
      }
      for (std::size_t k = 0; k < chunk.count; k += lanes) {
        auto mask = hn::Set(u, whole);
        for (std::uint32_t rest = part; rest != 0; rest &= rest - 1) {
          const int v = std::countr_zero(rest);
          const auto in_view = hn::RebindMask(u, mask_at(seen[v], k));
          mask = hn::Or(mask, hn::IfThenElseZero(in_view, hn::Set(u, 1u << v)));
        }
        auto keep = hn::Ne(mask, hn::Zero(u));
        if (k + lanes > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - k));
        hn::StoreU(hn::Compress(hn::Load(u, chunk.objects + k), keep), u, out + kept);
        if (masks)
          hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(hn::RebindToSigned<U>(), hn::Compress(mask, keep))),
                     bytes, masks + kept);
        kept += hn::CountTrue(u, keep);
      }
    }
  }
  counts.written = kept;
  return counts;
}

PassCounts run_pass(const PassInput& input, std::span<const BlockEntry> entries, ObjectId* out,
                    std::uint8_t* masks) {
  bool plain = true;
  for (const SectorView& view : input.views) plain = plain && view.area_scale == 0 && !view.occluders;
  if (!plain) return many_views(input, entries, out, masks);
  if (input.view_count == 1 && !masks) return one_view(input, entries, out);
  return frustum_views(input, entries, out, masks);
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::culling {
using partition::ChunkMap;
HWY_EXPORT(run_pass);
HWY_EXPORT(find_node_blocks);

void find_blocks(const ChunkMap::Node& node, std::span<const SectorView> views,
                 std::span<const PlaneSet, kMaxViews> planes, std::uint32_t sector,
                 std::vector<BlockEntry>& entries) noexcept {
  HWY_DYNAMIC_DISPATCH(find_node_blocks)(node, views, planes, sector, entries);
}

PassCounts cull_blocks(const PassInput& input, std::span<const BlockEntry> entries, ObjectId* out,
                       std::uint8_t* masks) noexcept {
  return HWY_DYNAMIC_DISPATCH(run_pass)(input, entries, out, masks);
}

}  // namespace sightline::culling
#endif
