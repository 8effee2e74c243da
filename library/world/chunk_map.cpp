// Keys, chunks and objects; the k-d tree inside a key is in chunk_tree.cpp, groups and bounds in
// chunk_bounds.cpp.
#include "library/world/chunk_map.hpp"

#include <algorithm>
#include <cmath>

#include "library/geometry/box_math.hpp"
#include "library/world/free_list.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

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

ChunkMap::ChunkMap(const ChunkMapOptions& options, Locations* shared_locations)
    : options_(options), locations_(shared_locations ? shared_locations : &own_locations_) {
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

std::uint32_t ChunkMap::take_lanes(std::uint32_t capacity) {
  ++misplaced_;
  std::vector<std::uint32_t>& free = capacity == kCapacity ? free_large_ : free_small_;
  if (!free.empty()) {
    const std::uint32_t first = free.back();
    free.pop_back();
    return first;
  }
  const auto first = static_cast<std::uint32_t>(ids_.size());
  ids_.resize(ids_.size() + capacity);
  lanes_.resize(lanes_.size() + 6 * std::size_t{capacity});
  return first;
}

void ChunkMap::give_lanes(std::uint32_t first, std::uint32_t capacity) {
  (capacity == kCapacity ? free_large_ : free_small_).push_back(first);
}

Box ChunkMap::box_at(const Chunk& c, std::uint32_t slot) const noexcept {
  const float* at = lanes(c, 0) + slot;
  const std::size_t step = c.capacity;
  return {{at[0], at[step], at[2 * step]}, {at[3 * step], at[4 * step], at[5 * step]}};
}

void ChunkMap::write(std::uint32_t chunk, std::uint32_t slot, ObjectId object, const Box& box) noexcept {
  Chunk& c = chunks_[chunk];
  float* at = lanes(c, 0) + slot;
  const std::size_t step = c.capacity;
  at[0] = box.min.x, at[step] = box.min.y, at[2 * step] = box.min.z;
  at[3 * step] = box.max.x, at[4 * step] = box.max.y, at[5 * step] = box.max.z;
  ids_[c.first_lane + slot] = object;
  (*locations_)[object] = {chunk, slot};
}

std::uint32_t ChunkMap::add_chunk(std::uint32_t key, std::uint32_t capacity, Box cell) {
  const std::uint32_t chunk = take_element(chunks_, free_chunks_);
  Chunk added;
  added.key = key, added.capacity = capacity, added.first_lane = take_lanes(capacity), added.cell = cell;
  added.changed = chunks_[chunk].changed;  // its number may still stand among the changed
  chunks_[chunk] = added;
  note_change(chunk);
  return chunk;
}

void ChunkMap::free_chunk(std::uint32_t chunk) {
  take_from_group(chunk);
  Chunk& c = chunks_[chunk];
  give_lanes(c.first_lane, c.capacity);
  c.count = 0;
  c.key = kNone;
  note_change(chunk);
  free_chunks_.push_back(chunk);
}

void ChunkMap::grow(std::uint32_t chunk) {
  const std::uint32_t first = take_lanes(kCapacity);
  Chunk& c = chunks_[chunk];
  const Chunk old = c;
  c.first_lane = first, c.capacity = kCapacity;
  for (std::uint32_t side = 0; side < 6; ++side) std::copy_n(lanes(old, side), old.count, lanes(c, side));
  std::copy_n(ids_.data() + old.first_lane, old.count, ids_.data() + first);
  give_lanes(old.first_lane, old.capacity);
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
  const std::uint32_t slot = chunks_[chunk].count++;
  write(chunk, slot, object, box);
  if (chunks_[chunk].group == kNone) {
    put_in_group(chunk, kNone, box);
  } else {
    add_objects(chunks_[chunk].group, 1);
    extend(chunk, box);
  }
  note_change(chunk);
}

void ChunkMap::insert(ObjectId object, const Box& box) {
  if (locations_ == &own_locations_ && object >= own_locations_.size())
    own_locations_.resize(object + std::size_t{1});
  const std::uint32_t key = find_key(regions(box));
  const Vec3 centre = centre_of(box);
  if (keys_[key].root == kNone) {
    const std::uint32_t first = add_chunk(key, kSmallCapacity, kEverywhere);
    keys_[key].root = first | kChunkBit;
    append(first, object, box);
  } else {
    append(make_room(find_chunk(keys_[key], centre), centre), object, box);
  }
  ++size_;
}

void ChunkMap::insert_all(const Boxes& boxes) {
  if (locations_ == &own_locations_) own_locations_.reserve(boxes.size());
  const std::size_t lanes = boxes.size() + boxes.size() / 2;
  ids_.reserve(lanes);
  lanes_.reserve(6 * lanes);
  for (std::size_t i = 0; i < boxes.size(); ++i) insert(static_cast<ObjectId>(i), boxes[i]);
}

void ChunkMap::erase_slot(std::uint32_t chunk, std::uint32_t slot) noexcept {
  Chunk& c = chunks_[chunk];
  const std::uint32_t last = --c.count;
  if (slot != last) write(chunk, slot, ids_[c.first_lane + last], box_at(c, last));
}

void ChunkMap::remove(ObjectId object) {
  const Location at = (*locations_)[object];
  const Box box = box_at(chunks_[at.chunk], at.slot);
  erase_slot(at.chunk, at.slot);
  (*locations_)[object] = {};
  --size_;
  add_objects(chunks_[at.chunk].group, -1);
  note_change(at.chunk);
  if (chunks_[at.chunk].count == 0) return unlink(at.chunk);
  shrink(at.chunk, box);
  try_merge(at.chunk);
}

void ChunkMap::move(ObjectId object, const Box& box) {
  const Location at = (*locations_)[object];
  Chunk& c = chunks_[at.chunk];
  if (keys_[c.key].regions == regions(box) && holds_centre(c.cell, centre_of(box))) {
    const Box old = box_at(c, at.slot);
    write(at.chunk, at.slot, object, box);
    extend(at.chunk, box);
    shrink(at.chunk, old);
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
  const Location at = (*locations_)[object];
  return box_at(chunks_[at.chunk], at.slot);
}

}  // namespace sightline::world
