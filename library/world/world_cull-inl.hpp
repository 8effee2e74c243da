// What the passes over a world's groups share, for every SIMD width: bounds and boxes against planes, and the
// writing of ids and masks.
// Included by files that foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_WORLD_CULL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_WORLD_CULL_INL
#undef SIGHTLINE_CULLING_WORLD_CULL_INL
#else
#define SIGHTLINE_CULLING_WORLD_CULL_INL
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include <sightline/frustum.hpp>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/mutant.h"
#include "library/geometry/simd-inl.hpp"
#include "library/world/world_cull.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using world::ChunkMap;
using F = hn::CappedTag<float, 16>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;
using geometry::prefetch_lines;
using geometry::HWY_NAMESPACE::bits_of;
using geometry::HWY_NAMESPACE::distance;
using geometry::HWY_NAMESPACE::lowest;
using geometry::HWY_NAMESPACE::mask_of;
using geometry::HWY_NAMESPACE::packed;
using geometry::HWY_NAMESPACE::spread;
using geometry::HWY_NAMESPACE::store_kept;
using Points = geometry::HWY_NAMESPACE::Points<VF>;

constexpr std::size_t kGroup = ChunkMap::kGroupCapacity;

// What one view sees of a group's chunks, a bit a chunk.
struct ChunkBits {
  std::uint32_t kept = 0;                              // not outside
  std::uint32_t crossing = 0;                          // some plane
  std::array<std::uint32_t, Frustum::sides> planes{};  // crossing this one
};

// The bounds of a group's chunks or a node's groups, from the lane at which a bit 0 stands.
using Sides = std::array<const float*, 6>;

HWY_INLINE Sides sides_of(const ChunkMap::Group& group) {
  const auto& b = group.bounds;
  return {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data()};
}

// Which boxes of the vector at lane i have the corner that three of their sides make behind the plane.
HWY_INLINE hn::Mask<F> behind(const Plane& plane, const Sides& sides,
                              const std::array<std::uint8_t, 3>& corner, std::size_t i) {
  const F f;
  const Points at{hn::Load(f, sides[corner[0]] + i), hn::Load(f, sides[corner[1]] + i),
                  hn::Load(f, sides[corner[2]] + i)};
  return hn::Lt(distance(plane, at), hn::Zero(f));
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
    const Plane& plane = view.planes[p];
    const auto &near = view.near_side[p], &far = view.far_side[p];
    for (std::size_t i = 0; i < count; i += lanes) {
      outside |= bits_of(f, behind(plane, sides, near, i)) << i;
      out.planes[p] |= bits_of(f, behind(plane, sides, far, i)) << i;
    }
    if ((all & ~outside) == 0) return {};
  }
  out.kept = all & ~outside;
  for (std::uint32_t& crossing : out.planes) out.crossing |= crossing &= out.kept;
  return out;
}

HWY_INLINE ChunkBits classify_chunks(const ChunkMap::Group& group, const SectorView& view, PlaneSet planes) {
  return classify_boxes(sides_of(group), group.count, view, planes);
}

// Those of the planes `among` that a chunk crosses.
HWY_INLINE PlaneSet planes_of(const ChunkBits& bits, std::uint32_t chunk, PlaneSet among = kAllPlanes) {
  PlaneSet planes = 0;
  for (std::uint32_t rest = among; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    planes |= static_cast<PlaneSet>((bits.planes[p] >> chunk & 1) << p);
  }
  return planes;
}

// Writes up to 63 values more than count, which kCullPadding leaves room for. Most chunks hold 48 to 96
// objects, evenly spread: one guess at whether there are more than 64 goes wrong less often than where a loop
// ends.
HWY_INLINE void copy_ids(const ObjectId* HWY_RESTRICT from, std::size_t count, ObjectId* HWY_RESTRICT to) {
  const U u;
  const auto copy = [&](std::size_t first, std::size_t end) HWY_ATTR {
    for (std::size_t i = first; i < end; i += hn::Lanes(u)) hn::StoreU(hn::Load(u, from + i), u, to + i);
  };
  if (count <= ChunkMap::kSmallCapacity) return copy(0, ChunkMap::kSmallCapacity);
  copy(0, 64);
  if (count > 64) copy(64, ChunkMap::kCapacity);
}

