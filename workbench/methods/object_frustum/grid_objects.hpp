// What grid-cell and object-frustum share: the objects in a grid on the ground, and their volumes in its
// order.
#pragma once

#include <vector>

#include "workbench/methods/methods.hpp"
#include "workbench/partition/object_grid.hpp"
#include "workbench/submission/draw_list.hpp"
#include "workbench/submission/object_bounds.hpp"

namespace sightline::methods {

inline constexpr ParameterInfo kCellParameter{
    "cell", "metres, the side of a cell; 0 chooses about 64 objects a cell", "0", 0, 1e6};
inline constexpr ParameterInfo kRowsParameter{
    "rows", "cells along z; 0: as many as `cell` makes", "0", 0, 4096, true};
inline constexpr ParameterInfo kColumnsParameter{
    "columns", "cells along x; 0: as many as `cell` makes", "0", 0, 4096, true};

struct GridObjects {
  const Scene& scene;
  submission::ObjectBounds bounds;  ///< in grid order
  partition::ObjectGrid grid;

  GridObjects(const Scene& scene, const Parameters& parameters);

  /// Appends all objects of the cells that overlap the frustum, and those too large for a cell.
  void take_cells(const Frustum& frustum, Frame& frame) const noexcept;
  /// Appends the objects of `runs`, those of crossing cells if they overlap the frustum themselves, and of
  /// those too large for a cell.
  void test_cells(const Frustum& frustum, std::span<const partition::ObjectGrid::Run> runs,
                  Frame& frame) const noexcept;

  /// Buckets everything anew: a moved object may have changed its cell and its neighbours' bounds.
  void rebuild();

private:
  std::size_t take(std::uint32_t begin, std::uint32_t end, std::size_t kept, Frame& frame) const noexcept;
  std::size_t test(const Frustum& frustum, std::uint32_t begin, std::uint32_t end, std::size_t kept,
                   Frame& frame) const noexcept;

  float cell_;
  partition::ObjectGrid::Counts counts_;
};

}  // namespace sightline::methods
