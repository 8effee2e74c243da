#include "workbench/partition/object_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::partition {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMostCells = 4096;

float middle(float low, float high) noexcept {
  return 0.5f * low + 0.5f * high;
}

}  // namespace

ObjectGrid::Axis::Axis(float low, float high, float wanted, std::uint32_t count) : origin(low) {
  const float many =
      std::clamp(count > 0 ? static_cast<float>(count) : std::ceil((high - low) / wanted), 1.0f, kMostCells);
  cells = static_cast<std::uint32_t>(many);
  cell = std::max((high - low) / many, std::numeric_limits<float>::min());
}

std::uint32_t ObjectGrid::Axis::of(float centre) const noexcept {
  return std::min(static_cast<std::uint32_t>(std::max((centre - origin) / cell, 0.0f)), cells - 1);
}

void ObjectGrid::build(const Boxes& b, float cell, const Counts& counts) {
  const std::size_t n = b.size();
  float low_x = kInfinity, high_x = -kInfinity, low_z = kInfinity, high_z = -kInfinity;
  for (std::size_t i = 0; i < n; ++i) {
    const float x = middle(b.min_x[i], b.max_x[i]), z = middle(b.min_z[i], b.max_z[i]);
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_z = std::min(low_z, z), high_z = std::max(high_z, z);
  }
  across_ = Axis(low_x, high_x, cell, counts.columns), along_ = Axis(low_z, high_z, cell, counts.rows);
  columns_ = across_.cells, rows_ = along_.cells;
  const std::uint32_t cells = rows_ * columns_;

  // Counting sort by cell; a last bucket for what is larger than a cell and would widen its neighbours.
  const float most_x = 2 * std::max(across_.cell, cell), most_z = 2 * std::max(along_.cell, cell);
  std::vector<std::uint32_t> cell_of(n);
  cell_start_.assign(cells + 2, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool oversize = b.max_x[i] - b.min_x[i] > most_x || b.max_z[i] - b.min_z[i] > most_z;
    cell_of[i] = oversize ? cells
                          : along_.of(middle(b.min_z[i], b.max_z[i])) * columns_ +
                                across_.of(middle(b.min_x[i], b.max_x[i]));
    ++cell_start_[cell_of[i] + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  order_.resize(n);
  std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t i = 0; i < n; ++i) order_[next[cell_of[i]]++] = static_cast<ObjectId>(i);

  column_min_x_.assign(columns_, kInfinity), column_max_x_.assign(columns_, -kInfinity);
  row_.assign(rows_, {kInfinity, -kInfinity, kInfinity, -kInfinity});
  for (std::size_t i = 0; i < n; ++i) {
    if (cell_of[i] == cells) continue;
    const std::uint32_t column = cell_of[i] % columns_;
    Row& row = row_[cell_of[i] / columns_];
    column_min_x_[column] = std::min(column_min_x_[column], b.min_x[i]);
    column_max_x_[column] = std::max(column_max_x_[column], b.max_x[i]);
    row.min_y = std::min(row.min_y, b.min_y[i]), row.max_y = std::max(row.max_y, b.max_y[i]);
    row.min_z = std::min(row.min_z, b.min_z[i]), row.max_z = std::max(row.max_z, b.max_z[i]);
  }
  for (std::uint32_t c = columns_ - 1; c-- > 0;)
    column_min_x_[c] = std::min(column_min_x_[c], column_min_x_[c + 1]);
  for (std::uint32_t c = 1; c < columns_; ++c)
    column_max_x_[c] = std::max(column_max_x_[c], column_max_x_[c - 1]);
  // Empty columns at either end borrow a finite bound: an infinite one times a zero normal is no number.
  for (std::uint32_t c = 0; c < columns_; ++c) {
    if (column_min_x_[c] == kInfinity) column_min_x_[c] = column_max_x_[c];
    if (column_max_x_[c] == -kInfinity) column_max_x_[c] = column_min_x_[c];
  }
}

Box ObjectGrid::cell_bounds(std::uint32_t r, std::uint32_t column) const noexcept {
  const Row& row = row_[r];
  return {{column_min_x_[column], row.min_y, row.min_z}, {column_max_x_[column], row.max_y, row.max_z}};
}

bool ObjectGrid::is_empty(std::uint32_t row, std::uint32_t column) const noexcept {
  const auto [begin, end] = slots(row, column, column + 1);
  return begin == end;
}

std::pair<std::uint32_t, std::uint32_t> ObjectGrid::cell_at(float x, float z) const noexcept {
  return {along_.of(z), across_.of(x)};
}

Box ObjectGrid::cell_ground(std::uint32_t row, std::uint32_t column) const noexcept {
  const float x = across_.origin + static_cast<float>(column) * across_.cell;
  const float z = along_.origin + static_cast<float>(row) * along_.cell;
  return {{x, 0, z}, {x + across_.cell, 0, z + along_.cell}};
}

std::pair<std::uint32_t, std::uint32_t> ObjectGrid::slots(std::uint32_t row, std::uint32_t first,
                                                          std::uint32_t last) const noexcept {
  return {cell_start_[row * columns_ + first], cell_start_[row * columns_ + last]};
}

std::pair<std::uint32_t, std::uint32_t> ObjectGrid::oversize_slots() const noexcept {
  return {cell_start_[rows_ * columns_], cell_start_[rows_ * columns_ + 1]};
}

std::uint32_t ObjectGrid::classify(const Frustum& frustum, std::vector<Run>& runs) const {
  for (std::uint32_t r = 0; r < rows_; ++r) {
    if (!(row_[r].min_y <= row_[r].max_y)) continue;  // nothing stands in this row
    const Row& row = row_[r];
    // [touch_first, touch_last): p-vertex inside every plane; [cover_first, cover_last): n-vertex as well.
    std::uint32_t touch_first = 0, touch_last = columns_, cover_first = 0, cover_last = columns_;
    for (const Plane& plane : frustum.planes) {
      const bool right = plane.normal.x >= 0, up = plane.normal.y >= 0, back = plane.normal.z >= 0;
      const auto narrow = [&](const std::vector<float>& x, float y, float z, std::uint32_t& first,
                              std::uint32_t& last) {
        const auto inside = [&](float at) { return signed_distance(plane, at, y, z) >= 0; };
        const auto begin = x.begin() + first, end = x.begin() + std::max(first, last);
        if (right) {  // the distance grows with the column
          first = static_cast<std::uint32_t>(
              std::partition_point(begin, end, [&](float at) { return !inside(at); }) - x.begin());
        } else {
          last = static_cast<std::uint32_t>(std::partition_point(begin, end, inside) - x.begin());
        }
      };
      narrow(right ? column_max_x_ : column_min_x_, up ? row.max_y : row.min_y, back ? row.max_z : row.min_z,
             touch_first, touch_last);
      if (touch_first >= touch_last) break;
      narrow(right ? column_min_x_ : column_max_x_, up ? row.min_y : row.max_y, back ? row.min_z : row.max_z,
             cover_first, cover_last);
    }
    if (touch_first >= touch_last) continue;
    cover_first = std::clamp(cover_first, touch_first, touch_last);
    cover_last = std::clamp(cover_last, cover_first, touch_last);
    if (cover_first > touch_first) runs.push_back({r, touch_first, cover_first, Overlap::crossing});
    if (cover_last > cover_first) runs.push_back({r, cover_first, cover_last, Overlap::inside});
    if (touch_last > cover_last)
      runs.push_back({r, std::max(cover_last, cover_first), touch_last, Overlap::crossing});
  }
  return rows_;
}

}  // namespace sightline::partition