// The lanes of `ids` that are no holes.
HWY_INLINE hn::Mask<U> are_objects(hn::Vec<U> ids) {
  return hn::Ne(ids, hn::Set(U(), kNoObject));
}

// All objects of a chunk with holes; writes up to a vector more. Returns how many there are.
HWY_INLINE std::size_t copy_objects(const ChunkMap::ChunkView& chunk, ObjectId* HWY_RESTRICT to) {
  const U u;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(u)) {
    const auto ids = hn::Load(u, chunk.objects + i);
    auto keep = are_objects(ids);
    if (i + hn::Lanes(u) > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    kept += store_kept(u, ids, keep, to + kept);
  }
  return kept;
}

// The same, holes or not; writes up to 63 more.
HWY_INLINE std::size_t copy_chunk(const ChunkMap::ChunkView& chunk, ObjectId* HWY_RESTRICT to) {
  if (chunk.loose) return copy_objects(chunk, to);
  copy_ids(chunk.objects, chunk.count, to);
  return chunk.count;
}

// Those of objects i … that a vector of D holds.
template <class D>
HWY_INLINE hn::Mask<D> mask_at(D d, const ObjectBits& bits, std::size_t i) {
  if (hn::Lanes(d) < 8) return mask_of(d, bits.words[i / 64] >> (i % 64));
  std::uint8_t bytes[8];  // whole ones need no shift
  std::memcpy(bytes, reinterpret_cast<const std::uint8_t*>(&bits.words) + i / 8, hn::Lanes(d) / 8);
  return hn::LoadMaskBits(d, bytes);
}

HWY_INLINE void prefetch_ids(const ChunkMap::ChunkView& chunk) {
  // Boxes are read along their rows, which processors find out by themselves.
  for (std::uint32_t i = 0; i < 64; i += 16) hwy::Prefetch(chunk.objects + i);
  if (chunk.count <= 64) return;
  for (std::uint32_t i = 64; i < ChunkMap::kCapacity; i += 16) hwy::Prefetch(chunk.objects + i);
}

// A bit an object, as `seen(i)` says of the vector that begins there.
template <class Seen>
HWY_INLINE ObjectBits bits_of_objects(std::size_t count, const Seen& seen) {
  std::uint64_t low = 0, high = 0;
  const auto bits = [&](std::size_t i) HWY_ATTR { return std::uint64_t{bits_of(F(), seen(i))}; };
  const std::size_t first = std::min<std::size_t>(count, 64);
  for (std::size_t i = 0; i < first; i += hn::Lanes(F())) low |= bits(i) << i;
  for (std::size_t i = 64; i < count; i += hn::Lanes(F())) high |= bits(i) << (i - 64);
  return {{low, high}};
}

// A bit each for as many objects.
HWY_INLINE ObjectBits first_objects(std::uint32_t count) {
  const auto below = [](std::uint32_t end) {
    return end >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << end) - 1;
  };
  return {{below(count), count > 64 ? below(count - 64) : 0}};
}

// A bit an object of the chunk; none for holes.
HWY_INLINE ObjectBits live_objects(const ChunkMap::ChunkView& chunk) {
  if (!chunk.loose) return first_objects(chunk.count);
  const U u;
  return bits_of_objects(chunk.count, [&](std::size_t i) HWY_ATTR {
    auto live = are_objects(hn::Load(u, chunk.objects + i));
    if (i + hn::Lanes(u) > chunk.count) live = hn::And(live, hn::FirstN(u, chunk.count - i));
    return hn::RebindMask(F(), live);
  });
}

// Of a vector of objects their bounding spheres' radii and their middles' distances from the eye, both
// squared.
struct WideSpheres {
  VF radius, distance;
};

HWY_INLINE WideSpheres spheres_of(const ChunkMap::ChunkView& chunk, const Vec3& eye, std::size_t i) {
  const F f;
  const VF half = hn::Set(f, 0.5f);
  WideSpheres out{hn::Zero(f), hn::Zero(f)};
  const auto add = [&](std::size_t axis, float at) HWY_ATTR {
    const VF a = hn::Mul(half, hn::Load(f, chunk.side(axis) + i)),
             b = hn::Mul(half, hn::Load(f, chunk.side(axis + 3) + i));
    const VF extent = hn::Sub(b, a), offset = hn::Sub(hn::Add(a, b), hn::Set(f, at));
    out.radius = hn::Add(out.radius, hn::Mul(extent, extent));
    out.distance = hn::Add(out.distance, hn::Mul(offset, offset));
  };
  add(0, eye.x), add(1, eye.y), add(2, eye.z);
  return out;
}

