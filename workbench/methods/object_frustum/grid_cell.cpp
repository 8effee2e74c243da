// The engine's own way in Le Hoang Minh et al. 2022, section 2: cells outside the frustum are dropped, all
// objects of the other cells are drawn.
#include <array>

#include "workbench/methods/object_frustum/grid_objects.hpp"
#include "workbench/methods/object_frustum/visible_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kGridCellParameters{kCellParameter,
                                         kRowsParameter,
                                         kColumnsParameter,
                                         submission::kBoundsParameter,
                                         submission::kSubmissionParameter,
                                         kLayersParameter};

class GridCell final : public CpuMethod {
public:
  GridCell(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene), objects_(scene, parameters), list_(scene, parameters) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return list_.leaves_out_layers() ? Guarantee::approximate : Guarantee::conservative;
  }
  void do_update(std::span<const ObjectId> moved) override {
    if (!moved.empty()) objects_.rebuild();
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    objects_.take_cells(make_frustum(view), frame);
    list_.keep_layers(frame);
    list_.draw(view, frame);
  }

private:
  GridObjects objects_;
  VisibleList list_;
};

}  // namespace

extern const MethodInfo kGridCell{.name = "grid-cell",
                                  .paper = "C: Le Hoang Minh et al. 2022",
                                  .summary = "whole cells of a ground grid against the frustum",
                                  .cpu = on_cpu<GridCell>(Guarantee::conservative, kGridCellParameters)};

}  // namespace sightline::methods
