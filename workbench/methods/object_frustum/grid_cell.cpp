// The engine's own way in Le Hoang Minh et al. 2022, section 2: cells outside the frustum are dropped, all
// objects of the other cells are drawn.
#include <array>

#include "workbench/methods/object_frustum/grid_objects.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kGridCellParameters{kCellParameter, submission::kBoundsParameter};

class GridCell final : public CpuMethod {
public:
  GridCell(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene), objects_(scene, parameters), draw_list_(scene) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::conservative; }
  void do_update(std::span<const ObjectId> moved) override {
    if (!moved.empty()) objects_.rebuild();
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    const partition::ObjectGrid& grid = objects_.grid;
    const Frustum frustum = make_frustum(view);
    for (std::uint32_t row = 0; row < grid.rows(); ++row) {
      for (std::uint32_t column = 0; column < grid.columns(); ++column) {
        const auto [begin, end] = grid.slots(row, column, column + 1);
        if (begin == end) continue;
        ++frame.stats.nodes_visited;
        if (overlaps(frustum, grid.cell_bounds(row, column))) keep(begin, end, frame);
      }
    }
    const auto [begin, end] = grid.oversize_slots();  // too large for a cell: always drawn
    keep(begin, end, frame);
    frame.stats.objects = objects_.scene.size();
    frame.stats.culled_frustum = objects_.scene.size() - frame.visible.size();
    draw_list_.build(objects_.scene, view, frame);
  }

private:
  void keep(std::uint32_t begin, std::uint32_t end, Frame& frame) const noexcept {
    const auto ids = objects_.bounds.ids().subspan(begin, end - begin);
    frame.visible.insert(frame.visible.end(), ids.begin(), ids.end());
  }

  GridObjects objects_;
  submission::DrawList draw_list_;
};

}  // namespace

extern const MethodInfo kGridCell{.name = "grid-cell",
                                  .paper = "C: Le Hoang Minh et al. 2022",
                                  .summary = "whole cells of a ground grid against the frustum",
                                  .cpu = on_cpu<GridCell>(Guarantee::conservative, kGridCellParameters)};

}  // namespace sightline::methods
