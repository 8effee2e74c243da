// What a game level's own engine does: the potentially visible set of the eye's leaf, computed by the level's
// compiler, then the view frustum. Approximate: the compiler took undrawn (caulk) faces for walls.
#include <array>
#include <numeric>

#include "culling/draw_list.hpp"
#include "culling/object_bounds.hpp"
#include "methods/methods.hpp"

namespace sightline::methods {

namespace {

class LevelPvsMethod final : public Method {
public:
  LevelPvsMethod(const Scene& scene, const Parameters&)
      : scene_(scene),
        bounds_(culling::Volume::box),
        draw_list_(scene),
        extent_(extent(scene)),
        mask_(scene.size()) {
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
    const Vec3 eye = eye_position(view);
    const std::uint32_t leaf = scene_.level->leaf_at(eye);
    if (leaf != leaf_) scene_.level->potentially_visible(eye, mask_);
    leaf_ = leaf;

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
  std::vector<std::uint8_t> mask_;  // of the leaf the eye was in last
  std::uint32_t leaf_ = kNoObject;
};

}  // namespace

const MethodInfo kLevelPvs{"level-pvs",
                           "the level's compiler (Quake 3)",
                           "the level's own visible set, then the frustum",
                           Guarantee::approximate,
                           "a level's PVS (a .bsp file)",
                           {},
                           [](const Scene& scene) { return scene.level.has_value(); },
                           make<LevelPvsMethod>};

}  // namespace sightline::methods
