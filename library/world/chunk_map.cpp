// Keys, chunks and the k-d tree inside a key; groups and bounds are in chunk_bounds.cpp.
#include "library/world/chunk_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::world {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Box kEverywhere{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};

// A k-d reference is a split, or a chunk with the highest bit set.
constexpr std::uint32_t kChunkBit = 0x80000000u;
constexpr bool is_chunk(std::uint32_t reference) {
  return reference & kChunkBit;
}

Vec3 centre_of(const Box& b) {
  return {0.5f * b.min.x + 0.5f * b.max.x, 0.5f * b.min.y + 0.5f * b.max.y, 0.5f * b.min.z + 0.5f * b.max.z};
}

float axis_of(const Vec3& v, std::uint32_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
float& axis_of(Vec3& v, std::uint32_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Half open, as the splits are.
bool holds(const Box& cell, const Vec3& p) {
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
  for (Node& node : nodes_) node.bounds = {kEverywhere.max, kEverywhere.min};
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
    at = split.child[axis_of(centre, split.axis) >= split.at];
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
  std::uint32_t chunk;
  if (free_chunks_.empty()) {
    chunk = static_cast<std::uint32_t>(chunks_.size());
    chunks_.emplace_back();
  } else {
    chunk = free_chunks_.back();
    free_chunks_.pop_back();
    const bool changed = chunks_[chunk].changed;
    chunks_[chunk] = {};
    chunks_[chunk].changed = changed;
  }
  const std::uint32_t first = take_lanes(capacity);
  Chunk& c = chunks_[chunk];
  c.key = key, c.capacity = capacity, c.first_lane = first, c.cell = cell;
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

// --- the k-d tree of a key ---

void ChunkMap::replace_reference(std::uint32_t key, std::uint32_t parent, std::uint32_t from,
                                 std::uint32_t to) noexcept {
  if (parent == kNone) {
    keys_[key].root = to;
  } else {
    auto& child = splits_[parent].child;
    child[child[1] == from] = to;
  }
}

// Halves a full chunk at the median of its centres along their longest axis. False where all are one point.
bool ChunkMap::split(std::uint32_t chunk) {
  const std::uint32_t count = chunks_[chunk].count;
  std::array<Vec3, kCapacity> centres;
  Box spread{kEverywhere.max, kEverywhere.min};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 p = centres[i] = centre_of(box_at(chunks_[chunk], i));
    spread.min = {std::min(spread.min.x, p.x), std::min(spread.min.y, p.y), std::min(spread.min.z, p.z)};
    spread.max = {std::max(spread.max.x, p.x), std::max(spread.max.y, p.y), std::max(spread.max.z, p.z)};
  }
  std::uint32_t axis = 0;
  float longest = 0;
  for (std::uint32_t a = 0; a < 3; ++a) {
    const float length = axis_of(spread.max, a) - axis_of(spread.min, a);
    if (length > longest) longest = length, axis = a;
  }
  if (!(longest > 0)) return false;
  std::array<float, kCapacity> values{};
  for (std::uint32_t i = 0; i < count; ++i) values[i] = axis_of(centres[i], axis);
  std::nth_element(values.begin(), values.begin() + count / 2, values.begin() + count);
  float at = values[count / 2];
  const float lowest = axis_of(spread.min, axis);
  if (at == lowest) {  // nothing would be below: take the next value up
    at = axis_of(spread.max, axis);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (values[i] > lowest) at = std::min(at, values[i]);
    }
  }

  const std::uint32_t added = add_chunk(chunks_[chunk].key, kCapacity, chunks_[chunk].cell);
  Chunk &low = chunks_[chunk], &high = chunks_[added];
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const ObjectId object = ids_[low.first_lane + i];
    const Box box = box_at(low, i);
    if (axis_of(centres[i], axis) >= at) {
      write(added, high.count++, object, box);
    } else {
      if (kept != i) write(chunk, kept, object, box);
      ++kept;
    }
  }
  low.count = kept;
  axis_of(low.cell.max, axis) = at;
  axis_of(high.cell.min, axis) = at;

  std::uint32_t node;
  if (free_splits_.empty()) {
    node = static_cast<std::uint32_t>(splits_.size());
    splits_.emplace_back();
  } else {
    node = free_splits_.back();
    free_splits_.pop_back();
  }
  splits_[node] = {at, axis, low.parent, {chunk | kChunkBit, added | kChunkBit}};
  replace_reference(low.key, low.parent, chunk | kChunkBit, node);
  low.parent = high.parent = node;

  const std::uint32_t group = low.group;
  add_objects(group, -static_cast<std::int32_t>(high.count));
  set_bounds(chunk, tight(low));
  note_change(chunk);
  put_in_group(added, group, tight(high));
  return true;
}

