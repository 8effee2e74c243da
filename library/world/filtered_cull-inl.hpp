// The tests besides the frustum that passes over a world's groups have: contribution, columns and occlusion.
// Included by files that foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_FILTERED_CULL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_FILTERED_CULL_INL
#undef SIGHTLINE_CULLING_FILTERED_CULL_INL
#else
#define SIGHTLINE_CULLING_FILTERED_CULL_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "library/geometry/mutant.h"
#include "library/world/world_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

// The objects of a chunk whose bounding spheres are large enough on a view's image; bits from its count on
// mean nothing.
HWY_INLINE ObjectBits large_objects(const ChunkMap::ChunkView& chunk, const SectorView& view) {
  const F f;
  return bits_of_objects(chunk.count, [&](std::size_t i) HWY_ATTR {
    // π·r²·f² / d² >= min_area without the division; a bounding sphere that holds the eye always passes.
    const auto [radius, distance] = spheres_of(chunk, view.eye, i);
    const VF limit = view.orthographic ? hn::Set(f, 1.0f) : distance;
    const auto large = hn::Ge(hn::Mul(radius, hn::Set(f, view.area_scale)), limit);
    return hn::Or(large, hn::Le(distance, radius));
  });
}

// Which of a group's chunks the occluders do not hide, a byte each.
using ChunkAnswers = std::array<std::uint8_t, kGroup>;
HWY_INLINE void ask_chunks(const ChunkMap::Group& group, const SectorView& view, ChunkAnswers& visible) {
  view.occluders->ask->boxes(*view.occluders, view.projection, boxes_of(group), visible.data());
}

inline std::uint64_t objects_of(const ChunkMap::ChunkView& chunk) {
  return chunk.count -
         static_cast<std::uint64_t>(std::count(chunk.objects, chunk.objects + chunk.count, kNoObject));
}

// Of a chunk that the columns part, those that they leave.
inline std::uint64_t objects_left(const PassInput& input, const EntryGroup& at,
                                  const ChunkMap::ChunkView& chunk, const SectorView& view) {
  const ObjectBits seen = input.columns->objects(at.map, at.group, chunk, view);
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < chunk.count; ++i) count += seen.at(i) && chunk.objects[i] != kNoObject;
  return count;
}

// Takes out the chunks whose bounds the occluders hide. Returns how many objects they hold that the columns
// leave.
inline std::uint64_t drop_hidden_chunks(const PassInput& input, const EntryGroup& at, const SectorView& view,
                                        std::uint32_t parted, ChunkBits& bits) {
  std::uint64_t dropped = 0;
  ChunkAnswers visible;
  ask_chunks(at.group, view, visible);
  for (std::uint32_t rest = bits.kept; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (visible[i]) continue;
    bits.kept &= ~(1u << i);
    const ChunkMap::ChunkView chunk = at.map.chunk(at.group, static_cast<std::uint32_t>(i));
    dropped += parted >> i & 1 ? objects_left(input, at, chunk, view) : objects_of(chunk);
  }
  return dropped;
}

// Boxes of some of a chunk's objects, one after another, and whole vectors of them.
struct PackedBoxes {
  static constexpr std::size_t kMost = ChunkMap::kCapacity + 16;
  alignas(64) std::array<std::array<float, kMost>, 6> sides;
  std::size_t count = 0;

  [[nodiscard]] geometry::BoxSpan boxes() const { return geometry::span_of(sides, count); }
};

// Packs the boxes of `which`, at least one; behind them the last again.
HWY_INLINE void pack_boxes(const ChunkMap::ChunkView& chunk, const ObjectBits& which, PackedBoxes& out) {
  const F f;
  std::size_t count = 0;
  for (std::size_t side = 0; side < 6; ++side) {
    count = 0;
    for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(f))
      count +=
          store_kept(f, hn::Load(f, chunk.side(side) + i), mask_at(f, which, i), &out.sides[side][count]);
    hn::StoreU(hn::Set(f, out.sides[side][count - 1]), f, &out.sides[side][count]);
  }
  out.count = (count + hn::Lanes(f) - 1) / hn::Lanes(f) * hn::Lanes(f);
}

