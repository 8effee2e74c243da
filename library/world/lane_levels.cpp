// Objects' sizes on an image and their levels, in SIMD, and the passes that ask for them.
#include "library/world/lane_levels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/lane_levels.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/geometry/ask_ahead.hpp"
#include "library/world/filtered_cull-inl.hpp"
#include "library/world/world_state.hpp"

#ifndef SIGHTLINE_WORLD_RENEW_LANES
#define SIGHTLINE_WORLD_RENEW_LANES
namespace sightline::world {

namespace {

// Of distances and coordinates, what single precision may lose of how far an object's level is from
// changing: some six roundings, at an eye here and at one there.
constexpr float kRounding = 4e-6f;

// Whether the objects that the last cull had in view have the levels and fades that they had then.
bool may_stay(const LaneChoice& choice, const LaneState& state, bool unchanged) noexcept {
  const bool known = state.cull != 0 && (state.cull == choice.last || state.cull == choice.cull);
  return unchanged && known && state.epoch == choice.epoch && choice.travelled < state.still_until;
}

// Puts the chunk's objects into those lanes of the block that hold others, speak of older tables or may not
// know where an object was seen. `held` are the lanes whose objects were seen before; returns those that are
// so now.
std::uint32_t renew_lanes(const LaneChoice& choice, const ObjectId* objects, std::uint32_t lanes,
                          std::uint32_t held, const LaneBlock& block) noexcept {
  const auto& tables = choice.levels->table_of;
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const ObjectId id = objects[std::countr_zero(rest)];
    if (id < tables.size()) geometry::ask_ahead(&tables[id]);
  }
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    const ObjectId id = objects[lane];
    if (block.limits.ids[lane] != id)
      block.limits.ids[lane] = id, block.state.level[lane] = 0, held &= ~(1u << lane);
    const bool may_have_moved = (held >> lane & 1) == 0 && id < choice.moved.size();
    if (may_have_moved && choice.moved[id].cull == choice.last)
      block.state.level[lane] = choice.moved[id].level, held |= 1u << lane;
    block.set_level(lane, choice.levels->table(id), block.state.level[lane]);
  }
  if (block.state.edition == choice.edition) return held;
  for (std::uint32_t lane = 0; lane < kLaneBlock; ++lane)
    if ((lanes >> lane & 1) == 0) block.limits.ids[lane] = kNoObject;
  block.state.edition = choice.edition;
  return held;
}

// Objects that were seen keep their level until the size is well beyond its limits. Without branches, which
// nobody could predict.
void change_level(const LaneChoice& choice, std::uint32_t lane, float size, bool held,
                  const LaneBlock& block) noexcept {
  const LevelTable& table = choice.levels->table(block.limits.ids[lane]);
  const float finer = held ? choice.finer : 1, coarser = held ? choice.coarser : 1;
  std::uint32_t least = 0, most = 0;
  for (const float limit : table.sizes) least += size < limit * coarser, most += size < limit * finer;
  block.set_level(lane, table, std::max(std::min<std::uint32_t>(block.state.level[lane], most), least));
}

}  // namespace

}  // namespace sightline::world
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

// Of a vector of objects their distances from the eye, and their radii times the pixels that a metre has one
// metre away; both squared.
struct Seen {
  VF distance, reach;
};

HWY_INLINE Seen look_at(const ChunkMap::ChunkView& chunk, const Vec3& eye, const LevelScale& scale,
                        std::size_t i) {
  const F f;
  const auto [radius, distance] = spheres_of(chunk, eye, i);
  // Around the eye nothing is too small.
  const VF infinite = hn::Set(f, std::numeric_limits<float>::infinity());
  const VF reach = hn::Mul(hn::Set(f, scale.squared), radius);
  if (scale.orthographic) return {hn::Set(f, 1.0f), reach};
  return {distance, hn::IfThenElse(hn::Le(distance, radius), infinite, reach)};
}

// In pixels.
HWY_INLINE VF sizes_of(const Seen& seen) {
  return hn::Sqrt(hn::Div(seen.reach, seen.distance));
}

void sizes_of_chunk(const ChunkMap::ChunkView& chunk, const Vec3& eye, const LevelScale& scale,
                    float* HWY_RESTRICT sizes) {
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(F()))
    hn::Store(sizes_of(look_at(chunk, eye, scale, i)), F(), sizes + i);
}

