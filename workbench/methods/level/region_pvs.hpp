// A visible set per region of space, known beforehand, then the view frustum: what level-pvs and baked share.
#pragma once

#include <numeric>
#include <optional>
#include <vector>

#include "workbench/methods/methods.hpp"
#include "workbench/submission/draw_list.hpp"
#include "workbench/submission/object_bounds.hpp"

namespace sightline::methods {

/// `Regions` is made from a scene; region_at(eye) names the eye's region, and mark(eye, region, mask) writes
/// 1 for each object that may be seen from it and 0 for the rest.
template <class Regions>
class RegionPvs final : public CpuMethod {
public:
  RegionPvs(const Scene& scene, const Parameters&)
      : CpuMethod(scene),
        regions_(scene),
        bounds_(submission::Volume::box),
        draw_list_(scene),
        mask_(scene.size()) {
    std::vector<ObjectId> order(scene.size());
    std::iota(order.begin(), order.end(), ObjectId{0});
    bounds_.assign(scene, order);
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::approximate; }
  void do_update(std::span<const ObjectId> objects) override {
    for (const ObjectId object : objects) bounds_.refresh(scene_, object);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    const Vec3 eye = eye_position(view);
    const std::uint32_t region = regions_.region_at(eye);
    if (region != region_) regions_.mark(eye, region, mask_);
    region_ = region;

    frame.visible.resize(scene_.size() + kCullPadding);
    const std::size_t in_view = bounds_.cull(make_frustum(view), 0, scene_.size(), frame.visible);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < in_view; ++i) {
      const ObjectId id = frame.visible[i];
      frame.visible[kept] = id;
      kept += mask_[id];
    }
    frame.visible.resize(kept);
    frame.stats.objects = frame.stats.tested = scene_.size();
    frame.stats.culled_frustum = scene_.size() - in_view;
    frame.stats.culled_occlusion = in_view - kept;
    draw_list_.build(scene_, view, frame);
  }

private:
  Regions regions_;
  submission::ObjectBounds bounds_;
  submission::DrawList draw_list_;
  std::vector<std::uint8_t> mask_;  // of the region the eye was in last
  std::optional<std::uint32_t> region_;
};

}  // namespace sightline::methods
