#include "library/world/chunk_walk.hpp"

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

}  // namespace sightline::world
