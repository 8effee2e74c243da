#include "workbench/methods/object_frustum/grid_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sightline::methods {

namespace {

constexpr float kObjectsPerCell = 64;

float chosen_cell(const Box& all, std::size_t objects) {
  const float area =
      std::max((all.max.x - all.min.x) * (all.max.z - all.min.z), std::numeric_limits<float>::min());
  return std::sqrt(area * kObjectsPerCell / static_cast<float>(objects));
}

}  // namespace

GridObjects::GridObjects(const Scene& of, const Parameters& parameters)
    : scene(of),
      bounds(submission::volume_from(parameters)),
      cell_(static_cast<float>(parameters.number("cell"))),
      counts_{parameters.count("rows"), parameters.count("columns")} {
  rebuild();
}

void GridObjects::take_cells(const Frustum& frustum, Frame& frame) const noexcept {
  frame.visible.resize(scene.size());
  std::size_t kept = 0;
  for (std::uint32_t row = 0; row < grid.rows(); ++row) {
    for (std::uint32_t column = 0; column < grid.columns(); ++column) {
      const auto [begin, end] = grid.slots(row, column, column + 1);
      if (begin == end) continue;
      ++frame.stats.nodes_visited;
      if (overlaps(frustum, grid.cell_bounds(row, column))) kept = take(begin, end, kept, frame);
    }
  }
  const auto [begin, end] = grid.oversize_slots();
  frame.visible.resize(take(begin, end, kept, frame));
}

void GridObjects::test_cells(const Frustum& frustum, std::span<const partition::ObjectGrid::Run> runs,
                             Frame& frame) const noexcept {
  frame.visible.resize(scene.size() + kCullPadding);
  std::size_t kept = 0;
  for (const auto& run : runs) {
    frame.stats.nodes_visited += run.last_column - run.first_column;
    const auto [begin, end] = grid.slots(run.row, run.first_column, run.last_column);
    kept = run.overlap == Overlap::inside ? take(begin, end, kept, frame)
                                          : test(frustum, begin, end, kept, frame);
  }
  const auto [begin, end] = grid.oversize_slots();
  frame.visible.resize(test(frustum, begin, end, kept, frame));
}

std::size_t GridObjects::take(std::uint32_t begin, std::uint32_t end, std::size_t kept,
                              Frame& frame) const noexcept {
  const auto ids = bounds.ids().subspan(begin, end - begin);
  std::copy(ids.begin(), ids.end(), frame.visible.begin() + static_cast<std::ptrdiff_t>(kept));
  return kept + ids.size();
}

std::size_t GridObjects::test(const Frustum& frustum, std::uint32_t begin, std::uint32_t end,
                              std::size_t kept, Frame& frame) const noexcept {
  frame.stats.tested += end - begin;
  return kept + bounds.cull(frustum, begin, end - begin, std::span(frame.visible).subspan(kept));
}

void GridObjects::rebuild() {
  const Box extent = submission::volume_extent(scene);
  std::vector<ObjectId> order(scene.size());
  std::iota(order.begin(), order.end(), ObjectId{0});
  bounds.assign(scene, order);
  // A sphere's box and the sphere itself round differently: a little more room keeps "cell outside" certain.
  const float slack = 4 * std::numeric_limits<float>::epsilon() *
                      std::max({std::fabs(extent.min.x), std::fabs(extent.min.y), std::fabs(extent.min.z),
                                std::fabs(extent.max.x), std::fabs(extent.max.y), std::fabs(extent.max.z)});
  Boxes volumes;
  volumes.resize(scene.size());
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Box b = bounds.box(i);
    volumes.set(i, {{b.min.x - slack, b.min.y - slack, b.min.z - slack},
                    {b.max.x + slack, b.max.y + slack, b.max.z + slack}});
  }
  grid.build(volumes, cell_ > 0 ? cell_ : chosen_cell(extent, scene.size()), counts_);
  bounds.assign(scene, grid.order());
}

}  // namespace sightline::methods
