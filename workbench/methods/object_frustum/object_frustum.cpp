// Object-level frustum culling of Le Hoang Minh et al. 2022, section 3: cells are sorted into those inside
// the frustum (BLi), whose objects are taken whole, and those that cross its border (BLc), whose objects are
// tested.
//
// The paper walks rows near to far and columns left and right on a grid turned to the view. Here each row's
// interval of touched and of covered columns is found by bisection, which gives the same cells for any
// heading; the walk as printed, which drops too much, is there to be compared with. Its list can go on to
// occlusion, which the paper names as its future work.
#include <array>
#include <optional>

#include "workbench/methods/object_frustum/grid_objects.hpp"
#include "workbench/methods/object_frustum/printed_walk.hpp"
#include "workbench/methods/object_frustum/visible_list.hpp"
#include "workbench/methods/raster_occlusion/scene_occluders.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kObjectFrustumParameters{
    kCellParameter,
    kRowsParameter,
    kColumnsParameter,
    submission::kBoundsParameter,
    submission::kSubmissionParameter,
    kLayersParameter,
    ParameterInfo{
        "walk",
        "how cells are sorted: by intervals of every row, or by the paper's steps as printed, which "
        "lose objects",
        "repaired", 0, 0, false, "repaired|printed"},
    ParameterInfo{"occlusion", "what is in view goes through occlusion on the CPU, too, as in masked", "off",
                  0, 0, false, "off|masked"}};

class ObjectFrustum final : public CpuMethod {
public:
  ObjectFrustum(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene),
        objects_(scene, parameters),
        printed_(parameters.word("walk") == "printed"),
        list_(scene, parameters) {
    if (parameters.word("occlusion") == "masked") occluders_.emplace(scene);
    reserve_runs();
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return printed_ || list_.leaves_out_layers() ? Guarantee::approximate : Guarantee::conservative;
  }
  [[nodiscard]] Coverage coverage() const noexcept override {
    return occluders_ ? Coverage::centres : Coverage::area;
  }
  void do_update(std::span<const ObjectId> moved) override {
    if (moved.empty()) return;
    objects_.rebuild();
    reserve_runs();
    if (occluders_) occluders_->update(moved);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    const Frustum frustum = make_frustum(view);
    runs_.clear();
    if (printed_) {
      walk_as_printed(objects_.grid, view, frustum, runs_);
    } else {
      objects_.grid.classify(frustum, runs_);
    }
    objects_.test_cells(frustum, runs_, frame);
    list_.keep_layers(frame);
    if (occluders_) keep_unhidden(view, frame);
    list_.draw(view, frame);
  }

private:
  // Each row's runs by bisection are three at most; the printed walk lists cell by cell.
  void reserve_runs() {
    const std::size_t rows = objects_.grid.rows(), columns = objects_.grid.columns();
    runs_.reserve(printed_ ? rows * columns : 3 * rows);
  }

  // One object has nothing to hide behind; a view or scene beyond what the buffer takes hides nothing.
  void keep_unhidden(const View& view, Frame& frame) {
    const std::size_t in_view = frame.visible.size();
    if (in_view < 2 || !occluders_->usable() || !occluders_->draw({view, {}}, frame.visible)) return;
    frame.visible.resize(occluders_->keep_unhidden(frame.visible));
    frame.stats.culled_occlusion = in_view - frame.visible.size();
  }

  GridObjects objects_;
  std::vector<partition::ObjectGrid::Run> runs_;
  bool printed_;
  VisibleList list_;
  std::optional<SceneOccluders> occluders_;
};

}  // namespace

extern const MethodInfo kObjectFrustum{
    .name = "object-frustum",
    .paper = "C: Le Hoang Minh et al. 2022",
    .summary = "cells inside the frustum whole, objects of crossing cells one by one",
    .cpu = on_cpu<ObjectFrustum>(Guarantee::conservative, kObjectFrustumParameters)};

}  // namespace sightline::methods
