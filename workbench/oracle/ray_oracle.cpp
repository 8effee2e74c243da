// The oracle of rays.
#include <algorithm>
#include <optional>
#include <vector>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/oracle.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline::oracle {

namespace {

class RayOracle final : public Oracle {
public:
  RayOracle(const Scene& scene, std::uint32_t samples)
      : scene_(scene), samples_(samples), objects_(scene), triangles_(scene) {}

  const ItemBuffer& look(const View& view) override { return truths(view).front(); }

  Judgement judge(const View& view, const Answer& answer) override {
    if (answer.geometry) {
      TriangleJudge::Verdict found = triangles_->judge(view, *answer.geometry, answer.frame);
      return {std::move(found.loss), found.truly_visible};
    }
    Judgement out;
    std::vector<std::uint8_t> sees(scene_.size(), 0), lost(scene_.size(), 0);
    for (const ItemBuffer& truth : truths(view)) {
      const Loss loss = confirmed_loss(objects_, view, truth, answer.frame.visible);
      out.loss.lost_pixels += loss.lost_pixels;
      for (const ObjectId object : loss.lost) lost[object] = 1;
      for (ObjectId object = 0; object < scene_.size(); ++object) sees[object] |= truth.sees(object);
    }
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      out.truly_visible += sees[object];
      if (lost[object]) out.loss.lost.push_back(object);
    }
    for (const ObjectId object : answer.frame.visible) {
      if (!sees[object]) out.loss.excess.push_back(object);
    }
    std::ranges::sort(out.loss.excess);
    return out;
  }

  void update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    objects_.move(objects);
    triangles_.emplace(scene_);
    seen_.reset();
  }

private:
  // One of pixel centres, or one a sample.
  const std::vector<ItemBuffer>& truths(const View& view) {
    if (seen_ != view) {
      truths_.clear();
      if (samples_ == 0) truths_.push_back(objects_.render(view));
      for (std::uint32_t sample = 1; sample <= samples_; ++sample)
        truths_.push_back(objects_.render(view, sample));
      seen_ = view;
    }
    return truths_;
  }

  const Scene& scene_;
  std::uint32_t samples_;
  EmbreeJudge objects_;
  std::optional<TriangleJudge> triangles_;
  std::optional<View> seen_;  ///< what `truths_` are of
  std::vector<ItemBuffer> truths_;
};

}  // namespace

std::unique_ptr<Oracle> make_ray_oracle(const Scene& scene, std::uint32_t samples) {
  return std::make_unique<RayOracle>(scene, samples);
}

}  // namespace sightline::oracle
