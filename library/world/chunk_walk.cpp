// The walk of the regions, and the check of the map's invariants.
#include <algorithm>
#include <string>

#include "library/world/chunk_map.hpp"

namespace sightline::world {

void walk(const ChunkMap& map, const Frustum& frustum, ChunkWalk& out) {
  out.clear();
  // At most three siblings wait on each level, and the last level's four.
  std::array<std::uint32_t, 4 * (ChunkMap::kMaxDepth + 1)> stack{};
  std::array<bool, stack.size()> taken{};  // the whole region is inside
  std::size_t top = 0;
  if (map.size() > 0) stack[top++] = 0;
  while (top > 0) {
    --top;
    const ChunkMap::Node& node = map.nodes()[stack[top]];
    bool inside = taken[top];
    ++out.nodes_visited;
    if (!inside) {
      const Overlap overlap = classify(frustum, node.bounds);
      if (overlap == Overlap::outside) continue;
      inside = overlap == Overlap::inside;
    }
    for (const std::uint32_t b : node.groups) {
      const ChunkMap::Group& group = map.groups()[b];
      ++out.nodes_visited;
      const Overlap overlap = inside ? Overlap::inside : classify(frustum, group.box);
      if (overlap == Overlap::outside) continue;
      if (overlap == Overlap::inside) {
        out.inside.insert(out.inside.end(), group.chunks.begin(), group.chunks.begin() + group.count);
        continue;
      }
      for (std::uint32_t i = 0; i < group.count; ++i) {
        ++out.nodes_visited;
        const Overlap one = classify(frustum, map.chunk_bounds(group.chunks[i]));
        if (one != Overlap::outside)
          (one == Overlap::inside ? out.inside : out.crossing).push_back(group.chunks[i]);
      }
    }
    if (node.first_child == ChunkMap::kNone) continue;
    for (std::uint32_t i = 4; i-- > 0;) {
      const std::uint32_t child = node.first_child + i;
      if (map.nodes()[child].objects == 0) continue;
      stack[top] = child;
      taken[top++] = inside;
    }
  }
}

Check ChunkMap::check() const {
  const auto bad = [](const char* what, std::size_t i) {
    return Failure{"chunk map: " + std::string(what) + " " + std::to_string(i)};
  };
  const auto holds = [](const Box& a, const Box& b) {
    return a.min.x <= b.min.x && a.min.y <= b.min.y && a.min.z <= b.min.z && a.max.x >= b.max.x &&
           a.max.y >= b.max.y && a.max.z >= b.max.z;
  };
  std::size_t objects = 0;
  for (std::uint32_t i = 0; i < chunks_.size(); ++i) {
    const Chunk& c = chunks_[i];
    if (c.key == kNone) {
      if (c.count != 0) return bad("objects in free chunk", i);
      continue;
    }
    if (c.count == 0) return bad("no object in chunk", i);
    if (c.count > c.capacity || c.capacity >= 100) return bad("too many objects in chunk", i);
    if (c.group == kNone || groups_[c.group].chunks[c.index_in_group] != i)
      return bad("wrong group of chunk", i);
    if (groups_[c.group].node != keys_[c.key].node) return bad("wrong region of chunk", i);
    if (chunk_bounds(i) != tight(c)) return bad("bounds not tight of chunk", i);
    for (std::uint32_t slot = 0; slot < c.count; ++slot) {
      const ObjectId object = ids_[c.first_lane + slot];
      const Location at = (*locations_)[object];
      if (at.chunk != i || at.slot != slot) return bad("wrong location of object", object);
      if (regions(box_at(c, slot)) != keys_[c.key].regions) return bad("wrong key of object", object);
      const Box box = box_at(c, slot);
      const Vec3 centre{0.5f * box.min.x + 0.5f * box.max.x, 0.5f * box.min.y + 0.5f * box.max.y,
                        0.5f * box.min.z + 0.5f * box.max.z};
      std::uint32_t found = find_chunk(keys_[c.key], centre);
      while (found != kNone && found != i) found = chunks_[found].next;
      if (found != i) return bad("the splits do not lead to object", object);
    }
    objects += c.count;
  }
  if (objects != size_) return bad("wrong size", size_);
  std::size_t chunks = 0;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    std::size_t below = 0;
    for (std::size_t i = 0; i < node.groups.size(); ++i) {
      const Group& group = groups_[node.groups[i]];
      if (group.node != n || group.index_in_node != i || group.count == 0)
        return bad("wrong group", node.groups[i]);
      if (group.box != tight(group)) return bad("bounds not tight of group", node.groups[i]);
      if (!holds(node.bounds, group.box)) return bad("bounds too small of region", n);
      const auto& rows = node.group_boxes.sides;
      const Box row{{rows[0][i], rows[1][i], rows[2][i]}, {rows[3][i], rows[4][i], rows[5][i]}};
      if (row != group.box) return bad("wrong bounds in the region of group", node.groups[i]);
      std::size_t held = 0;
      for (std::uint32_t k = 0; k < group.count; ++k) {
        held += chunks_[group.chunks[k]].count;
        const ChunkView here = chunk(group, k), there = chunk(group.chunks[k]);
        if (here.objects != there.objects || here.count != there.count || here.min_y != there.min_y ||
            here.max_z != there.max_z)
          return bad("wrong lanes in the group of chunk", group.chunks[k]);
      }
      if (held != group.objects) return bad("wrong number of objects in group", node.groups[i]);
      below += held;
      chunks += group.count;
    }
    if (node.first_child != kNone) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const Node& child = nodes_[node.first_child + i];
        if (child.objects > 0 && !holds(node.bounds, child.bounds))
          return bad("bounds too small of region", n);
        below += child.objects;
      }
    }
    if (below != node.objects) return bad("wrong number of objects in region", n);
  }
  if (chunks + free_chunks_.size() != chunks_.size()) return bad("lost chunk of", chunks_.size());
  return {};
}

}  // namespace sightline::world
