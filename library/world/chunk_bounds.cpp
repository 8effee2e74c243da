// Bounds above the chunks: groups and the quadtree's nodes, and what others read of a chunk.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "library/geometry/box_math.hpp"
#include "library/geometry/mutant.h"
#include "library/world/chunk_map.hpp"
#include "library/world/chunk_runs.hpp"
#include "library/world/free_list.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

// Whether taking `inner` away can make `outer` smaller.
bool touches(const Box& outer, const Box& inner) {
  return outer.min.x >= inner.min.x || outer.min.y >= inner.min.y || outer.min.z >= inner.min.z ||
         outer.max.x <= inner.max.x || outer.max.y <= inner.max.y || outer.max.z <= inner.max.z;
}

// Eight partial results, so that the compiler can keep them in a register.
template <class Better>
float reduce(const float* values, std::uint32_t count, Better better) {
  constexpr std::uint32_t kParts = 8;
  if (count < kParts) {
    float best = values[0];
    for (std::uint32_t i = 1; i < count; ++i) best = better(values[i], best) ? values[i] : best;
    return best;
  }
  std::array<float, kParts> part;
  std::copy_n(values, kParts, part.begin());
  const auto fold = [&](const float* from) {
    for (std::uint32_t j = 0; j < kParts; ++j) part[j] = better(from[j], part[j]) ? from[j] : part[j];
  };
  std::uint32_t i = kParts;
  for (; i + kParts <= count; i += kParts) fold(values + i);
  fold(values + count - kParts);  // some twice, which does not matter
  float best = part[0];
  for (std::uint32_t j = 1; j < kParts; ++j) best = better(part[j], best) ? part[j] : best;
  return best;
}

template <class Side>
Box bounds_of(const Side& side, std::uint32_t count) {
  const auto less = [](float a, float b) { return a < b; };
  const auto greater = [](float a, float b) { return a > b; };
  return {
      {reduce(side(0), count, less), reduce(side(1), count, less), reduce(side(2), count, less)},
      {reduce(side(3), count, greater), reduce(side(4), count, greater), reduce(side(5), count, greater)}};
}

}  // namespace

Box bounds_of_rows(const float* first, std::size_t step, std::uint32_t count) noexcept {
  return world::bounds_of([&](std::uint32_t side) { return first + side * step; }, count);
}

Box ChunkMap::tight(const Chunk& c) const noexcept {
  if (c.live == c.count) return bounds_of_rows(lanes(c, 0), step(c), c.count);
  Box box = kEmptyBox;
  for (std::uint32_t i = 0; i < c.count; ++i) {
    if (ids(c)[i] != kNoObject) box = united(box, box_at(c, i));
  }
  return box;
}

Box ChunkMap::tight(const Group& group) const noexcept {
  return world::bounds_of([&](std::uint32_t side) { return group.bounds[side].data(); }, group.count);
}

Box ChunkMap::chunk_bounds(std::uint32_t chunk) const noexcept {
  const Chunk& c = chunks_[chunk];
  const auto& b = groups_[c.group].bounds;
  const std::uint32_t i = c.index_in_group;
  return {{b[0][i], b[1][i], b[2][i]}, {b[3][i], b[4][i], b[5][i]}};
}

void ChunkMap::set_bounds(std::uint32_t chunk, const Box& box) noexcept {
  Chunk& c = chunks_[chunk];
  c.bounds = box;
  auto& b = groups_[c.group].bounds;
  const std::uint32_t i = c.index_in_group;
  b[0][i] = box.min.x, b[1][i] = box.min.y, b[2][i] = box.min.z;
  b[3][i] = box.max.x, b[4][i] = box.max.y, b[5][i] = box.max.z;
}

void ChunkMap::extend(std::uint32_t chunk, const Box& box) noexcept {
  const Box bounds = chunks_[chunk].bounds;
  if (holds(bounds, box) || SIGHTLINE_MUTANT(stale_chunk_bounds)) return;
  set_bounds(chunk, united(bounds, box));
  extend_group(chunks_[chunk].group, box);
}

// Where the chunk's objects lie and how many they are, for those who read the group.
void ChunkMap::note_shape(std::uint32_t chunk) noexcept {
  const Chunk& c = chunks_[chunk];
  if (c.group == kNone) return;
  Group& b = groups_[c.group];
  b.first_lane[c.index_in_group] = c.first_lane;
  const bool movers = c.pool == kMovers,
             in_order = kHasPages && movers && is_kept_page(c) && c.live == kCapacity;
  b.count_and_size[c.index_in_group] = c.count | c.capacity << Group::kSize |
                                       (c.live < c.count || movers ? Group::kLoose : 0) |
                                       (in_order ? Group::kInOrder : 0);
}