// What fade_at() gives, of levels that end at `end`.
HWY_INLINE hn::Vec<U> fades_at(VF size, VF end, float fade) {
  const F f;
  const VF band = hn::Mul(end, hn::Set(f, fade));
  const VF share = hn::Div(hn::Sub(hn::Add(end, band), size), band);
  const VF within = hn::Max(hn::Min(share, hn::Set(f, 1.0f)), hn::Zero(f));
  const VF there = hn::IfThenElseZero(hn::Gt(band, hn::Zero(f)), within);
  return hn::BitCast(U(), hn::ConvertTo(hn::RebindToSigned<F>(), hn::Mul(hn::Set(f, 255.0f), there)));
}

// The lanes of `seen` that hold other objects than the chunk does.
HWY_INLINE std::uint32_t other_lanes(const ObjectId* objects, const LaneLimits& limits, std::uint32_t seen) {
  const U u;
  std::uint32_t other = 0;
  for (std::size_t i = 0; i < kLaneBlock; i += hn::Lanes(u))
    other |= bits_of(u, hn::Ne(hn::Load(u, objects + i), hn::Load(u, limits.ids.data() + i))) << i;
  return other & seen;
}

// Gives the objects of the vector at lane i of a block the levels of their sizes.
HWY_INLINE void change_levels(const LaneChoice& choice, VF sizes, std::uint32_t seen, std::uint32_t held,
                              std::size_t i, const LaneBlock& block) {
  const F f;
  const auto were_seen = mask_of(f, held);
  const auto limit = [&](const std::array<float, kLaneBlock>& of, float factor) HWY_ATTR {
    return hn::Mul(hn::Load(f, of.data() + i),
                   hn::IfThenElse(were_seen, hn::Set(f, factor), hn::Set(f, 1.0f)));
  };
  const auto stays = hn::And(hn::Ge(sizes, limit(block.limits.lower, choice.coarser)),
                             hn::Lt(sizes, limit(block.limits.upper, choice.finer)));
  const std::uint32_t changes = seen & ~bits_of(f, stays);
  if (changes == 0) return;
  alignas(64) std::array<float, kLaneBlock> size;
  hn::Store(sizes, f, size.data());
  for (std::uint32_t rest = changes; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(rest));
    change_level(choice, static_cast<std::uint32_t>(i) + k, size[k], held >> k & 1, block);
  }
}

// How far the eye may go, in metres, until one of a vector's objects has another level or fade, were it held.
HWY_INLINE VF slack_of(const LaneChoice& choice, const Seen& seen, VF sizes, std::size_t i, float margin,
                       const LaneLimits& limits) {
  const F f;
  const VF infinite = hn::Set(f, std::numeric_limits<float>::infinity());
  if (choice.scale.orthographic) return infinite;
  const VF end = hn::Mul(hn::Load(f, limits.lower.data() + i), hn::Set(f, choice.finer));
  VF low = hn::Mul(hn::Load(f, limits.lower.data() + i), hn::Set(f, choice.coarser));
  VF high = hn::Mul(hn::Load(f, limits.upper.data() + i), hn::Set(f, choice.finer));
  if (choice.scale.fade > 0) {
    const VF begin = hn::Mul(end, hn::Set(f, 1 + choice.scale.fade));
    low = hn::IfThenElse(hn::Gt(sizes, end), hn::Max(low, begin), low);
    high = hn::IfThenElse(hn::Lt(sizes, begin), hn::Min(high, end), high);
  }
  // Once its sphere holds the eye, an object is infinitely large, however large it was before.
  high = hn::Min(high, hn::Set(f, std::sqrt(choice.scale.squared)));
  // An object of size s at the distance d has the size l at d·s / l.
  const VF distance = hn::Sqrt(seen.distance), reach = hn::Sqrt(seen.reach);
  const VF slack = hn::Min(hn::Sub(hn::Div(reach, low), distance), hn::Sub(distance, hn::Div(reach, high)));
  const VF sure = hn::NegMulAdd(hn::Set(f, kRounding), distance, hn::Sub(slack, hn::Set(f, margin)));
  return hn::IfThenElse(hn::Lt(sizes, infinite), sure, hn::Zero(f));
}

