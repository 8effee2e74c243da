// Object-level frustum culling of Le Hoang Minh et al. 2022, section 3: cells are sorted into those inside
// the frustum (BLi), whose objects are taken whole, and those that cross its border (BLc), whose objects are
// tested.
//
// The paper walks rows near to far and columns left and right on a grid turned to the view. Here each row's
// interval of touched and of covered columns is found by bisection, which gives the same cells for any
// heading.
#include <array>

#include "workbench/methods/object_frustum/grid_objects.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kObjectFrustumParameters{kCellParameter, submission::kBoundsParameter};

class ObjectFrustum final : public CpuMethod {
public:
  ObjectFrustum(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene), objects_(scene, parameters), draw_list_(scene) {
    reserve_runs();
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::conservative; }
  void do_update(std::span<const ObjectId> moved) override {
    if (moved.empty()) return;
    objects_.rebuild();
    reserve_runs();
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    const partition::ObjectGrid& grid = objects_.grid;
    const Frustum frustum = make_frustum(view);
    runs_.clear();
    grid.classify(frustum, runs_);

    frame.visible.resize(objects_.scene.size() + kCullPadding);
    std::size_t kept = 0;
    for (const auto& run : runs_) {
      frame.stats.nodes_visited += run.last_column - run.first_column;
      const auto [begin, end] = grid.slots(run.row, run.first_column, run.last_column);
      kept = run.overlap == Overlap::inside ? take(begin, end, kept, frame)
                                            : test(frustum, begin, end, kept, frame);
    }
    const auto [begin, end] = grid.oversize_slots();
    kept = test(frustum, begin, end, kept, frame);

    frame.visible.resize(kept);
    frame.stats.objects = objects_.scene.size();
    frame.stats.culled_frustum = objects_.scene.size() - kept;
    draw_list_.build(objects_.scene, view, frame);
  }

private:
  void reserve_runs() { runs_.reserve(3 * std::size_t{objects_.grid.rows()}); }

  std::size_t take(std::uint32_t begin, std::uint32_t end, std::size_t kept, Frame& frame) const noexcept {
    const auto ids = objects_.bounds.ids().subspan(begin, end - begin);
    std::copy(ids.begin(), ids.end(), frame.visible.begin() + static_cast<std::ptrdiff_t>(kept));
    return kept + ids.size();
  }

  std::size_t test(const Frustum& frustum, std::uint32_t begin, std::uint32_t end, std::size_t kept,
                   Frame& frame) const noexcept {
    frame.stats.tested += end - begin;
    return kept + objects_.bounds.cull(frustum, begin, end - begin, std::span(frame.visible).subspan(kept));
  }

  GridObjects objects_;
  std::vector<partition::ObjectGrid::Run> runs_;
  submission::DrawList draw_list_;
};

}  // namespace

extern const MethodInfo kObjectFrustum{
    .name = "object-frustum",
    .paper = "C: Le Hoang Minh et al. 2022",
    .summary = "cells inside the frustum whole, objects of crossing cells one by one",
    .cpu = on_cpu<ObjectFrustum>(Guarantee::conservative, kObjectFrustumParameters)};

}  // namespace sightline::methods