void ChunkMap::BoxRows::set(std::size_t i, const Box& box) noexcept {
  sides[0][i] = box.min.x, sides[1][i] = box.min.y, sides[2][i] = box.min.z;
  sides[3][i] = box.max.x, sides[4][i] = box.max.y, sides[5][i] = box.max.z;
}

void ChunkMap::BoxRows::resize(std::size_t count) {
  for (auto& side : sides) side.resize((count + 15) / 16 * 16);
}

void ChunkMap::set_box(std::uint32_t group, const Box& box) noexcept {
  Group& b = groups_[group];
  b.box = box;
  nodes_[b.node].group_boxes.set(b.index_in_node, box);
}

void ChunkMap::extend_group(std::uint32_t group, const Box& box) noexcept {
  Group& b = groups_[group];
  if (holds(b.box, box) || SIGHTLINE_MUTANT(stale_group_bounds)) return;
  set_box(group, united(b.box, box));
  for (std::uint32_t n = b.node; n != kNone && !holds(nodes_[n].bounds, box); n = nodes_[n].parent) {
    nodes_[n].bounds = united(nodes_[n].bounds, box);
  }
}

// After `gone` has left the chunk, which is not empty.
void ChunkMap::shrink(std::uint32_t chunk, const Box& gone) noexcept {
  const Box before = chunk_bounds(chunk);
  if (!touches(before, gone)) return;
  const Box now = tight(chunks_[chunk]);
  if (now == before) return;
  set_bounds(chunk, now);
  shrink_group(chunks_[chunk].group, before);
}

void ChunkMap::shrink_group(std::uint32_t group, const Box& gone) noexcept {
  Group& b = groups_[group];
  if (!touches(b.box, gone)) return;
  const Box before = b.box;
  set_box(group, tight(b));
  if (b.box != before) loosen(b.node, before);
}

void ChunkMap::loosen(std::uint32_t node, const Box& gone) noexcept {
  for (; node != kNone && touches(nodes_[node].bounds, gone); node = nodes_[node].parent) {
    loose_[node] = 1;
    any_loose_ = true;
  }
}

void ChunkMap::tighten() {
  arrange(8 * std::exchange(inserted_, 0) >= size_);
  tighten_nodes();
}

void ChunkMap::tighten_nodes() noexcept {
  if (!any_loose_) return;
  any_loose_ = false;
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children stand behind their parents
    if (!loose_[n]) continue;
    loose_[n] = 0;
    Box box = kEmptyBox;
    for (const std::uint32_t group : nodes_[n].groups) box = united(box, groups_[group].box);
    if (nodes_[n].first_child != kNone) {
      for (int i = 0; i < 4; ++i) box = united(box, nodes_[nodes_[n].first_child + i].bounds);
    }
    if (n == 0 && mover_node_ != kNone) box = united(box, nodes_[mover_node_].bounds);
    nodes_[n].bounds = box;
  }
}

// --- groups ---

void ChunkMap::add_objects(std::uint32_t group, std::int32_t change) noexcept {
  if (group == kNone) return;
  groups_[group].objects += static_cast<std::uint32_t>(change);
  for (std::uint32_t n = groups_[group].node; n != kNone; n = nodes_[n].parent) {
    nodes_[n].objects += static_cast<std::uint32_t>(change);
  }
}

std::uint32_t ChunkMap::add_group(std::uint32_t node) {
  const std::uint32_t group = take_element(groups_, free_groups_);
  groups_[group] = {};
  groups_[group].node = node;
  groups_[group].index_in_node = static_cast<std::uint32_t>(nodes_[node].groups.size());
  nodes_[node].groups.push_back(group);
  nodes_[node].group_boxes.resize(nodes_[node].groups.size());
  set_box(group, kEmptyBox);
  return group;
}

// Puts a chunk and its objects into `group`, or into any of its region where that is kNone.
void ChunkMap::put_in_group(std::uint32_t chunk, std::uint32_t group, const Box& bounds) {
  const std::uint32_t node = chunks_[chunk].pool == kMovers ? mover_node_ : keys_[chunks_[chunk].key].node;
  if (group == kNone) {
    const auto& all = nodes_[node].groups;
    group = !all.empty() && groups_[all.back()].count < kGroupCapacity ? all.back() : add_group(node);
  } else if (groups_[group].count == kGroupCapacity) {
    group = split_group(group, bounds);
  }
  Chunk& c = chunks_[chunk];
  Group& b = groups_[group];
  c.group = group;
  c.index_in_group = b.count;
  b.chunks[b.count++] = chunk;
  b.pool = c.pool;
  set_bounds(chunk, bounds);
  note_shape(chunk), note_stale(chunk);
  add_objects(group, static_cast<std::int32_t>(c.live));
  c.counted = c.live;
  extend_group(group, bounds);
}

