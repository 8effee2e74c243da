// Keys, chunks and objects; the k-d tree inside a key is in chunk_tree.cpp, groups and bounds in
// chunk_bounds.cpp.
#include "library/world/chunk_map.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "library/geometry/box_math.hpp"
#include "library/world/free_list.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

std::uint64_t next_number() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

constexpr Box kEverywhere{kEmptyBox.max, kEmptyBox.min};

// Half open, as the splits are.
bool holds_centre(const Box& cell, const Vec3& p) {
  return p.x >= cell.min.x && p.x < cell.max.x && p.y >= cell.min.y && p.y < cell.max.y &&
         p.z >= cell.min.z && p.z < cell.max.z;
}

std::uint32_t packed(RegionSet r) {
  return r.first_x | std::uint32_t{r.first_z} << 8 | std::uint32_t{r.last_x} << 16 |
         std::uint32_t{r.last_z} << 24;
}

}  // namespace

ChunkMap::ChunkMap(const ChunkMapOptions& options, Locations* shared_locations, const Columns* columns)
    : options_(options),
      number_(next_number()),
      locations_(shared_locations ? shared_locations : &own_locations_),
      columns_(columns) {
  options_.depth = std::min(options_.depth, kMaxDepth);
  const std::uint32_t side = 1u << options_.depth;
  last_region_ = side - 1;
  const float width = options_.ground.max.x - options_.ground.min.x;
  const float length = options_.ground.max.z - options_.ground.min.z;
  // A ground of no width is one column; what overflows is one, too.
  columns_per_metre_ = width > 0 && std::isfinite(width) ? static_cast<float>(side) / width : 0;
  rows_per_metre_ = length > 0 && std::isfinite(length) ? static_cast<float>(side) / length : 0;
  build_nodes();
}

void ChunkMap::build_nodes() {
  // Level by level; a node's children are neighbours in the next level's order of quads.
  nodes_.resize(1);
  std::size_t first = 0;
  for (std::uint32_t level = 0; level < options_.depth; ++level) {
    const std::size_t end = nodes_.size();
    for (std::size_t n = first; n < end; ++n) {
      nodes_[n].first_child = static_cast<std::uint32_t>(nodes_.size());
      Node child;
      child.parent = static_cast<std::uint32_t>(n);
      for (int i = 0; i < 4; ++i) nodes_.push_back(child);
    }
    first = end;
  }
  for (Node& node : nodes_) node.bounds = kEmptyBox;
  loose_.assign(nodes_.size(), 0);
}

RegionSet ChunkMap::regions(const Box& box) const noexcept {
  const auto index = [&](float at, float origin, float scale) {
    const float region = std::floor((at - origin) * scale);
    return static_cast<std::uint8_t>(std::clamp(region, 0.0f, static_cast<float>(last_region_)));
  };
  const Box& g = options_.ground;
  const auto x = [&](float at) {
    return columns_per_metre_ > 0 ? index(at, g.min.x, columns_per_metre_) : std::uint8_t{0};
  };
  const auto z = [&](float at) {
    return rows_per_metre_ > 0 ? index(at, g.min.z, rows_per_metre_) : std::uint8_t{0};
  };
  return {x(box.min.x), z(box.min.z), x(box.max.x), z(box.max.z)};
}

std::uint32_t ChunkMap::find_key(RegionSet regions) {
  const auto found = key_of_regions_.find(packed(regions));
  if (found != key_of_regions_.end()) return found->second;
  // The smallest region that holds all of them.
  std::uint32_t levels_up = 0;
  while ((regions.first_x >> levels_up) != (regions.last_x >> levels_up) ||
         (regions.first_z >> levels_up) != (regions.last_z >> levels_up)) {
    ++levels_up;
  }
  std::uint32_t node = 0;
  for (std::uint32_t level = options_.depth; level > levels_up; --level) {
    const std::uint32_t x = regions.first_x >> (level - 1) & 1, z = regions.first_z >> (level - 1) & 1;
    node = nodes_[node].first_child + 2 * z + x;
  }
  keys_.push_back({regions, node, kNone});
  const auto key = static_cast<std::uint32_t>(keys_.size() - 1);
  key_of_regions_.emplace(packed(regions), key);
  return key;
}

std::uint32_t ChunkMap::find_chunk(const Key& key, const Vec3& centre) const noexcept {
  std::uint32_t at = key.root;
  while (!is_chunk(at)) {
    const Split& split = splits_[at];
    at = split.child[coordinate(centre, split.axis) >= split.at];
  }
  return at & ~kChunkBit;
}

// --- memory ---

