// VFC+VC of Lee & Shin 2023, section 4, on the CPU: each object's bounding volume against the six planes,
// then contribution culling of what is left.
#include <array>
#include <numeric>

#include "workbench/methods/methods.hpp"
#include "workbench/submission/contribution.hpp"
#include "workbench/submission/draw_list.hpp"
#include "workbench/submission/object_bounds.hpp"

namespace sightline::methods {

namespace {

using submission::Contribution;

constexpr std::array kParameters{
    submission::kBoundsParameter,
    submission::kContributionParameter,
    submission::kThresholdParameter,
};

class VfcVc final : public Method {
public:
  VfcVc(const Scene& scene, const Parameters& parameters)
      : scene_(scene),
        contribution_(submission::contribution_from(parameters)),
        bounds_(submission::volume_from(parameters)),
        draw_list_(scene),
        extent_(submission::volume_extent(scene)) {
    std::vector<ObjectId> order(scene.size());
    std::iota(order.begin(), order.end(), ObjectId{0});
    bounds_.assign(scene, order);
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return contribution_.test == Contribution::Test::area ? Guarantee::approximate : Guarantee::conservative;
  }

  void update(std::span<const ObjectId> objects) override {
    for (const ObjectId object : objects) bounds_.refresh(scene_, object);
    extent_ = submission::volume_extent(scene_);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    CullStats& stats = frame.stats;
    stats.objects = stats.tested = stats.cull_vertices = scene_.size();
    frame.visible.resize(scene_.size() + kCullPadding);

    const std::size_t in_view = bounds_.cull(make_frustum(view, extent_), 0, scene_.size(), frame.visible);
    stats.culled_frustum = scene_.size() - in_view;
    const std::size_t kept =
        contribution_.filter(scene_, make_projector(view, extent_), std::span(frame.visible).first(in_view));
    stats.culled_contribution = in_view - kept;

    frame.visible.resize(kept);
    draw_list_.build(scene_, view, frame);
  }

private:
  const Scene& scene_;
  Contribution contribution_;
  submission::ObjectBounds bounds_;
  submission::DrawList draw_list_;
  Box extent_;
};

}  // namespace

const MethodInfo kVfcVc{"vfc-vc",
                        "A: Lee & Shin 2023",
                        "every object against the view frustum, then contribution",
                        Guarantee::conservative,
                        "",
                        kParameters,
                        fits_any_scene,
                        make<VfcVc>};

}  // namespace sightline::methods