// --- objects against planes ---

HWY_INLINE hn::Mask<F> not_behind(VF distance) {
  const VF zero = hn::Zero(F());
  return SIGHTLINE_MUTANT(boxes_on_a_plane_dropped) ? hn::Gt(distance, zero) : hn::Ge(distance, zero);
}

// Takes out of `left` the objects of a chunk that lie behind a plane.
HWY_INLINE void drop_behind(const ChunkMap::ChunkView& chunk, const Plane& plane,
                            const std::array<std::uint8_t, 3>& near, ObjectBits& left) {
  const F f;
  const float *x = chunk.side(near[0]), *y = chunk.side(near[1]), *z = chunk.side(near[2]);
  left.keep(bits_of_objects(chunk.count, [&](std::size_t i) HWY_ATTR {
    const Points corner{hn::Load(f, x + i), hn::Load(f, y + i), hn::Load(f, z + i)};
    return not_behind(distance(plane, corner));
  }));
}

// The chunks of a group, as far as they were found.
using Chunks = std::array<ChunkMap::ChunkView, kGroup>;

// Which objects a view's planes leave of the chunks that cross some, holes among them; of others nothing.
using CrossedBits = std::array<ObjectBits, kGroup>;

// Of those of the group's chunks that are `asked`. Plane by plane rather than chunk by chunk: what is to be
// known of a plane is found once a group, and hardly a branch depends on the chunk.
HWY_INLINE void test_crossed(const Chunks& chunks, const SectorView& view, PlaneSet among,
                             const ChunkBits& bits, std::uint32_t asked, CrossedBits& left) {
  asked &= bits.crossing;
  if (asked == 0) return;
  const auto for_each = [](std::uint32_t those, const auto& visit) HWY_ATTR {
    for (; those != 0; those &= those - 1) visit(static_cast<std::uint32_t>(std::countr_zero(those)));
  };
  for_each(asked, [&](std::uint32_t i) HWY_ATTR { left[i] = first_objects(chunks[i].count); });
  for (std::uint32_t planes = among; planes != 0; planes &= planes - 1) {
    const int p = std::countr_zero(planes);
    const Plane plane = view.planes[p];
    const std::array<std::uint8_t, 3> near = view.near_side[p];
    for_each(bits.planes[p] & asked,
             [&](std::uint32_t i) HWY_ATTR { drop_behind(chunks[i], plane, near, left[i]); });
  }
}

// --- what several views see of a chunk ---

// Views that may see a part of a chunk, and which of its objects they do see.
struct ChunkViews {
  std::size_t count = 0;
  std::array<std::uint8_t, kMaxViews> bits{};  // of a mask
  std::array<ObjectBits, kMaxViews> seen;
};

// One value for all of a chunk's objects. Writes up to 63 more than count.
HWY_INLINE void fill_masks(std::uint8_t mask, std::size_t count, std::uint8_t* HWY_RESTRICT to) {
  const hn::ScalableTag<std::uint8_t> u8;
  for (std::size_t i = 0; i < count; i += hn::Lanes(u8)) hn::StoreU(hn::Set(u8, mask), u8, to + i);
}

HWY_INLINE void store_masks(hn::Vec<U> masks, std::uint8_t* HWY_RESTRICT to) {
  const hn::Rebind<std::uint8_t, U> bytes;
  hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(hn::RebindToSigned<U>(), masks)), bytes, to);
}

// All objects of a chunk, with one mask. This and what follows writes ids, and masks where they are wanted
// (not null), behind the first `kept` of a pass, and returns how many.
HWY_INLINE std::size_t write_whole(const ChunkMap::ChunkView& chunk, std::uint8_t mask, std::size_t kept,
                                   ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks) {
  const std::size_t count = copy_chunk(chunk, ids + kept);
  if (masks) fill_masks(mask, count, masks + kept);
  return count;
}

