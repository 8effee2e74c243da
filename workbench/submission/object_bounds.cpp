#include "workbench/submission/object_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sightline/workbench/error.hpp>

namespace sightline::submission {

Volume volume_from(const Parameters& parameters) noexcept {
  return parameters.word("bounds") == "box" ? Volume::box : Volume::sphere;
}

void ObjectBounds::assign(const Scene& scene, std::span<const ObjectId> order) {
  ids_.assign(order.begin(), order.end());
  if (volume_ == Volume::box) {
    boxes_.resize(order.size());
  } else {
    for (auto* array : {&x_, &y_, &z_, &r_}) array->resize(order.size());
  }
  for (std::size_t slot = 0; slot < order.size(); ++slot) refresh(scene, slot);
}

void ObjectBounds::refresh(const Scene& scene, std::size_t slot) noexcept {
  if (volume_ == Volume::box) {
    boxes_.set(slot, scene.bounds[ids_[slot]]);
    return;
  }
  const Sphere sphere = scene.sphere(ids_[slot]);
  x_[slot] = sphere.centre.x, y_[slot] = sphere.centre.y, z_[slot] = sphere.centre.z,
  r_[slot] = sphere.radius;
}

Box ObjectBounds::box(std::size_t slot) const noexcept {
  if (volume_ == Volume::box) return boxes_[slot];
  const float r = r_[slot];
  return {{x_[slot] - r, y_[slot] - r, z_[slot] - r}, {x_[slot] + r, y_[slot] + r, z_[slot] + r}};
}

std::size_t ObjectBounds::cull(const Frustum& frustum, std::size_t first, std::size_t count,
                               std::span<ObjectId> out) const noexcept {
  const Result<std::size_t> culled =
      volume_ == Volume::box ? cull_boxes(frustum, boxes_.view().part(first, count), out)
                             : cull_spheres(frustum,
                                            SphereView::arrays(x_.data() + first, y_.data() + first,
                                                               z_.data() + first, r_.data() + first, count),
                                            out);
  const std::size_t kept = or_throw(culled);  // refused only where the caller gave too little room
  for (std::size_t i = 0; i < kept; ++i) out[i] = ids_[first + out[i]];
  return kept;
}

Box volume_extent(const Scene& scene) noexcept {
  constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
  Box all = extent(scene);
  const float largest = std::max({std::fabs(all.min.x), std::fabs(all.min.y), std::fabs(all.min.z),
                                  std::fabs(all.max.x), std::fabs(all.max.y), std::fabs(all.max.z)});
  const float radius = scene.empty() ? 0 : *std::max_element(scene.radius.begin(), scene.radius.end());
  const float reach = radius + kRounding * (largest + radius);
  for (float* low : {&all.min.x, &all.min.y, &all.min.z}) *low -= reach;
  for (float* high : {&all.max.x, &all.max.y, &all.max.z}) *high += reach;
  return all;
}

}  // namespace sightline::submission
