// The oracle of rays.
#include <optional>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/oracle.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline::oracle {

namespace {

class RayOracle final : public Oracle {
public:
  explicit RayOracle(const Scene& scene) : scene_(scene), objects_(scene), triangles_(scene) {}

  const ItemBuffer& look(const View& view) override {
    if (seen_ != view) {
      truth_ = objects_.render(view);
      seen_ = view;
    }
    return truth_;
  }

  Judgement judge(const View& view, const Answer& answer) override {
    if (answer.geometry) {
      TriangleJudge::Verdict found = triangles_->judge(view, *answer.geometry, answer.frame);
      return {std::move(found.loss), found.truly_visible};
    }
    const ItemBuffer& truth = look(view);
    return {confirmed_loss(objects_, view, truth, answer.frame.visible), truth.visible_count()};
  }

  void update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    objects_.move(objects);
    triangles_.emplace(scene_);
    seen_.reset();
  }

private:
  const Scene& scene_;
  EmbreeJudge objects_;
  std::optional<TriangleJudge> triangles_;
  std::optional<View> seen_;  ///< what `truth_` is of
  ItemBuffer truth_;
};

}  // namespace

std::unique_ptr<Oracle> make_ray_oracle(const Scene& scene) {
  return std::make_unique<RayOracle>(scene);
}

}  // namespace sightline::oracle
