// Draws every object: what all other methods are measured against.
#include <numeric>

#include "workbench/methods/methods.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

class None final : public Method {
public:
  None(const Scene& scene, const Parameters&) : scene_(scene), draw_list_(scene) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void update(std::span<const ObjectId>) override {}

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    frame.visible.resize(scene_.size());
    std::iota(frame.visible.begin(), frame.visible.end(), ObjectId{0});
    frame.stats.objects = scene_.size();
    draw_list_.build(scene_, view, frame);
  }

private:
  const Scene& scene_;
  submission::DrawList draw_list_;
};

}  // namespace

const MethodInfo kNone{"none", "", "draws every object", Guarantee::exact,
                       "",     {}, fits_any_scene,       make<None>};

}  // namespace sightline::methods
