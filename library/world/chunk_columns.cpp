// Columns beside the boxes, in the same order, so that a cull reads them in rows; and of each chunk what all
// of its objects have in common.
#include <algorithm>

#include "library/geometry/mutant.h"
#include "library/world/chunk_map.hpp"

namespace sightline::world {

static_assert(ChunkMap::kGroupCapacity == 32);

void ChunkMap::resize_columns(Pool& pool) const {
  if (columns_->has_layers) pool.layers.resize(pool.ids.size());
  if (columns_->has_distances) pool.distances.resize(2 * pool.ids.size());
}

void ChunkMap::load_columns(const Chunk& c, std::uint32_t slot) noexcept {
  Pool& pool = pools_[c.pool];
  const ObjectId object = pool.ids[c.first_lane + slot];
  if (object == kNoObject) return;
  if (columns_->has_layers) pool.layers[c.first_lane + slot] = columns_->layers[object];
  if (!columns_->has_distances) return;
  float* at = &pool.distances[2 * std::size_t{c.first_lane} + slot];
  at[0] = columns_->distances[object].min, at[c.capacity] = columns_->distances[object].max;
}

void ChunkMap::load_columns(const Chunk& c) noexcept {
  for (std::uint32_t slot = 0; slot < c.count; ++slot) load_columns(c, slot);
}

void ChunkMap::note_stale(std::uint32_t chunk) {
  if (!has_columns() || chunks_[chunk].stale) return;
  chunks_[chunk].stale = true;
  stale_.push_back(chunk);
}

void ChunkMap::begin_column() {
  for (Pool& pool : pools_) resize_columns(pool);
  for (std::uint32_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    load_columns(chunks_[chunk]);
    note_stale(chunk);
  }
}

void ChunkMap::note_columns(ObjectId object) {
  const Location& at = (*locations_)[object];
  load_columns(chunks_[at.chunk], at.slot());
  if (!SIGHTLINE_MUTANT(stale_columns)) note_stale(at.chunk);
}

void ChunkMap::settle_columns() noexcept {
  if (!has_columns()) return;
  if (columns_->has_layers) layer_rows_.resize(LayerRows::kSize * groups_.size());
  if (columns_->has_distances) distance_rows_.resize(DistanceRows::kSize * groups_.size());
  for (const std::uint32_t chunk : stale_) {
    Chunk& c = chunks_[chunk];
    c.stale = false;
    if (c.group == kNone) continue;
    const ChunkColumns all = columns_of(c);
    if (columns_->has_layers) {
      std::uint32_t* const row = &layer_rows_[LayerRows::kSize * c.group + c.index_in_group];
      row[LayerRows::kSome] = all.some, row[LayerRows::kEvery] = all.every;
    }
    if (!columns_->has_distances) continue;
    float* const row = &distance_rows_[DistanceRows::kSize * c.group + c.index_in_group];
    row[DistanceRows::kFirstMin] = all.first_min, row[DistanceRows::kLastMin] = all.last_min;
    row[DistanceRows::kFirstMax] = all.first_max, row[DistanceRows::kLastMax] = all.last_max;
  }
  stale_.clear();
}

ChunkMap::ChunkColumns ChunkMap::columns_of(const Chunk& c) const noexcept {
  ChunkColumns all;
  const Pool& pool = pools_[c.pool];
  const std::size_t first = c.first_lane;
  for (std::size_t slot = 0; slot < c.count; ++slot) {
    if (pool.ids[first + slot] == kNoObject) continue;
    if (columns_->has_layers) all.some |= pool.layers[first + slot], all.every &= pool.layers[first + slot];
    if (!columns_->has_distances) continue;
    const float *at = &pool.distances[2 * first + slot], min = at[0], max = at[c.capacity];
    all.first_min = std::min(all.first_min, min), all.last_min = std::max(all.last_min, min);
    all.first_max = std::min(all.first_max, max), all.last_max = std::max(all.last_max, max);
  }
  return all;
}

}  // namespace sightline::world
