// Draws what was baked for the eye's cell ('sightline bake'), then the view frustum. Approximate: the bake
// sampled.
#include <algorithm>
#include <numeric>

#include "culling/draw_list.hpp"
#include "culling/object_bounds.hpp"
#include "methods/methods.hpp"

namespace sightline::methods {

namespace {

class Baked final : public Method {
public:
  Baked(const Scene& scene, const Parameters&)
      : scene_(scene),
        bounds_(culling::Volume::box),
        draw_list_(scene),
        extent_(extent(scene)),
        mask_(scene.size(), 1) {
    std::vector<ObjectId> order(scene.size());
    std::iota(order.begin(), order.end(), ObjectId{0});
    bounds_.assign(scene, order);
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::approximate; }
  void update(std::span<const ObjectId> objects) override {
    for (const ObjectId object : objects) bounds_.refresh(scene_, object);
    extent_ = extent(scene_);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    // Outside all open cells nothing is known, and everything may be seen.
    const std::uint32_t cell = scene_.cells->cell_at(eye_position(view));
    if (cell != cell_) {
      std::fill(mask_.begin(), mask_.end(), std::uint8_t{cell == kNoCell});
      if (cell != kNoCell) {
        for (const ObjectId object : scene_.cells->seen_from(cell)) mask_[object] = 1;
      }
      cell_ = cell;
    }
    frame.visible.resize(scene_.size() + kCullPadding);
    const std::size_t in_view = bounds_.cull(make_frustum(view, extent_), 0, scene_.size(), frame.visible);
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
  const Scene& scene_;
  culling::ObjectBounds bounds_;
  culling::DrawList draw_list_;
  Box extent_;
  std::vector<std::uint8_t> mask_;
  std::uint32_t cell_ = kNoCell;
};

}  // namespace

const MethodInfo kBaked{"baked",
                        "",
                        "the visible set baked for the eye's cell, then the frustum",
                        Guarantee::approximate,
                        "a baked PVS (sightline bake, --pvs FILE)",
                        {},
                        [](const Scene& scene) { return scene.cells != nullptr; },
                        make<Baked>};

}  // namespace sightline::methods