// Takes out the objects that the occluders hide, of those that the view sees otherwise, who alone are asked
// for. Returns how many.
inline std::uint64_t drop_hidden_objects(const ChunkMap::ChunkView& chunk, const SectorView& view,
                                         ObjectBits& seen) {
  std::uint64_t dropped = 0;
  if (SIGHTLINE_MUTANT(world_by_frustum)) return dropped;
  seen.keep(first_objects(chunk.count));
  const int count = std::popcount(seen.words[0]) + std::popcount(seen.words[1]);
  if (count == 0) return dropped;
  PackedBoxes some;
  const bool all = static_cast<std::uint32_t>(count) == chunk.count;
  if (!all) pack_boxes(chunk, seen, some);
  std::array<std::uint8_t, PackedBoxes::kMost> visible;
  view.occluders->ask->boxes(*view.occluders, view.projection, all ? chunk.boxes() : some.boxes(),
                             visible.data());
  const std::uint8_t* answer = visible.data();
  for (std::uint64_t& word : seen.words) {
    for (std::uint64_t rest = word; rest != 0; rest &= rest - 1) {
      if (*answer++) continue;
      word &= ~(rest & (~rest + 1));
      ++dropped;
    }
  }
  return dropped;
}

// The chunks of a group that a view may see. Those that are known to be hidden are not asked for again.
HWY_INLINE ChunkBits filter_chunks(const PassInput& input, const EntryGroup& at, const SectorView& view,
                                   PlaneSet planes, const std::uint32_t* hidden, std::uint32_t& parted,
                                   std::uint64_t& dropped) {
  parted = 0;
  if (planes == kOutside) return {};
  ChunkBits bits = classify_chunks(at.group, view, planes);
  if (input.columns) parted = ask_columns(input, at, view, bits);
  if (hidden) {
    bits.kept &= ~*hidden;
  } else if (view.occluders && bits.kept != 0 && !SIGHTLINE_MUTANT(world_by_frustum)) {
    dropped += drop_hidden_chunks(input, at, view, parted, bits);
  }
  return bits;
}

// What a view sees of a chunk of which something is to be tested; `left` by its planes, where it crosses
// some.
HWY_INLINE ObjectBits view_objects(const PassInput& input, const EntryGroup& at, const SectorView& view,
                                   const ChunkMap::ChunkView& chunk, const ObjectBits* left, bool parted,
                                   std::uint64_t& occluded) {
  ObjectBits seen = live_objects(chunk);
  if (left) seen.keep(*left);
  if (view.area_scale > 0) seen.keep(large_objects(chunk, view));
  if (parted) seen.keep(input.columns->objects(at.map, at.group, chunk, view));
  if (view.occluders) occluded += drop_hidden_objects(chunk, view, seen);
  return seen;
}

// The chunks that a view sees all of, with nothing left to test.
HWY_INLINE std::uint32_t seen_whole(const SectorView& view, const ChunkBits& bits, std::uint32_t parted) {
  return view.area_scale > 0 || view.occluders ? 0 : bits.kept & ~(bits.crossing | parted);
}

// Tests what crosses planes, for each view. Without masks, who is seen whole by one view need not be asked
// for others.
HWY_INLINE void test_crossed_by_all(const PassInput& input, const GroupEntry& entry, const SectorView* views,
                                    const std::array<ChunkBits, kMaxViews>& bits,
                                    const std::array<std::uint32_t, kMaxViews>& parted, bool masks,
                                    const Chunks& chunks, std::array<CrossedBits, kMaxViews>& left) {
  std::uint32_t asked = ~0u;
  for (std::size_t v = 0; v < input.view_count && !masks; ++v)
    asked &= ~seen_whole(views[v], bits[v], parted[v]);
  for (std::size_t v = 0; v < input.view_count; ++v)
    test_crossed(chunks, views[v], entry.planes[v], bits[v], bits[v].kept & asked, left[v]);
}