// Chooses for the objects `now` in view of the block at `first` of a chunk. `held` were so before; `again`:
// for others of the block this cull has chosen already.
HWY_INLINE void choose_block(const LaneChoice& choice, const ChunkMap::ChunkView& chunk, const Vec3& eye,
                             std::size_t first, std::uint32_t now, std::uint32_t held, bool again,
                             const LaneBlock& block) {
  const F f;
  const std::uint32_t all = (1u << hn::Lanes(f)) - 1;
  const float margin =
      kRounding * (kHalfSectorSide + std::max({std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)}));
  const VF infinite = hn::Set(f, std::numeric_limits<float>::infinity());
  VF slack = infinite;
  for (std::size_t i = 0; i < kLaneBlock; i += hn::Lanes(f)) {
    const std::uint32_t here = now >> i & all;
    if (here == 0) continue;
    const Seen seen = look_at(chunk, eye, choice.scale, first + i);
    const VF sizes = sizes_of(seen);
    change_levels(choice, sizes, here, held >> i, i, block);
    slack = hn::Min(slack, hn::IfThenElse(mask_of(f, here),
                                          slack_of(choice, seen, sizes, i, margin, block.limits), infinite));
    if (!(choice.scale.fade > 0)) continue;
    const VF end = hn::Mul(hn::Load(f, block.limits.lower.data() + i), hn::Set(f, choice.finer));
    store_masks(fades_at(sizes, end, choice.scale.fade), block.state.fade.data() + i);
  }
  const double until = choice.travelled + static_cast<double>(hn::GetLane(hn::MinOfLanes(f, slack)));
  block.state.still_until = again ? std::min(block.state.still_until, until) : until;
}

// Writes what a block says of the objects `now` in view.
HWY_INLINE std::uint16_t* write_block(const LaneState& state, bool faded, std::uint32_t now,
                                      std::uint16_t* HWY_RESTRICT out) {
  const U u;
  const hn::Rebind<std::uint8_t, U> bytes;
  const hn::Rebind<std::uint16_t, U> pairs;
  const std::uint32_t all = (1u << hn::Lanes(u)) - 1;
  for (std::size_t i = 0; i < kLaneBlock; i += hn::Lanes(u)) {
    const std::uint32_t here = now >> i & all;
    auto chosen = hn::PromoteTo(u, hn::LoadU(bytes, state.level.data() + i));
    if (faded)
      chosen = hn::Or(chosen, hn::ShiftLeft<8>(hn::PromoteTo(u, hn::LoadU(bytes, state.fade.data() + i))));
    const auto kept = hn::BitCast(hn::RebindToSigned<U>(), packed(u, chosen, here));
    hn::StoreU(hn::DemoteTo(pairs, kept), pairs, out);
    out += std::popcount(here);
  }
  return out;
}

void levels_of_chunk(const LaneChoice& choice, const NotedChunk& noted, const Vec3& eye,
                     std::uint16_t* HWY_RESTRICT out) {
  const ChunkMap::ChunkView& chunk = noted.chunk;
  for (std::size_t first = 0; first < chunk.count; first += kLaneBlock) {
    const std::uint32_t now = noted.seen.words[first / 64] >> first % 64 & 0xffff;
    if (now == 0) continue;
    const LaneBlocks here = noted.blocks.from(first);
    const LaneBlock block{*here.states, *here.limits};
    LaneState& state = block.state;
    // A cull has passes of its own for what automatic occlusion leaves: their objects were chosen for by the
    // first.
    const bool again = state.cull == choice.cull;
    if (!may_stay(choice, state, here.unchanged) || (now & ~std::uint32_t{state.seen}) != 0) {
      std::uint32_t held = again || (state.cull != 0 && state.cull == choice.last) ? state.seen : 0;
      std::uint32_t other =
          state.edition == choice.edition ? other_lanes(chunk.objects + first, block.limits, now) : now;
      if (!choice.moved.empty() || choice.tables_changed) other |= now & ~held;
      if (other != 0) held = renew_lanes(choice, chunk.objects + first, other, held, block);
      choose_block(choice, chunk, eye, first, now, held, again, block);
      state.epoch = choice.epoch;
    }
    out = write_block(state, choice.scale.fade > 0, now, out);
    state.seen = static_cast<std::uint16_t>((again ? state.seen : 0) | now);
    state.cull = choice.cull;
  }
}

// All objects of a chunk; bits from its count on are 0.
HWY_INLINE ObjectBits all_objects(const ChunkMap::ChunkView& chunk) {
  ObjectBits out;
  const std::uint64_t all = ~std::uint64_t{0};
  out.words = {chunk.count < 64 ? ~(all << chunk.count) : all,
               chunk.count > 64 ? ~(all << (chunk.count - 64)) : 0};
  if (!chunk.loose) return out;
  const U u;
  ObjectBits objects;
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(u))
    objects.words[i / 64] |= std::uint64_t{bits_of(u, are_objects(hn::Load(u, chunk.objects + i)))} << i % 64;
  out.keep(objects);
  return out;
}

