#include "workbench/measure/mover.hpp"

#include <algorithm>
#include <numeric>

#include "workbench/scene/random.hpp"

namespace sightline::measure {

Mover::Mover(Scene& scene, double share, std::uint64_t seed)
    : scene_(scene),
      count_(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(scene.size()))),
      seed_(seed),
      home_(scene.transform),
      order_(scene.size()) {
  std::iota(order_.begin(), order_.end(), ObjectId{0});
}

std::span<const ObjectId> Mover::move() {
  scene::Random random(seed_++);
  const auto size = static_cast<std::uint32_t>(scene_.size());
  for (std::uint32_t i = 0; i < count_; ++i) {
    std::swap(order_[i], order_[i + random.below(size - i)]);
    const ObjectId object = order_[i];
    Affine transform = home_[object];
    const float reach = std::max(scene_.radius[object], 1e-3f);
    for (Vec4& row : transform.rows) row.w += random.between(-reach, reach);
    scene_.move_object(object, transform);
  }
  return std::span(order_).first(count_);
}

}  // namespace sightline::measure