// The objects of a chunk that views see; those of `whole` see all of them.
HWY_INLINE std::size_t write_seen(const ChunkMap::ChunkView& chunk, std::uint8_t whole,
                                  const ChunkViews& views, std::size_t kept, ObjectId* HWY_RESTRICT ids,
                                  std::uint8_t* HWY_RESTRICT masks) {
  const U u;
  const std::size_t lanes = hn::Lanes(u), before = kept;
  for (std::size_t i = 0; i < chunk.count; i += lanes) {
    auto mask = hn::Set(u, whole);
    for (std::size_t k = 0; k < views.count; ++k)
      mask = hn::Or(mask, hn::IfThenElseZero(mask_at(u, views.seen[k], i), hn::Set(u, views.bits[k])));
    auto keep = hn::Ne(mask, hn::Zero(u));
    if (i + lanes > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    const auto objects = hn::Load(u, chunk.objects + i);
    if (chunk.loose) keep = hn::And(keep, are_objects(objects));
    if (masks) store_masks(packed(u, mask, keep), masks + kept);
    kept += store_kept(u, objects, keep, ids + kept);
  }
  return kept - before;
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

// A chunk that the views of `whole` see all of, others some of. Masks are wanted where `whole` is not 0.
HWY_INLINE std::size_t write_parts(const ChunkMap::ChunkView& chunk, std::uint8_t whole,
                                   const ChunkViews& views, std::size_t kept, ObjectId* HWY_RESTRICT ids,
                                   std::uint8_t* HWY_RESTRICT masks) {
  if (whole == 0 || chunk.loose) return write_seen(chunk, whole, views, kept, ids, masks);
  copy_ids(chunk.objects, chunk.count, ids + kept);
  write_masks(chunk, whole, views, masks + kept);
  return chunk.count;
}

// --- groups ---

// What a pass reads of an entry.
struct EntryGroup {
  const ChunkMap& map;
  const ChunkMap::Group& group;
  const SectorView* views;  // the sector's
  std::uint32_t number;     // the group's
};

HWY_INLINE EntryGroup group_of(const PassInput& input, const GroupEntry& entry) {
  const ChunkMap& map = *input.maps[entry.sector];
  return {map, map.groups()[entry.group], &input.views[entry.sector * input.view_count], entry.group};
}

// Of the group that comes after the next, for by then it will have arrived.
HWY_INLINE void prefetch_group(const PassInput& input, std::span<const GroupEntry> entries, std::size_t e) {
  if (e + 2 < entries.size()) prefetch_lines(group_of(input, entries[e + 2]).group);
}

// The same of what the group knows of columns. By itself, as most worlds have none.
HWY_NOINLINE inline void prefetch_columns(const PassInput& input, std::span<const GroupEntry> entries,
                                          std::size_t e) {
  if (e + 2 >= entries.size()) return;
  const EntryGroup next = group_of(input, entries[e + 2]);
  constexpr std::size_t kLine = 16;
  if (const std::uint32_t* rows = next.map.layer_rows(next.number))
    for (std::size_t i = 0; i < LayerRows::kSize; i += kLine) hwy::Prefetch(rows + i);
  if (const float* rows = next.map.distance_rows(next.number))
    for (std::size_t i = 0; i < DistanceRows::kSize; i += kLine) hwy::Prefetch(rows + i);
}

// Takes out the chunks of which the columns leave nothing; returns those of which they leave a part.
HWY_INLINE std::uint32_t ask_columns(const PassInput& input, const EntryGroup& at, const SectorView& view,
                                     ChunkBits& bits) {
  if (bits.kept == 0) return 0;
  const ColumnBits left = input.columns->chunks(at.map, at.number, view);
  bits.kept &= left.some, bits.crossing &= left.some;
  return bits.kept & ~left.all;
}

// Finds the chunks of a group whose bits are set. Memory is what a pass waits for: all of a group's is asked
// for before any of it is used.
HWY_INLINE void find_chunks(const EntryGroup& at, std::uint32_t bits, Chunks& chunks) {
  for (; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
    chunks[i] = at.map.chunk(at.group, i);
    prefetch_ids(chunks[i]);
  }
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