// Tells of what a pass writes, and of it asks ahead.
struct TellingNotes {
  LevelNotes& notes;
  LaneBlocks pool{};  // of the group's chunks

  HWY_INLINE void begin(const GroupEntry& entry, const EntryGroup& at, std::uint32_t chunks) {
    pool = notes.blocks_of(entry.sector, at.group.pool);
    for (std::uint32_t rest = pool.states ? chunks : 0; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const LaneState* const states = pool.from(at.group.first_lane[i]).states;
      const auto* const bytes = reinterpret_cast<const std::uint8_t*>(states);
      constexpr std::size_t kLine = 64, kMost = ChunkMap::kCapacity / kLaneBlock * sizeof(LaneState);
      for (std::size_t b = 0; b < kMost; b += kLine) hwy::Prefetch(bytes + b);
    }
  }
  HWY_INLINE void expect(const EntryGroup& at, std::uint32_t i, const ChunkMap::ChunkView& chunk) {
    notes.expect(chunk, blocks(at, i));
  }
  HWY_INLINE void note(const EntryGroup& at, std::uint32_t i, const ChunkMap::ChunkView& chunk,
                       const ChunkViews* parts, const ObjectId* place) {
    ObjectBits seen = parts ? ObjectBits{} : all_objects(chunk);
    for (std::size_t k = 0; parts && k < parts->count; ++k) seen.add(parts->seen[k]);
    notes.note({chunk, at.views, blocks(at, i), seen, place});
  }
  HWY_INLINE LaneBlocks blocks(const EntryGroup& at, std::uint32_t i) const {
    return pool.states ? pool.from(at.group.first_lane[i]) : LaneBlocks{};
  }
};

PassCounts views_with_levels(const PassInput& input, std::span<const GroupEntry> entries,
                             ObjectId* HWY_RESTRICT ids, std::uint8_t* HWY_RESTRICT masks,
                             LevelNotes& notes) {
  TellingNotes telling{notes};
  return cull_filtered(input, entries, ids, masks, telling);
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {

void LaneBlock::set_level(std::size_t lane, const LevelTable& table, std::uint32_t level) const noexcept {
  state.level[lane] = static_cast<std::uint8_t>(level);
  limits.lower[lane] = table.sizes[level];
  limits.upper[lane] = level > 0 ? table.sizes[level - 1] : std::numeric_limits<float>::infinity();
}

void renew_table(const LaneBlock& block, std::size_t lane, ObjectId object,
                 const LevelTable& table) noexcept {
  if (block.limits.ids[lane] != object) return;
  block.set_level(lane, table, block.state.level[lane]);
  block.state.epoch = 0;
}

HWY_EXPORT(sizes_of_chunk);
HWY_EXPORT(levels_of_chunk);
HWY_EXPORT(views_with_levels);

void find_sizes(const ChunkMap::ChunkView& chunk, const Vec3& eye, const LevelScale& scale,
                float* sizes) noexcept {
  HWY_DYNAMIC_DISPATCH(sizes_of_chunk)(chunk, eye, scale, sizes);
}

void expect_levels(const LaneChoice& choice, const ChunkMap::ChunkView& chunk,
                   const LaneBlocks& blocks) noexcept {
  for (std::size_t first = 0; first < chunk.count; first += kLaneBlock) {
    const LaneBlocks here = blocks.from(first);
    if (may_stay(choice, *here.states, here.unchanged)) continue;
    expect_sizes(chunk, first);
    for (const void* const line :
         {static_cast<const void*>(&here.limits->ids), static_cast<const void*>(&here.limits->lower),
          static_cast<const void*>(&here.limits->upper)})
      geometry::ask_ahead(line);
  }
}

void choose_levels(const LaneChoice& choice, const NotedChunk& noted, const Vec3& eye,
                   std::uint16_t* out) noexcept {
  HWY_DYNAMIC_DISPATCH(levels_of_chunk)(choice, noted, eye, out);
}

// Rows are too short for processors to find them out by themselves.
void expect_sizes(const ChunkMap::ChunkView& chunk, std::size_t first) noexcept {
  for (std::size_t side = 0; side < 6; ++side) geometry::ask_ahead(chunk.side(side) + first);
}

PassCounts cull_noted(LevelNotes& notes, const PassInput& input, std::span<const GroupEntry> entries,
                      ObjectId* ids, std::uint8_t* masks) noexcept {
  return HWY_DYNAMIC_DISPATCH(views_with_levels)(input, entries, ids, masks, notes);
}

}  // namespace sightline::world
#endif
