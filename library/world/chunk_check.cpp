// The invariants of a chunk map, looked at one by one.
#include <string>

#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

Failure bad(const char* what, std::size_t i) {
  return {"chunk map: " + std::string(what) + " " + std::to_string(i)};
}

}  // namespace

Check ChunkMap::check_chunk(std::uint32_t chunk) const {
  const Chunk& c = chunks_[chunk];
  if (c.key == kNone) {
    if (c.count != 0) return bad("objects in free chunk", chunk);
    return {};
  }
  if (c.count == 0) return bad("no object in chunk", chunk);
  if (c.count > c.capacity || c.capacity >= 100) return bad("too many objects in chunk", chunk);
  if (c.group == kNone || groups_[c.group].chunks[c.index_in_group] != chunk)
    return bad("wrong group of chunk", chunk);
  if (groups_[c.group].node != keys_[c.key].node) return bad("wrong region of chunk", chunk);
  if (chunk_bounds(chunk) != tight(c)) return bad("bounds not tight of chunk", chunk);
  for (std::uint32_t slot = 0; slot < c.count; ++slot) {
    const ObjectId object = ids_[c.first_lane + slot];
    const Location at = (*locations_)[object];
    if (at.chunk != chunk || at.slot != slot) return bad("wrong location of object", object);
    const Box box = box_at(c, slot);
    if (regions(box) != keys_[c.key].regions) return bad("wrong key of object", object);
    std::uint32_t found = find_chunk(keys_[c.key], centre_of(box));
    while (found != kNone && found != chunk) found = chunks_[found].next;
    if (found != chunk) return bad("the splits do not lead to object", object);
  }
  return {};
}

Check ChunkMap::check_group(std::uint32_t group) const {
  const Group& g = groups_[group];
  const Node& node = nodes_[g.node];
  if (g.box != tight(g)) return bad("bounds not tight of group", group);
  if (!holds(node.bounds, g.box)) return bad("bounds too small of region", g.node);
  const auto& rows = node.group_boxes.sides;
  const std::size_t i = g.index_in_node;
  const Box row{{rows[0][i], rows[1][i], rows[2][i]}, {rows[3][i], rows[4][i], rows[5][i]}};
  if (row != g.box) return bad("wrong bounds in the region of group", group);
  std::size_t held = 0;
  for (std::uint32_t k = 0; k < g.count; ++k) {
    held += chunks_[g.chunks[k]].count;
    const ChunkView here = chunk(g, k), there = chunk(g.chunks[k]);
    if (here.objects != there.objects || here.count != there.count || here.min_y != there.min_y ||
        here.max_z != there.max_z)
      return bad("wrong lanes in the group of chunk", g.chunks[k]);
  }
  if (held != g.objects) return bad("wrong number of objects in group", group);
  return {};
}

Check ChunkMap::check_node(std::uint32_t n) const {
  const Node& node = nodes_[n];
  std::size_t below = 0;
  for (std::size_t i = 0; i < node.groups.size(); ++i) {
    const std::uint32_t group = node.groups[i];
    const Group& g = groups_[group];
    if (g.node != n || g.index_in_node != i || g.count == 0) return bad("wrong group", group);
    if (Check wrong = check_group(group)) return wrong;
    below += g.objects;
  }
  if (node.first_child != kNone) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Node& child = nodes_[node.first_child + i];
      if (child.objects > 0 && !holds(node.bounds, child.bounds)) return bad("bounds too small of region", n);
      below += child.objects;
    }
  }
  if (below != node.objects) return bad("wrong number of objects in region", n);
  return {};
}

Check ChunkMap::check() const {
  std::size_t objects = 0, chunks = 0;
  for (std::uint32_t i = 0; i < chunks_.size(); ++i) {
    if (Check wrong = check_chunk(i)) return wrong;
    objects += chunks_[i].count;
  }
  if (objects != size_) return bad("wrong size", size_);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (Check wrong = check_node(n)) return wrong;
    for (const std::uint32_t group : nodes_[n].groups) chunks += groups_[group].count;
  }
  if (chunks + free_chunks_.size() != chunks_.size()) return bad("lost chunk of", chunks_.size());
  return {};
}

}  // namespace sightline::world
