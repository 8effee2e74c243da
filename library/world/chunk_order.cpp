// Where chunks stand in memory: those that are read together, side by side.
#include <algorithm>
#include <span>
#include <utility>

#include "library/world/chunk_map.hpp"

namespace sightline::world {

// What was small may not grow by joining others; so what was not does not become small.
std::uint32_t ChunkMap::tight_capacity(const Chunk& c) noexcept {
  if (c.capacity == kSmallCapacity) return kSmallCapacity;
  return std::max(2 * kSmallCapacity, (c.count + kLanes - 1) / kLanes * kLanes);
}

void ChunkMap::arrange(bool tightly) {
  constexpr std::size_t kFewestWorthIt = 64;  // chunks: fewer lie in a few pages anyway
  if (misplaced_ < kFewestWorthIt) return;
  if (!tightly && 2 * misplaced_ < chunks_.size() - free_chunks_.size()) return;
  misplaced_ = 0;
  ++changes_[kStill];
  Pool old = std::exchange(pools_[kStill], {});
  Pool& pool = pools_[kStill];
  const auto room_of = [&](const Chunk& c) { return tightly ? tight_capacity(c) : c.capacity; };
  std::size_t room = kCapacity;
  for (const Chunk& c : chunks_) room += c.pool == kStill && c.key != kNone ? room_of(c) : 0;
  pool.lanes.reserve(6 * room), pool.ids.reserve(room);
  for (const Node& node : nodes_) {
    for (const std::uint32_t group : node.groups) {
      if (groups_[group].pool != kStill) continue;
      for (const std::uint32_t chunk : std::span(groups_[group].chunks).first(groups_[group].count)) {
        Chunk& c = chunks_[chunk];
        const Chunk from = c;
        c.capacity = room_of(c), c.first_lane = take_lanes(pool, c.capacity);
        for (std::uint32_t side = 0; side < 6; ++side)
          std::copy_n(&old.lanes[6 * std::size_t{from.first_lane} + side * from.capacity], c.count,
                      lanes(c, side));
        std::copy_n(&old.ids[from.first_lane], c.count, ids(c));
        note_shape(chunk);
      }
    }
  }
  if (!has_columns()) return;
  for (const Chunk& c : chunks_)
    if (c.pool == kStill) load_columns(c);
}

}  // namespace sightline::world