// Gives `target` a chunk with room for the centre: `chunk`, one of its halves, or a new head of its chain.
void ChunkMap::make_room(std::uint32_t chunk, const Vec3& centre, std::uint32_t& target) {
  target = chunk;
  if (chunks_[chunk].count < chunks_[chunk].capacity) return;
  if (chunks_[chunk].capacity < kCapacity) return grow(chunk);
  if (chunks_[chunk].next == kNone && split(chunk)) {
    const Split& s = splits_[chunks_[chunk].parent];
    target = s.child[axis_of(centre, s.axis) >= s.at] & ~kChunkBit;
    return;
  }
  // All centres in one point: no plane parts them.
  target = add_chunk(chunks_[chunk].key, kCapacity, chunks_[chunk].cell);
  Chunk &head = chunks_[target], &old = chunks_[chunk];
  head.parent = old.parent;
  head.next = chunk;
  old.previous = target;
  replace_reference(head.key, head.parent, chunk | kChunkBit, target | kChunkBit);
}

// Takes an empty chunk out of its chain or tree, and frees it.
void ChunkMap::unlink(std::uint32_t chunk) {
  const Chunk c = chunks_[chunk];
  if (c.next != kNone) chunks_[c.next].previous = c.previous;
  if (c.previous != kNone) {
    chunks_[c.previous].next = c.next;
  } else if (c.next != kNone) {
    replace_reference(c.key, c.parent, chunk | kChunkBit, c.next | kChunkBit);
    chunks_[c.next].parent = c.parent;
  } else if (c.parent == kNone) {
    keys_[c.key].root = kNone;
  } else {
    // The sibling takes the place of the split. Its chunks' cells stay as they are: too small is only slower.
    const Split split = splits_[c.parent];
    const std::uint32_t sibling = split.child[split.child[0] == (chunk | kChunkBit)];
    replace_reference(c.key, split.parent, c.parent, sibling);
    if (is_chunk(sibling)) {
      chunks_[sibling & ~kChunkBit].parent = split.parent;
    } else {
      splits_[sibling].parent = split.parent;
    }
    free_splits_.push_back(c.parent);
  }
  free_chunk(chunk);
}

// Joins a chunk that has become small with its sibling, where both together stay half empty.
void ChunkMap::try_merge(std::uint32_t chunk) {
  const Chunk& c = chunks_[chunk];
  if (c.parent == kNone || c.next != kNone || c.previous != kNone || c.count > kCapacity / 4) return;
  const Split& split = splits_[c.parent];
  const std::uint32_t side = split.child[0] == (chunk | kChunkBit);
  if (!is_chunk(split.child[side])) return;
  const std::uint32_t sibling = split.child[side] & ~kChunkBit;
  Chunk& s = chunks_[sibling];
  if (s.next != kNone || s.count + c.count > kCapacity / 2 || s.count + c.count > s.capacity) return;
  const Box moved = chunk_bounds(chunk);
  for (std::uint32_t i = 0; i < c.count; ++i) write(sibling, s.count++, ids_[c.first_lane + i], box_at(c, i));
  const auto taken = static_cast<std::int32_t>(c.count);
  add_objects(c.group, -taken);
  add_objects(s.group, taken);
  extend(sibling, moved);
  axis_of(s.cell.min, split.axis) =
      std::min(axis_of(s.cell.min, split.axis), axis_of(c.cell.min, split.axis));
  axis_of(s.cell.max, split.axis) =
      std::max(axis_of(s.cell.max, split.axis), axis_of(c.cell.max, split.axis));
  note_change(sibling);
  chunks_[chunk].count = 0;
  unlink(chunk);
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
  std::uint32_t target;
  if (keys_[key].root == kNone) {
    target = add_chunk(key, kSmallCapacity, kEverywhere);
    keys_[key].root = target | kChunkBit;
  } else {
    make_room(find_chunk(keys_[key], centre), centre, target);
  }
  append(target, object, box);
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
  if (keys_[c.key].regions == regions(box) && holds(c.cell, centre_of(box))) {
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
