#include "workbench/submission/object_bounds.hpp"

#include <algorithm>

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
  std::size_t kept = 0;
  if (volume_ == Volume::box) {
    const BoxSpan all = span_of(boxes_);
    kept = cull_boxes(frustum,
                      {all.min_x + first, all.min_y + first, all.min_z + first, all.max_x + first,
                       all.max_y + first, all.max_z + first, count},
                      out);
  } else {
    kept = cull_spheres(
        frustum, {x_.data() + first, y_.data() + first, z_.data() + first, r_.data() + first, count}, out);
  }
  for (std::size_t i = 0; i < kept; ++i) out[i] = ids_[first + out[i]];
  return kept;
}

Box volume_extent(const Scene& scene) noexcept {
  Box all = extent(scene);
  const float reach = scene.empty() ? 0 : *std::max_element(scene.radius.begin(), scene.radius.end());
  for (float* low : {&all.min.x, &all.min.y, &all.min.z}) *low -= reach;
  for (float* high : {&all.max.x, &all.max.y, &all.max.z}) *high += reach;
  return all;
}

}  // namespace sightline::submission
