// The paper's figures 4 and 6: which cells both walks list over the grids that it draws.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <sightline/workbench/error.hpp>

#include "workbench/measure/bench.hpp"
#include "workbench/methods/object_frustum/printed_walk.hpp"
#include "workbench/reproduce/object_frustum.hpp"
#include "workbench/reproduce/object_frustum_walks.hpp"

namespace sightline::reproduce {

namespace {

constexpr float kFigureCell = 100;
// Small things near the corners of every cell fill it, so that its tight bounds are nearly the whole of it.
constexpr float kCornerInset = 5, kCornerSize = 0.5f;
// Wide enough that, as the paper draws it, row 1 lies across the limits three cells wide and row 3 is wholly
// in sight but for its ends.
constexpr float kTangent = 1.1f;

partition::ObjectGrid grid_of(const WalkFigure& figure) {
  Boxes boxes;
  for (std::uint32_t row = 0; row < figure.rows; ++row) {
    for (std::uint32_t column = 0; column < figure.columns; ++column) {
      const float x = static_cast<float>(column) * kFigureCell,
                  z = -static_cast<float>(figure.rows - row) * kFigureCell;
      for (const auto& [dx, dz] : {std::pair{kCornerInset, kCornerInset},
                                   {kFigureCell - kCornerInset, kCornerInset},
                                   {kCornerInset, kFigureCell - kCornerInset},
                                   {kFigureCell - kCornerInset, kFigureCell - kCornerInset}}) {
        boxes.push_back({{x + dx - kCornerSize, -kCornerSize, z + dz - kCornerSize},
                         {x + dx + kCornerSize, kCornerSize, z + dz + kCornerSize}});
      }
    }
  }
  partition::ObjectGrid grid;
  grid.build(boxes, kFigureCell, {figure.rows, figure.columns});
  return grid;
}

CellLists lists_of(const partition::ObjectGrid& grid, const std::vector<partition::ObjectGrid::Run>& runs) {
  CellLists lists;
  for (const auto& run : runs) {
    for (std::uint32_t column = run.first_column; column < run.last_column; ++column) {
      (run.overlap == Overlap::inside ? lists.inside : lists.crossing)
          .emplace_back(grid.rows() - run.row, column + 1);
    }
  }
  std::ranges::sort(lists.inside);
  std::ranges::sort(lists.crossing);
  return lists;
}

WalkFigure walked(std::uint32_t rows, std::uint32_t columns, float sight_limit) {
  WalkFigure figure{rows, columns, sight_limit, {}, {}};
  const partition::ObjectGrid grid = grid_of(figure);
  const View view = or_throw(make_view(walk_camera(figure), 800, 800));
  const Frustum frustum = make_frustum(view);
  std::vector<partition::ObjectGrid::Run> runs;
  grid.classify(frustum, runs);
  figure.repaired = lists_of(grid, runs);
  runs.clear();
  methods::walk_as_printed(grid, view, frustum, runs);
  figure.printed = lists_of(grid, runs);
  return figure;
}

std::vector<ObjectId> in_order(std::vector<ObjectId> objects) {
  std::ranges::sort(objects);
  return objects;
}

}  // namespace

std::size_t missing_of(const std::vector<ObjectId>& all, const std::vector<ObjectId>& some) {
  std::vector<ObjectId> missing;
  std::ranges::set_difference(in_order(all), in_order(some), std::back_inserter(missing));
  return missing.size();
}

std::vector<WalkLoss> measure_walk_losses(Scene& scene, std::uint32_t width, std::uint32_t height) {
  const std::string repaired = "object-frustum?rows=6&columns=7";
  measure::Bench bench(scene, std::vector<std::string>{repaired, repaired + "&walk=printed"});
  std::vector<WalkLoss> out;
  for (const float over : {0.0f, 10.0f, 30.0f, 60.0f}) {
    Camera camera = object_frustum_camera(scene);
    camera.eye.y += over;
    const View view = or_throw(make_view(camera, width, height));
    std::array<oracle::Loss, 2> losses;
    for (std::size_t walk = 0; walk < 2; ++walk) {
      bench.run(bench.subjects()[walk], view);
      losses[walk] = bench.judge(bench.subjects()[walk], view).loss;
    }
    const std::vector<ObjectId>&all = bench.subjects()[0].frame.visible,
          &some = bench.subjects()[1].frame.visible;
    out.push_back({kEyeHeight + over, all.size(), some.size(), missing_of(all, some), losses[1].lost.size(),
                   losses[1].lost_pixels, losses[0].lost.size()});
  }
  return out;
}

Camera walk_camera(const WalkFigure& figure) {
  Camera camera;
  camera.eye = {0.5f * static_cast<float>(figure.columns) * kFigureCell, 0, 0};
  camera.vertical_fov = 2 * std::atan(kTangent);
  camera.far_plane = figure.sight_limit;
  return camera;
}

std::vector<DrawnCell> walk_cells(const WalkFigure& figure, const CellLists& lists) {
  const partition::ObjectGrid grid = grid_of(figure);
  const auto in = [](const std::vector<NumberedCell>& list, const NumberedCell& cell) {
    return std::ranges::binary_search(list, cell);
  };
  std::vector<DrawnCell> cells;
  for (std::uint32_t row = 0; row < grid.rows(); ++row) {
    for (std::uint32_t column = 0; column < grid.columns(); ++column) {
      const NumberedCell cell{grid.rows() - row, column + 1};
      const bool in_sight = in(figure.repaired.inside, cell) || in(figure.repaired.crossing, cell);
      const auto kind = in(lists.inside, cell)     ? DrawnCell::Kind::inside
                        : in(lists.crossing, cell) ? DrawnCell::Kind::crossing
                        : in_sight                 ? DrawnCell::Kind::lost
                                                   : DrawnCell::Kind::outside;
      const float x = static_cast<float>(column) * kFigureCell,
                  z = -static_cast<float>(cell.first) * kFigureCell;
      cells.push_back(
          {{{x, 0, z}, {x + kFigureCell, 0, z + kFigureCell}}, cell_number(grid, row, column), kind});
    }
  }
  return cells;
}

WalkFigure walk_figure_4() {
  return walked(4, 5, 250);
}

WalkFigure walk_figure_6() {
  return walked(6, 7, 450);
}

}  // namespace sightline::reproduce
