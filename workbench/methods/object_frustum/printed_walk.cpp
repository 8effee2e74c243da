#include "workbench/methods/object_frustum/printed_walk.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::methods {

namespace {

using partition::ObjectGrid;

class PrintedWalk {
public:
  PrintedWalk(const ObjectGrid& grid, const View& view, const Frustum& frustum,
              std::vector<ObjectGrid::Run>& runs)
      : grid_(grid), frustum_(frustum), runs_(runs) {
    const Vec3 way = view_direction(view), eye = eye_position(view);
    const auto [eye_row, eye_column] = grid.cell_at(eye.x, eye.z);
    along_z_ = std::fabs(way.z) >= std::fabs(way.x);
    ahead_ = (along_z_ ? way.z : way.x) < 0 ? -1 : 1;
    lines_ = along_z_ ? grid.rows() : grid.columns(), across_ = along_z_ ? grid.columns() : grid.rows();
    first_line_ = along_z_ ? eye_row : eye_column, straight_ = along_z_ ? eye_column : eye_row;
  }

  void walk() {
    const std::int64_t right = along_z_ ? -ahead_ : ahead_;
    for (std::int64_t line = first_line_; line >= 0 && line < lines_; line += ahead_) {
      // The column straight ahead gets no test but this.
      const Overlap distance = to_limit(line, straight_, Frustum::back);
      if (distance == Overlap::outside) break;
      list(line, straight_, distance);
      sweep(line, -right, Frustum::left);
      sweep(line, right, Frustum::right);
      if (distance == Overlap::crossing) break;
    }
  }

private:
  void sweep(std::int64_t line, std::int64_t step, Frustum::Side limit) {
    for (std::int64_t place = straight_ + step; place >= 0 && place < across_; place += step) {
      if (to_limit(line, place, limit) != Overlap::crossing) break;
      list(line, place, Overlap::crossing);
    }
  }

  void list(std::int64_t line, std::int64_t place, Overlap overlap) {
    const auto [row, column] = cell(line, place);
    if (!grid_.is_empty(row, column)) runs_.push_back({row, column, column + 1, overlap});
  }

  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> cell(std::int64_t line, std::int64_t place) const {
    const auto l = static_cast<std::uint32_t>(line), p = static_cast<std::uint32_t>(place);
    return along_z_ ? std::pair{l, p} : std::pair{p, l};
  }

  // How a cell lies to one limit, by its nearest and its farthest corner.
  [[nodiscard]] Overlap to_limit(std::int64_t line, std::int64_t place, Frustum::Side side) const {
    const auto [row, column] = cell(line, place);
    Box box = grid_.cell_bounds(row, column);
    if (!(box.min.y <= box.max.y)) box = grid_.cell_ground(row, column);  // nothing stands in this row
    const Plane& limit = frustum_.planes[side];
    float low = INFINITY, high = -INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const float d = signed_distance(limit, corner & 1 ? box.max.x : box.min.x,
                                      corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z);
      low = std::min(low, d), high = std::max(high, d);
    }
    return low >= 0 ? Overlap::inside : high >= 0 ? Overlap::crossing : Overlap::outside;
  }

  const ObjectGrid& grid_;
  const Frustum& frustum_;
  std::vector<ObjectGrid::Run>& runs_;
  bool along_z_ = true;
  std::int64_t ahead_ = 1, lines_ = 0, across_ = 0, first_line_ = 0, straight_ = 0;
};

}  // namespace

void walk_as_printed(const ObjectGrid& grid, const View& view, const Frustum& frustum,
                     std::vector<ObjectGrid::Run>& runs) {
  PrintedWalk(grid, view, frustum, runs).walk();
}

}  // namespace sightline::methods
