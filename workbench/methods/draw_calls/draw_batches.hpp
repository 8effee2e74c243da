// What a visible cell can draw: the submission strategies of Serpa et al. as data.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "workbench/methods/draw_calls/facing.hpp"
#include "workbench/methods/draw_calls/flat_triangles.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::methods {

enum class Strategy : std::uint8_t {
  simple,         ///< one global list; a cell draws each contiguous run of its triangles
  drawcall_wise,  ///< each cell owns a copy of its triangles: one range
  zhang,          ///< each cell's copy in parts by facing: a range a part that can face the eye
};

/// How a cell's triangles become batches.
struct BatchRules {
  Strategy strategy = Strategy::drawcall_wise;
  PartPlanes planes = PartPlanes::xz;  ///< of zhang's parts
  bool with_cones = false;             ///< for batches that are not zhang's, too
};

/// A range of a triangle list.
struct TriangleRange {
  std::uint32_t first = 0, count = 0;
  bool operator==(const TriangleRange&) const = default;
};

/// A batch is drawn or dropped as a whole. Cell c has the batches cell_start[c] … cell_start[c + 1], batch u
/// the ranges range_start[u] … and the objects object_start[u] …; cones[u] is its facing, where batches have
/// one.
struct DrawBatches {
  std::vector<std::uint32_t> cell_start{0}, range_start{0}, object_start{0};
  std::vector<TriangleRange> ranges;
  std::vector<ObjectId> objects;  ///< of the batch's triangles, ascending, each once
  std::vector<FacingCone> cones;

  [[nodiscard]] std::uint64_t bytes() const noexcept;
};

/// The lists that ranges refer to: numbers of flat triangles, in the order they are drawn in.
using TriangleOrder = std::vector<std::uint32_t>;

/// Makes the batches of a partition of opaque triangles. `order` is the global list for `simple` (every
/// triangle, untouched); for the others the copies are appended.
DrawBatches make_draw_batches(const BatchRules& rules, const FlatTriangles& flat,
                              const partition::TrianglePartition& cells, TriangleOrder& order);

/// The same of transparent triangles, which are drawn in order of depth and only once: whatever the strategy,
/// batches are runs of one list. `triangles` are all of them, ascending; triangles[i] stands at positions[i].
DrawBatches make_blended_batches(const BatchRules& rules, const FlatTriangles& flat,
                                 const partition::TrianglePartition& cells,
                                 std::span<const std::uint32_t> triangles,
                                 std::span<const std::uint32_t> positions);

}  // namespace sightline::methods
