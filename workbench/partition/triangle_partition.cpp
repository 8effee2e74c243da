#include "workbench/partition/triangle_partition.hpp"

#include <algorithm>
#include <string>

#include <sightline/workbench/error.hpp>

namespace sightline::partition {

namespace {

// A split into k saves at best what k − 1 children hold, and costs at worst k − 1 calls: nodes of fewer
// triangles than k calls are worth have less to gain than to lose. A grid's cells are all alike.
std::size_t least_triangles(Structure structure, const CellRules& rules) {
  switch (structure) {
    case Structure::grid:
      return rules.least == 0 ? 0 : 2;
    case Structure::octree:
      return std::size_t{8} * rules.least;
    case Structure::kd_tree:
      break;
  }
  return std::size_t{2} * rules.least;
}

}  // namespace

Box united(const Box& a, const Box& b) noexcept {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

Box shown_within(const Box& region, const std::array<Vec3, 3>& triangle) noexcept {
  const Box box = bounds_of(triangle);
  const auto cut = [](float value, float low, float high) { return std::clamp(value, low, high); };
  return {{cut(box.min.x, region.min.x, region.max.x), cut(box.min.y, region.min.y, region.max.y),
           cut(box.min.z, region.min.z, region.max.z)},
          {cut(box.max.x, region.min.x, region.max.x), cut(box.max.y, region.min.y, region.max.y),
           cut(box.max.z, region.min.z, region.max.z)}};
}

struct TrianglePartition::Builder {
  TrianglePartition& out;
  const TriangleSpan& all;
  Structure structure;
  CellRules rules;

  // Whether the node is split, into `parts`.
  [[nodiscard]] bool divide(std::span<const std::uint32_t> triangles, const Box& region, std::uint32_t levels,
                            Split& parts) const {
    if (levels == 0 || triangles.size() < least_triangles(structure, rules)) return false;
    return split(structure, all, triangles, region, parts) || rules.least == 0;
  }

  // False, and nothing made, where no triangle turned out to reach into the region.
  bool node(std::span<const std::uint32_t> triangles, const Box& region, std::uint32_t levels) {
    const std::size_t self = out.nodes_.size();
    out.nodes_.push_back({{}, 0, out.cells(), 0});
    Split parts;
    if (!divide(triangles, region, levels, parts)) {
      out.nodes_[self].bounds = cell(triangles, region);
    } else {
      bool first = true;
      for (std::uint32_t child = 0; child < 8; ++child) {
        if (parts.triangles[child].empty()) continue;
        const std::size_t at = out.nodes_.size();
        const bool made = node(parts.triangles[child], parts.regions[child], levels - 1);
        parts.triangles[child] = {};  // 20 M triangles six levels deep: give back early
        if (!made) continue;
        const Box bounds = out.nodes_[at].bounds;
        out.nodes_[self].bounds = first ? bounds : united(out.nodes_[self].bounds, bounds);
        first = false;
      }
      if (first) {
        out.nodes_.resize(self);
        return false;
      }
      if (rules.printed) out.nodes_[self].bounds = region;
    }
    out.nodes_[self].next = static_cast<std::uint32_t>(out.nodes_.size());
    out.nodes_[self].last_cell = out.cells();
    return true;
  }

  Box cell(std::span<const std::uint32_t> triangles, const Box& region) {
    if (out.triangles_.size() + triangles.size() > rules.most_held) {
      throw Error("cells of triangles: more than " + std::to_string(rules.most_held) +
                  " copies; expected a smaller height, or least above 0");
    }
    Box bounds = shown_within(region, all[triangles.front()]);
    for (const std::uint32_t triangle : triangles)
      bounds = united(bounds, shown_within(region, all[triangle]));
    if (rules.printed) bounds = region;
    out.triangles_.insert(out.triangles_.end(), triangles.begin(), triangles.end());
    out.cell_start_.push_back(static_cast<std::uint32_t>(out.triangles_.size()));
    out.cell_bounds_.push_back(bounds);
    out.cell_regions_.push_back(region);
    return bounds;
  }
};

void TrianglePartition::build(Structure structure, const TriangleSpan& all,
                              std::span<const std::uint32_t> triangles, std::uint32_t height,
                              const CellRules& rules) {
  *this = {};
  if (triangles.empty()) return;
  Box region = bounds_of(all[triangles.front()]);
  for (const std::uint32_t triangle : triangles) region = united(region, bounds_of(all[triangle]));
  triangles_.reserve(triangles.size() + triangles.size() / 4);
  Builder{*this, all, structure, rules}.node(triangles, region, height);
}

std::uint64_t TrianglePartition::bytes() const noexcept {
  return nodes_.size() * sizeof(Node) + (cell_start_.size() + triangles_.size()) * sizeof(std::uint32_t) +
         (cell_bounds_.size() + cell_regions_.size()) * sizeof(Box);
}

std::uint32_t TrianglePartition::walk(const Frustum& frustum, std::vector<Run>& runs) const {
  const std::size_t before = runs.size();
  std::uint32_t visited = 0;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    ++visited;
    const Overlap overlap = classify(frustum, node.bounds);
    const bool leaf = node.next == i + 1;
    if (overlap != Overlap::outside && (leaf || overlap == Overlap::inside)) {
      if (runs.size() > before && runs.back().last_cell == node.first_cell) {
        runs.back().last_cell = node.last_cell;
      } else {
        runs.push_back({node.first_cell, node.last_cell});
      }
    }
    i = overlap == Overlap::crossing ? i + 1 : node.next;
  }
  return visited;
}

}  // namespace sightline::partition
