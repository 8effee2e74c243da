// The invariants of a chunk map, looked at one by one.
#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

Status bad(const char* what, std::size_t i) {
  return {StatusCode::bad_argument, what, i};
}

}  // namespace

Status ChunkMap::check_chunk(std::uint32_t chunk) const {
  const Chunk& c = chunks_[chunk];
  if (c.key == kNone) {
    if (c.count != 0) return bad("chunk map: objects in free chunk", chunk);
    return {};
  }
  if (c.dirty) return bad("chunk map: not flushed chunk", chunk);
  if (c.live == 0 && !c.grown && c.pool == kStill) return bad("chunk map: no object in chunk", chunk);
  if (c.count > c.capacity || c.capacity >= 100) return bad("chunk map: too many objects in chunk", chunk);
  if (c.group == kNone || groups_[c.group].chunks[c.index_in_group] != chunk)
    return bad("chunk map: wrong group of chunk", chunk);
  const std::uint32_t node = c.pool == kMovers ? mover_node_ : keys_[c.key].node;
  if (groups_[c.group].node != node || groups_[c.group].pool != c.pool)
    return bad("chunk map: wrong region of chunk", chunk);
  if (chunk_bounds(chunk) != c.bounds || !holds(c.bounds, tight(c)))
    return bad("chunk map: bounds too small of chunk", chunk);
  if (!loosely_ && c.bounds != tight(c)) return bad("chunk map: bounds not tight of chunk", chunk);
  if (c.pool == kMovers && (mover_chunks_[c.parent] != chunk || (is_page(c) && pages_[c.previous] != chunk)))
    return bad("chunk map: movers' lists without chunk", chunk);
  std::uint32_t live = 0;
  for (std::uint32_t slot = 0; slot < c.count; ++slot) {
    const ObjectId object = ids(c)[slot];
    if (object == kNoObject) continue;
    ++live;
    const Location& at = (*locations_)[object];
    if (at.chunk != chunk || at.slot() != slot) return bad("chunk map: wrong location of object", object);
    if (c.pool == kMovers && is_page(c) && (object / kCapacity != c.previous || object % kCapacity != slot))
      return bad("chunk map: another's place in the page of object", object);
    if (loosely_) continue;
    const Box box = box_at(c, slot);
    if (regions(box) != keys_[c.key].regions) return bad("chunk map: wrong key of object", object);
    std::uint32_t found = find_chunk(keys_[c.key], centre_of(box));
    while (found != kNone && found != chunk) found = chunks_[found].next;
    if (found != chunk) return bad("chunk map: the splits do not lead to object", object);
  }
  if (live != c.live || live != c.counted) return bad("chunk map: wrong number of objects in chunk", chunk);
  return has_columns() ? check_columns(chunk) : Status{};
}

// After settle_columns().
Status ChunkMap::check_columns(std::uint32_t chunk) const {
  const Chunk& c = chunks_[chunk];
  if (c.stale) return bad("chunk map: not settled chunk", chunk);
  const Pool& pool = pools_[c.pool];
  for (std::uint32_t slot = 0; slot < c.count; ++slot) {
    const ObjectId object = ids(c)[slot];
    if (object == kNoObject) continue;
    if (columns_->has_layers && pool.layers[c.first_lane + slot] != columns_->layers[object])
      return bad("chunk map: wrong layers of object", object);
    if (!columns_->has_distances) continue;
    const float* at = &pool.distances[2 * std::size_t{c.first_lane} + slot];
    if (columns_->distances[object] != DistanceRange{at[0], at[c.capacity]})
      return bad("chunk map: wrong distances of object", object);
  }
  const ChunkColumns all = columns_of(c);
  if (columns_->has_layers) {
    const std::uint32_t* row = layer_rows(c.group) + c.index_in_group;
    if (row[LayerRows::kSome] != all.some || row[LayerRows::kEvery] != all.every)
      return bad("chunk map: wrong layers in the group of chunk", chunk);
  }
  if (columns_->has_distances) {
    const float* row = distance_rows(c.group) + c.index_in_group;
    if (row[DistanceRows::kFirstMin] != all.first_min || row[DistanceRows::kLastMin] != all.last_min ||
        row[DistanceRows::kFirstMax] != all.first_max || row[DistanceRows::kLastMax] != all.last_max)
      return bad("chunk map: wrong distances in the group of chunk", chunk);
  }
  return {};
}

Status ChunkMap::check_group(std::uint32_t group) const {
  const Group& g = groups_[group];
  const Node& node = nodes_[g.node];
  if (!loosely_ && g.box != tight(g)) return bad("chunk map: bounds not tight of group", group);
  if (!holds(node.bounds, g.box)) return bad("chunk map: bounds too small of region", g.node);
  if (!holds(g.box, tight(g))) return bad("chunk map: bounds too small of group", group);
  const auto& rows = node.group_boxes.sides;
  const std::size_t i = g.index_in_node;
  const Box row{{rows[0][i], rows[1][i], rows[2][i]}, {rows[3][i], rows[4][i], rows[5][i]}};
  if (row != g.box) return bad("chunk map: wrong bounds in the region of group", group);
  std::size_t held = 0;
  for (std::uint32_t k = 0; k < g.count; ++k) {
    held += chunks_[g.chunks[k]].live;
    const ChunkView here = chunk(g, k), there = chunk(g.chunks[k]);
    if (here.objects != there.objects || here.count != there.count || here.loose != there.loose ||
        here.sides != there.sides || here.step != there.step)
      return bad("chunk map: wrong lanes in the group of chunk", g.chunks[k]);
  }
  if (held != g.objects) return bad("chunk map: wrong number of objects in group", group);
  return {};
}

Status ChunkMap::check_node(std::uint32_t n) const {
  const Node& node = nodes_[n];
  std::size_t below = 0;
  for (std::size_t i = 0; i < node.groups.size(); ++i) {
    const std::uint32_t group = node.groups[i];
    const Group& g = groups_[group];
    if (g.node != n || g.index_in_node != i || g.count == 0) return bad("chunk map: wrong group", group);
    if (const Status sound = check_group(group); !sound) return sound;
    below += g.objects;
  }
  if (node.first_child != kNone) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Node& child = nodes_[node.first_child + i];
      if (child.objects > 0 && !holds(node.bounds, child.bounds))
        return bad("chunk map: bounds too small of region", n);
      below += child.objects;
    }
  }
  if (n == 0 && mover_node_ != kNone) {
    if (movers() > 0 && !holds(node.bounds, nodes_[mover_node_].bounds))
      return bad("chunk map: bounds too small of region", n);
    below += movers();
  }
  if (below != node.objects) return bad("chunk map: wrong number of objects in region", n);
  return {};
}

Status ChunkMap::check() const {
  std::size_t objects = 0, chunks = 0;
  for (std::uint32_t i = 0; i < chunks_.size(); ++i) {
    if (const Status sound = check_chunk(i); !sound) return sound;
    objects += chunks_[i].live;
  }
  if (objects != size_) return bad("chunk map: wrong size", size_);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (const Status sound = check_node(n); !sound) return sound;
    for (const std::uint32_t group : nodes_[n].groups) chunks += groups_[group].count;
  }
  if (chunks + free_chunks_.size() != chunks_.size()) return bad("chunk map: lost chunk of", chunks_.size());
  return {};
}

}  // namespace sightline::world