std::uint32_t ChunkMap::take_lanes(Pool& pool, std::uint32_t capacity) {
  std::vector<std::uint32_t>& free = pool.free[capacity / kLanes - 1];
  if (!free.empty()) {
    const std::uint32_t first = free.back();
    free.pop_back();
    return first;
  }
  return add_lanes(pool, capacity);
}

std::uint32_t ChunkMap::add_lanes(Pool& pool, std::uint32_t count) {
  const bool in_rows = kHasPages && pool.row > 0;
  const std::uint32_t first = pool.used;
  pool.used = in_rows ? lane_after(first, count / kCapacity) : first + count;
  // Who copies a chunk's ids may read as many as fit in any.
  pool.ids.resize(std::size_t{pool.used} + kCapacity);
  in_rows ? make_rows(pool, pool.used) : pool.lanes.resize(6 * std::size_t{pool.used});
  if (has_columns()) resize_columns(pool);
  return first;
}

// That of the least block that is free and holds so many objects; else the greatest.
std::uint32_t ChunkMap::free_capacity(const Pool& pool, std::uint32_t objects) noexcept {
  std::uint32_t capacity = std::max(2 * kSmallCapacity, (objects + kLanes - 1) / kLanes * kLanes);
  while (capacity < kCapacity && pool.free[capacity / kLanes - 1].empty()) capacity += kLanes;
  return capacity;
}

void ChunkMap::give_lanes(Pool& pool, std::uint32_t first, std::uint32_t capacity) {
  pool.free[capacity / kLanes - 1].push_back(first);
}

Box ChunkMap::box_at(const Chunk& c, std::uint32_t slot) const noexcept {
  const float* at = lanes(c, 0) + slot;
  const std::size_t step = this->step(c);
  return {{at[0], at[step], at[2 * step]}, {at[3 * step], at[4 * step], at[5 * step]}};
}

void ChunkMap::write(std::uint32_t chunk, std::uint32_t slot, ObjectId object, const Box& box) noexcept {
  const Chunk& c = chunks_[chunk];
  write_box(c, slot, box);
  ids(c)[slot] = object;
  if (has_columns()) load_columns(c, slot), note_stale(chunk);
  Location& at = (*locations_)[object];
  const std::uint32_t place = slot | (c.pool == kMovers ? Location::kMoves : 0);
  at.chunk = chunk, at.slot_and_history = (at.slot_and_history & ~0xffu) | place;
}

void ChunkMap::write_box(const Chunk& c, std::uint32_t slot, const Box& box) noexcept {
  ++changes_[c.pool];
  float* at = lanes(c, 0) + slot;
  const std::size_t step = this->step(c);
  at[0] = box.min.x, at[step] = box.min.y, at[2 * step] = box.min.z;
  at[3 * step] = box.max.x, at[4 * step] = box.max.y, at[5 * step] = box.max.z;
}

// A hole, or the next slot; there must be room.
std::uint32_t ChunkMap::take_slot(Chunk& c) noexcept {
  if (c.live++ == c.count) return c.count++;
  const ObjectId* const all = ids(c);
  return static_cast<std::uint32_t>(std::find(all, all + c.count, kNoObject) - all);
}

// With lanes of its own where none are given.
std::uint32_t ChunkMap::add_chunk(std::uint32_t key, std::uint32_t capacity, Box cell, std::uint8_t pool,
                                  std::uint32_t first_lane) {
  const std::uint32_t chunk = take_element(chunks_, free_chunks_);
  Chunk added;
  added.bounds = kEmptyBox, added.moved = {}, added.pool = pool;
  added.key = key, added.capacity = capacity, added.cell = cell;
  added.first_lane = first_lane == kNone ? take_lanes(pools_[pool], capacity) : first_lane;
  misplaced_ += pool == kStill;
  // Its number may still stand in these lists.
  const Chunk& old = chunks_[chunk];
  added.changed = old.changed, added.dirty = old.dirty, added.grown = old.grown, added.stale = old.stale;
  chunks_[chunk] = added;
  note_change(chunk);
  return chunk;
}

void ChunkMap::free_chunk(std::uint32_t chunk) {
  take_from_group(chunk);
  Chunk& c = chunks_[chunk];
  if (!kHasPages || !is_kept_page(c)) give_lanes(pools_[c.pool], c.first_lane, c.capacity);
  c.count = c.live = c.counted = 0;
  c.key = kNone;
  note_change(chunk);
  free_chunks_.push_back(chunk);
}

void ChunkMap::grow(std::uint32_t chunk) {
  Chunk& c = chunks_[chunk];
  Pool& pool = pools_[c.pool];
  const Chunk old = c;
  c.capacity = free_capacity(pool, old.capacity + 1), c.first_lane = take_lanes(pool, c.capacity);
  misplaced_ += c.pool == kStill;
  for (std::uint32_t side = 0; side < 6; ++side) std::copy_n(lanes(old, side), old.count, lanes(c, side));
  std::copy_n(ids(old), old.count, ids(c));
  if (has_columns()) load_columns(c);
  give_lanes(pool, old.first_lane, old.capacity);
}

