// A uniform grid on the ground (x–z) that says which objects stand near each other. Knows planes, no camera.
#pragma once

#include <span>
#include <utility>
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

  /// How many cells there are along an axis: as many as this says, or where it says 0, as `cell` makes.
  struct Counts {
    std::uint32_t rows = 0, columns = 0;
  };

  /// Bounds and extents: one box an object. `cell` in metres; the grid has at most 4096 cells a side.
  void build(const Boxes& bounds, float cell, const Counts& counts = {0, 0});

  [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::uint32_t columns() const noexcept { return columns_; }
  [[nodiscard]] Box cell_bounds(std::uint32_t row, std::uint32_t column) const noexcept;
  [[nodiscard]] bool is_empty(std::uint32_t row, std::uint32_t column) const noexcept;
  /// The row and the column in which an object with this centre stands; of a place beyond the grid, the
  /// nearest.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> cell_at(float x, float z) const noexcept;
  /// The cell's share of the ground, by their centres; y is 0.
  [[nodiscard]] Box cell_ground(std::uint32_t row, std::uint32_t column) const noexcept;

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
  // Which cell along one axis a centre falls into.
  struct Axis {
    float origin = 0, cell = 1;
    std::uint32_t cells = 1;

    Axis() = default;
    Axis(float low, float high, float wanted, std::uint32_t count);
    [[nodiscard]] std::uint32_t of(float centre) const noexcept;
  };

  Axis across_, along_;
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