void ChunkMap::take_from_group(std::uint32_t chunk) {
  Chunk& c = chunks_[chunk];
  const std::uint32_t group = c.group;
  Group& b = groups_[group];
  const Box before = chunk_bounds(chunk);
  const std::uint32_t last = --b.count;
  if (c.index_in_group != last) {
    for (auto& side : b.bounds) side[c.index_in_group] = side[last];
    b.chunks[c.index_in_group] = b.chunks[last];
    b.first_lane[c.index_in_group] = b.first_lane[last];
    b.count_and_size[c.index_in_group] = b.count_and_size[last];
    chunks_[b.chunks[last]].index_in_group = c.index_in_group;
    note_stale(b.chunks[last]);
  }
  c.group = kNone;
  if (b.count > 0) return shrink_group(group, before);
  auto& all = nodes_[b.node].groups;
  all[b.index_in_node] = all.back();
  groups_[all.back()].index_in_node = b.index_in_node;
  if (all.back() != group) set_box(all.back(), groups_[all.back()].box);
  all.pop_back();
  nodes_[b.node].group_boxes.resize(all.size());
  loosen(b.node, b.box);
  free_groups_.push_back(group);
}

// Moves the upper half of a full group's chunks, along the longest axis of their centres, to a new group.
// Returns the one nearer to `newcomer`.
std::uint32_t ChunkMap::split_group(std::uint32_t group, const Box& newcomer) {
  const std::uint32_t added = add_group(groups_[group].node);
  Group &low = groups_[group], &high = groups_[added];
  std::uint32_t axis = 0;
  float longest = -1;
  std::array<float, kGroupCapacity> centre{};
  const auto middle = [&](std::uint32_t a, std::uint32_t i) {
    return 0.5f * low.bounds[a][i] + 0.5f * low.bounds[a + 3][i];
  };
  for (std::uint32_t a = 0; a < 3; ++a) {
    float least = kInfinity, most = -kInfinity;
    for (std::uint32_t i = 0; i < kGroupCapacity; ++i) {
      least = std::min(least, middle(a, i)), most = std::max(most, middle(a, i));
    }
    if (most - least > longest) longest = most - least, axis = a;
  }
  std::array<std::uint32_t, kGroupCapacity> order{};
  for (std::uint32_t i = 0; i < kGroupCapacity; ++i) order[i] = i, centre[i] = middle(axis, i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return centre[a] != centre[b] ? centre[a] < centre[b] : a < b;
  });
  const Group old = low;
  low.count = high.count = 0;
  std::uint32_t moved_objects = 0;
  for (std::uint32_t k = 0; k < kGroupCapacity; ++k) {
    const std::uint32_t from = order[k], chunk = old.chunks[from];
    const bool up = k >= kGroupCapacity / 2;
    Group& to = up ? high : low;
    const std::uint32_t i = to.count++;
    for (std::uint32_t side = 0; side < 6; ++side) to.bounds[side][i] = old.bounds[side][from];
    to.chunks[i] = chunk;
    to.first_lane[i] = old.first_lane[from];
    to.count_and_size[i] = old.count_and_size[from];
    chunks_[chunk].group = up ? added : group;
    chunks_[chunk].index_in_group = i;
    note_stale(chunk);
    if (up) moved_objects += chunks_[chunk].counted;
  }
  set_box(group, tight(low));
  set_box(added, tight(high));
  low.objects -= moved_objects;
  high.objects += moved_objects;
  const float at = centre[order[kGroupCapacity / 2]];
  return coordinate(centre_of(newcomer), axis) >= at ? added : group;
}

// --- what others read ---

RegionSet ChunkMap::chunk_regions(std::uint32_t chunk) const noexcept {
  return keys_[chunks_[chunk].key].regions;
}

std::uint32_t ChunkMap::write_vertices(std::uint32_t chunk, std::span<ChunkVertex> out) const noexcept {
  const ChunkView c = this->chunk(chunk);
  // centre and half extent each round once, and the sum that restores the box once more.
  constexpr float kRounding = 2 * std::numeric_limits<float>::epsilon();
  const auto half = [](float low, float high, float middle) {
    return std::max(high - middle, middle - low) + kRounding * (std::fabs(low) + std::fabs(high));
  };
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const auto [low, high] = c.box(i);
    const Vec3 centre{0.5f * low.x + 0.5f * high.x, 0.5f * low.y + 0.5f * high.y,
                      0.5f * low.z + 0.5f * high.z};
    out[i] = {centre,
              c.objects[i],
              {half(low.x, high.x, centre.x), half(low.y, high.y, centre.y), half(low.z, high.z, centre.z)},
              chunk};
  }
  return c.count;
}

}  // namespace sightline::world
