#include "workbench/methods/ray_pvs/ray_targets.hpp"

#include <limits>

namespace sightline::methods {

RayTargets::RayTargets(const Scene& scene) : scene_(scene) {
  for (ObjectId object = 0; object < scene.size(); ++object)
    (scene.surface[object] == Surface::opaque ? solid_ids_ : see_through_ids_).push_back(object);
  if (!mixed()) return;
  solid_.resize(solid_ids_.size());
  boxes_.resize(see_through_ids_.size());
  update();
}

void RayTargets::update() {
  if (!mixed()) return;
  for (std::size_t i = 0; i < solid_ids_.size(); ++i) solid_.set(i, scene_.bounds[solid_ids_[i]]);
  for (std::size_t i = 0; i < see_through_ids_.size(); ++i) boxes_.set(i, scene_.bounds[see_through_ids_[i]]);
  if (bvh_.empty()) {
    bvh_.build(boxes_);
  } else {
    bvh_.refit(boxes_);
  }
  nodes_.assign(bvh_.nodes().begin(), bvh_.nodes().end());
  for (rays::BvhNode& node : nodes_) {
    if (node.object != kNoObject) node.object = see_through_ids_[node.object];
  }
}

void RayTargets::look_through(const PreparedRay& ray, float limit, std::vector<std::uint8_t>& seen) const {
  for (std::size_t i = 0; i < nodes_.size();) {
    const rays::BvhNode& node = nodes_[i];
    const float t = intersect(ray, {node.min, node.max});
    if (t < 0 || t > limit) {
      i += 1 + std::size_t{node.descendants};
      continue;
    }
    if (node.object != kNoObject) seen[node.object] = 1;
    ++i;
  }
}

void RayTargets::collect(std::span<const PreparedRay> rays, rays::RayHits& hits,
                         std::vector<std::uint8_t>& seen, std::vector<ObjectId>& visible) const {
  if (!mixed()) {
    collect_visible(hits, scene_.size(), seen, visible);
    return;
  }
  seen.assign(scene_.size(), 0);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    float limit = std::numeric_limits<float>::infinity();
    if (hits.object[r] != kNoObject) {
      limit = hits.distance[r];
      hits.object[r] = solid_ids_[hits.object[r]];
      seen[hits.object[r]] = 1;
    }
    look_through(rays[r], limit, seen);
  }
  visible.clear();
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    if (seen[object]) visible.push_back(object);
  }
}

}  // namespace sightline::methods
