// A uniform grid on the ground (x–z) that says which objects stand near each other. Knows planes, no camera.
#pragma once

#include <span>
#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::partition {

/// Objects bucketed by their centres. Objects of a cell, and the cells of a row, stand side by side in
/// `order()`. A column's bounds are the tight bounds of its objects, widened so that both ends never decrease
/// from column to column; so a row's cells that touch a half space are an interval of columns, found by
/// bisection.
class ObjectGrid {
public:
  /// Cells [first_column, last_column) of one row, all of the same overlap with the frustum.
  struct Run {
    std::uint32_t row, first_column, last_column;
    Overlap overlap;
    bool operator==(const Run&) const = default;
  };

  /// Bounds and extents: one box an object. `cell` in metres; the grid has at most 4096 cells a side.
  void build(const Boxes& bounds, float cell);

  [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::uint32_t columns() const noexcept { return columns_; }
  [[nodiscard]] Box cell_bounds(std::uint32_t row, std::uint32_t column) const noexcept;
  [[nodiscard]] bool is_empty(std::uint32_t row, std::uint32_t column) const noexcept;

  /// Object ids, cell by cell; behind the last cell those too large for any cell.
  [[nodiscard]] std::span<const ObjectId> order() const noexcept { return order_; }
  /// Where the objects of cells [first, last) of a row stand in order(): {begin, end}.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> slots(std::uint32_t row, std::uint32_t first,
                                                              std::uint32_t last) const noexcept;
  /// Where the objects too large for any cell stand in order().
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> oversize_slots() const noexcept;

  /// Appends the runs of inside and crossing cells, row by row, left to right; visits no cell outside.
  /// Returns how many rows were looked at.
  std::uint32_t classify(const Frustum& frustum, std::vector<Run>& runs) const;

private:
  std::uint32_t rows_ = 0, columns_ = 0;
  std::vector<std::uint32_t> cell_start_;  // rows × columns + 1 slots
  std::vector<ObjectId> order_;
  std::vector<float> column_min_x_, column_max_x_;
  struct Row {
    float min_y, max_y, min_z, max_z;
  };
  std::vector<Row> row_;
};

}  // namespace sightline::partition
