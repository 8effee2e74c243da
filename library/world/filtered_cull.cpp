// Culling by frustum, contribution and occlusion, for any views.
#include "library/world/world_cull.hpp"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/filtered_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/world_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

// The objects of a chunk that a view sees, by frustum and contribution.
HWY_INLINE void view_objects(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes,
                             ObjectBits& out) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  Corner corners[Frustum::sides];
  const std::size_t count = corners_of(chunk, view, planes, corners);
  out = test_objects(chunk, corners, count, [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
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
    return mask;
  });
}

// Takes out the chunks whose bounds the occluders hide. Returns how many objects they hold.
std::uint64_t drop_hidden_chunks(const ChunkMap& map, const ChunkMap::Group& group, const SectorView& view,
                                 ChunkBits& bits) {
  std::uint64_t dropped = 0;
  const auto& b = group.bounds;
  std::array<std::uint8_t, kGroup> visible;
  occlusion::query_boxes(
      *view.occluders, view.projection,
      {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data(), group.count},
      visible.data());
  for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (visible[i]) continue;
    bits.kept &= ~(1u << i);
    dropped += map.chunk(group.chunks[i]).count;
  }
  return dropped;
}

// Takes out the objects that the occluders hide, of those that the view sees otherwise. Returns how many.
std::uint64_t drop_hidden_objects(const ChunkMap::ChunkView& chunk, const SectorView& view,
                                  ObjectBits& seen) {
  std::uint64_t dropped = 0;
  std::array<std::uint8_t, ChunkMap::kCapacity> visible;
  occlusion::query_boxes(
      *view.occluders, view.projection,
      {chunk.min_x, chunk.min_y, chunk.min_z, chunk.max_x, chunk.max_y, chunk.max_z, chunk.count},
      visible.data());
  for (std::uint32_t i = 0; i < chunk.count; ++i) {
    if (visible[i] || !seen.at(i)) continue;
    seen.drop(i);
    ++dropped;
  }
  return dropped;
}

// Any views, any tests.
PassCounts filtered_views(const PassInput& input, std::span<const GroupEntry> entries,
                          ObjectId* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) {
  const F f;
  const U u;
  const hn::Rebind<std::uint8_t, U> bytes;
  const std::size_t lanes = hn::Lanes(f);
  PassCounts counts;
  std::size_t kept = 0;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<ObjectBits, kMaxViews> seen;
  std::array<std::uint64_t, kMaxViews> times;  // that the caller asks for the view
  for (std::size_t v = 0; v < kMaxViews; ++v)
    times[v] = static_cast<std::uint64_t>(std::popcount(input.bits[v]));
  std::array<ChunkMap::ChunkView, kGroup> chunks;
  for (const GroupEntry& entry : entries) {
    const ChunkMap& map = *input.maps[entry.sector];
    const ChunkMap::Group& group = map.groups()[entry.group];
    const SectorView* views = &input.views[entry.sector * input.view_count];
    std::uint32_t any = 0;
    for (std::size_t v = 0; v < input.view_count; ++v) {
      bits[v] = {};
      if (entry.planes[v] != kOutside) bits[v] = classify_chunks(group, views[v], entry.planes[v]);
      if (views[v].occluders && bits[v].kept != 0)
        counts.occluded += times[v] * drop_hidden_chunks(map, group, views[v], bits[v]);
      any |= bits[v].kept;
    }
    counts.chunks += group.count;
    for (std::uint32_t rest = any; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      chunks[i] = map.chunk(group, static_cast<std::uint32_t>(i));
      prefetch_ids(chunks[i]);
    }
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      std::uint8_t whole = 0, part = 0;  // bits of the caller's views; views
      for (std::size_t v = 0; v < input.view_count; ++v) {
        if ((bits[v].kept >> i & 1) == 0) continue;
        const bool all = (bits[v].crossing >> i & 1) == 0 && views[v].area_scale == 0 && !views[v].occluders;
        if (all) whole |= input.bits[v];
        if (!all) part |= static_cast<std::uint8_t>(1u << v);
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
        if (views[v].occluders) counts.occluded += times[v] * drop_hidden_objects(chunk, views[v], seen[v]);
      }
      for (std::size_t k = 0; k < chunk.count; k += lanes) {
        auto mask = hn::Set(u, whole);
        for (std::uint32_t rest = part; rest != 0; rest &= rest - 1) {
          const int v = std::countr_zero(rest);
          const auto in_view = mask_at(u, seen[v], k);
          mask = hn::Or(mask, hn::IfThenElseZero(in_view, hn::Set(u, input.bits[v])));
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

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(filtered_views);

PassCounts cull_filtered_groups(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* out,
                                std::uint8_t* masks) noexcept {
  return HWY_DYNAMIC_DISPATCH(filtered_views)(input, entries, out, masks);
}

}  // namespace sightline::world
#endif
