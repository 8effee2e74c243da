// Triangles in cells: grid, octree and k-d tree behind one interface. Knows planes, no camera.
#pragma once

#include <span>
#include <vector>

#include <sightline/frustum.hpp>

#include "workbench/partition/triangle_split.hpp"

namespace sightline::partition {

/// What a draw call costs, in triangles: by table 1 of the paper (one call or 100,000 of 100,000 triangles).
inline constexpr std::uint32_t kCallsWorth = 11;

/// How far nodes are split, and how large a cell is taken to be.
struct CellRules {
  /// A tree's node of fewer triangles than this for each child stays whole. 0: every node is split to the
  /// height, even where that multiplies its triangles.
  std::uint32_t least = kCallsWorth;
  /// Cells and nodes are the regions that they were split into, those of a grid as high as everything; else
  /// the tight boxes around what shows within.
  bool printed = false;
  std::size_t most_held = 200'000'000;  ///< triangles that all cells may hold together
  bool operator==(const CellRules&) const = default;
};

/// A tree whose leaves are the cells. Nodes stand depth first, so the cells under a node are a range, and a
/// walk needs no stack. A triangle that crosses cells belongs to each; empty cells are not made.
class TrianglePartition {
public:
  struct Node {
    Box bounds;              ///< around what the triangles of its cells show within those cells
    std::uint32_t next = 0;  ///< the node after the last one under this one
    std::uint32_t first_cell = 0, last_cell = 0;  ///< the cells under it
  };
  struct Run {
    std::uint32_t first_cell, last_cell;
    bool operator==(const Run&) const = default;
  };

  /// Structures of Serpa et al. over `triangles` (ascending ids into `all`), `height` levels of splitting.
  /// Unless the rules say otherwise a node is not split where that would multiply its triangles, nor a tree's
  /// where it holds fewer than its children's calls are worth. Coordinates are finite. Throws Error where
  /// cells would hold more than the rules allow.
  void build(Structure structure, const TriangleSpan& all, std::span<const std::uint32_t> triangles,
             std::uint32_t height, const CellRules& rules = {});

  /// Clusters: at most `size` triangles each (4 or more), alike in place and facing, each triangle in exactly
  /// one. meshoptimizer's meshlets; where `size` is more than they hold (85), halves of halves.
  void build_clusters(const TriangleSpan& all, std::span<const std::uint32_t> triangles, std::uint32_t size);

  [[nodiscard]] std::uint32_t cells() const noexcept {
    return static_cast<std::uint32_t>(cell_start_.size() - 1);
  }
  /// Ids of the cell's triangles, ascending.
  [[nodiscard]] std::span<const std::uint32_t> triangles(std::uint32_t cell) const noexcept {
    return std::span(triangles_).subspan(cell_start_[cell], cell_start_[cell + 1] - cell_start_[cell]);
  }
  [[nodiscard]] const Box& bounds(std::uint32_t cell) const noexcept { return cell_bounds_[cell]; }
  /// The part of space that is the cell's own; its bounds lie within. For clusters and printed cells the two
  /// are the same.
  [[nodiscard]] const Box& region(std::uint32_t cell) const noexcept { return cell_regions_[cell]; }
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  [[nodiscard]] std::uint64_t bytes() const noexcept;
  /// Gives back the lists of triangles once they have been copied; cells and walk() stay.
  void drop_triangles() noexcept { triangles_ = {}; }

  /// Appends the runs of cells that overlap the frustum, ascending, as few as possible. Returns how many
  /// nodes were looked at.
  std::uint32_t walk(const Frustum& frustum, std::vector<Run>& runs) const;

private:
  struct Builder;
  struct ClusterBuilder;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> cell_start_{0};
  std::vector<std::uint32_t> triangles_;
  std::vector<Box> cell_bounds_, cell_regions_;
};

/// What a triangle can show within a region: its box cut to the region.
Box shown_within(const Box& region, const std::array<Vec3, 3>& triangle) noexcept;

/// The smallest box that holds both.
Box united(const Box& a, const Box& b) noexcept;

}  // namespace sightline::partition