void ChunkMap::note_change(std::uint32_t chunk) {
  note_shape(chunk);
  Chunk& c = chunks_[chunk];
  if (c.changed) return;
  c.changed = true;
  changed_.push_back(chunk);
}

void ChunkMap::acknowledge_changes() noexcept {
  for (const std::uint32_t chunk : changed_) chunks_[chunk].changed = false;
  changed_.clear();
}

// --- objects ---

void ChunkMap::append(std::uint32_t chunk, ObjectId object, const Box& box) {
  Chunk& c = chunks_[chunk];
  write(chunk, take_slot(c), object, box);
  if (c.group == kNone) {
    put_in_group(chunk, kNone, box);
  } else {
    add_objects(c.group, static_cast<std::int32_t>(c.live - c.counted));
    c.counted = c.live;
    extend(chunk, box);
  }
  note_change(chunk);
}

void ChunkMap::insert(ObjectId object, const Box& box) {
  if (locations_ == &own_locations_ && object >= own_locations_.size())
    own_locations_.resize(object + std::size_t{1});
  file(object, box);
  ++size_, ++inserted_;
}

// Puts an object that is already counted where it belongs.
void ChunkMap::file(ObjectId object, const Box& box) {
  leave_now();
  const std::uint32_t key = find_key(regions(box));
  const Vec3 centre = centre_of(box);
  if (keys_[key].root == kNone) {
    const std::uint32_t first = add_chunk(key, kSmallCapacity, kEverywhere);
    keys_[key].root = first | kChunkBit;
    append(first, object, box);
  } else {
    append(make_room(find_chunk(keys_[key], centre), centre), object, box);
  }
}

void ChunkMap::insert_all(const Boxes& boxes) {
  if (locations_ == &own_locations_) own_locations_.reserve(boxes.size());
  const std::size_t lanes = boxes.size() + boxes.size() / 2;
  pools_[kStill].ids.reserve(lanes);
  pools_[kStill].lanes.reserve(6 * lanes);
  for (std::size_t i = 0; i < boxes.size(); ++i) insert(static_cast<ObjectId>(i), boxes[i]);
}

// Fills the slot with the last object, and forgets holes behind that.
void ChunkMap::erase_slot(std::uint32_t chunk, std::uint32_t slot) noexcept {
  Chunk& c = chunks_[chunk];
  ObjectId* const all = ids(c);
  all[slot] = kNoObject;
  --c.live, ++changes_[c.pool];
  note_stale(chunk);
  const auto trim = [&] {
    while (c.count > 0 && all[c.count - 1] == kNoObject) --c.count;
  };
  trim();
  if (slot >= c.count) return;
  const std::uint32_t last = --c.count;
  write(chunk, slot, all[last], box_at(c, last));
  trim();
}

void ChunkMap::remove(ObjectId object) {
  leave_now();
  const Location at = (*locations_)[object];
  (*locations_)[object].chunk = kNone;
  --size_;
  Chunk& c = chunks_[at.chunk];
  if (c.pool == kMovers) {
    leave(at.chunk, at.slot());
    return flush();
  }
  const Box box = box_at(c, at.slot());
  erase_slot(at.chunk, at.slot());
  add_objects(c.group, static_cast<std::int32_t>(c.live) - static_cast<std::int32_t>(c.counted));
  c.counted = c.live;
  note_change(at.chunk);
  if (c.live == 0) return unlink(at.chunk);
  if (!c.grown) shrink(at.chunk, box);
  try_merge(at.chunk);
}

void ChunkMap::move(ObjectId object, const Box& box) {
  leave_now();
  const Location& at = (*locations_)[object];
  Chunk& c = chunks_[at.chunk];
  if (c.pool == kStill && keys_[c.key].regions == regions(box) && holds_centre(c.cell, centre_of(box))) {
    const Box old = box_at(c, at.slot());
    write(at.chunk, at.slot(), object, box);
    extend(at.chunk, box);
    if (!c.grown) shrink(at.chunk, old);
    note_change(at.chunk);
    return;
  }
  remove(object);
  insert(object, box);
}

bool ChunkMap::contains(ObjectId object) const noexcept {
  return object < locations_->size() && (*locations_)[object].chunk != kNone;
}

Box ChunkMap::box(ObjectId object) const noexcept {
  const Location& at = (*locations_)[object];
  return box_at(chunks_[at.chunk], at.slot());
}

}  // namespace sightline::world
