// Where chunks stand in memory: those that are read together, side by side.
#include "library/world/chunk_map.hpp"

namespace sightline::world {

void ChunkMap::arrange() {
  constexpr std::size_t kFewestWorthIt = 64;  // chunks: fewer lie in a few pages anyway
  if (misplaced_ < kFewestWorthIt || 2 * misplaced_ < chunks_.size() - free_chunks_.size()) return;
  misplaced_ = 0;
  ++changes_[kStill];
  Pool& pool = pools_[kStill];
  geometry::LargeVector<float> lanes;
  geometry::LargeVector<ObjectId> ids;
  lanes.reserve(pool.lanes.size()), ids.reserve(pool.ids.size());
  for (const Node& node : nodes_) {
    for (const std::uint32_t group : node.groups) {
      Group& b = groups_[group];
      if (b.pool != kStill) continue;
      for (std::uint32_t i = 0; i < b.count; ++i) {
        Chunk& c = chunks_[b.chunks[i]];
        const std::ptrdiff_t from = c.first_lane, to = from + static_cast<std::ptrdiff_t>(c.capacity);
        c.first_lane = b.first_lane[i] = static_cast<std::uint32_t>(ids.size());
        lanes.insert(lanes.end(), pool.lanes.begin() + 6 * from, pool.lanes.begin() + 6 * to);
        ids.insert(ids.end(), pool.ids.begin() + from, pool.ids.begin() + to);
      }
    }
  }
  pool.lanes = std::move(lanes), pool.ids = std::move(ids);
  pool.free_small.clear(), pool.free_large.clear();
  if (!has_columns()) return;
  resize_columns(pool);
  for (const Chunk& c : chunks_)
    if (c.pool == kStill) load_columns(c);
}

}  // namespace sightline::world