// Who sees a chunk, and how: bits of a mask where nothing is left to test, views where something is.
struct ChunkViewers {
  std::uint8_t whole = 0, part = 0;
};

HWY_INLINE ChunkViewers viewers_of(const PassInput& input, const EntryGroup& at,
                                   const std::array<ChunkBits, kMaxViews>& bits,
                                   const std::array<std::uint32_t, kMaxViews>& parted, std::uint32_t i) {
  ChunkViewers out;
  for (std::size_t v = 0; v < input.view_count; ++v) {
    if ((bits[v].kept >> i & 1) == 0) continue;
    const bool all = seen_whole(at.views[v], bits[v], parted[v]) >> i & 1;
    if (all) out.whole |= input.bits[v];
    if (!all) out.part |= static_cast<std::uint8_t>(1u << v);
  }
  return out;
}

// Whom nobody tells anything.
struct NoNotes {
  static void begin(const GroupEntry& /*entry*/, const EntryGroup& /*at*/, std::uint32_t /*chunks*/) {}
  static void expect(const EntryGroup& /*at*/, std::uint32_t /*i*/, const ChunkMap::ChunkView& /*chunk*/) {}
  static void note(const EntryGroup& /*at*/, std::uint32_t /*i*/, const ChunkMap::ChunkView& /*chunk*/,
                   const ChunkViews* /*parts*/, const ObjectId* /*place*/) {}
};

// Any views, any tests. Tells `notes` of each group's chunks that are left; then of each of them, once ahead
// and once it is written: who sees a part of it, or null where somebody sees all of it, and where its ids
// stand.
template <class Notes>
HWY_INLINE PassCounts cull_filtered(const PassInput& input, std::span<const GroupEntry> entries,
                                    ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks,
                                    Notes notes) {
  PassCounts counts;
  std::array<ChunkBits, kMaxViews> bits;
  std::array<std::uint32_t, kMaxViews> parted;
  ChunkViews parts;
  Chunks chunks;
  std::array<CrossedBits, kMaxViews> left;
  // What occlusion drops counts once for each of the caller's views that are the same.
  const auto count_occluded = [&](std::size_t v, std::uint64_t objects) {
    counts.occluded += static_cast<std::uint64_t>(std::popcount(input.bits[v])) * objects;
  };
  const std::uint32_t* hidden = input.hidden.empty() ? nullptr : input.hidden.data();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const GroupEntry& entry = entries[e];
    prefetch_group(input, entries, e);
    if (input.columns) prefetch_columns(input, entries, e);
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
    test_crossed_by_all(input, entry, at.views, bits, parted, masks != nullptr, chunks, left);
    notes.begin(entry, at, any);
    for (; any != 0; any &= any - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(any));
      const ChunkMap::ChunkView& chunk = chunks[i];
      if (const std::uint32_t later = any & (any - 1); later != 0) {
        const auto next = static_cast<std::uint32_t>(std::countr_zero(later));
        notes.expect(at, next, chunks[next]);
      }
      const ChunkViewers viewers = viewers_of(input, at, bits, parted, i);
      const std::size_t before = counts.written;
      if (viewers.part == 0 || (viewers.whole != 0 && masks == nullptr)) {
        counts.written += write_whole(chunk, viewers.whole, counts.written, ids, masks);
      } else {
        parts.count = 0;
        for (std::uint32_t rest = viewers.part; rest != 0; rest &= rest - 1) {
          const auto v = static_cast<std::size_t>(std::countr_zero(rest));
          const ObjectBits* by_planes = bits[v].crossing >> i & 1 ? &left[v][i] : nullptr;
          std::uint64_t occluded = 0;
          parts.bits[parts.count] = input.bits[v];
          parts.seen[parts.count++] =
              view_objects(input, at, at.views[v], chunk, by_planes, parted[v] >> i & 1, occluded);
          counts.tested += chunk.count;
          count_occluded(v, occluded);
        }
        counts.written += write_parts(chunk, viewers.whole, parts, counts.written, ids, masks);
      }
      notes.note(at, i, chunk, viewers.whole == 0 ? &parts : nullptr, ids + before);
    }
  }
  return counts;
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
