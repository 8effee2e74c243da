#include "workbench/methods/ray_pvs/nearest_box.hpp"

#include <limits>

namespace sightline::methods {

using rays::Bvh;
using rays::BvhNode;

namespace {

struct Nearest {
  float distance = std::numeric_limits<float>::infinity();
  ObjectId object = kNoObject;

  void offer(float t, ObjectId id) {
    if (t < distance || (t == distance && id < object)) distance = t, object = id;
  }
  void store(rays::RayHits& hits, std::size_t ray) const {
    if (object == kNoObject) return;
    hits.object[ray] = object;
    hits.distance[ray] = distance;
    ++hits.stats.hits;
  }
};

// The paper's recursion: a node that the ray meets sends it on to both children.
template <class Visit>
void descend(std::span<const BvhNode> nodes, std::size_t index, const PreparedRay& ray, std::uint64_t& tested,
             const Visit& visit) {
  const BvhNode& node = nodes[index];
  ++tested;
  const float t = intersect(ray, {node.min, node.max});
  if (t < 0) return;
  if (node.object != kNoObject) {
    visit(t, node.object);
    return;
  }
  const std::size_t left = index + 1, right = left + 1 + nodes[left].descendants;
  descend(nodes, left, ray, tested, visit);
  descend(nodes, right, ray, tested, visit);
}

}  // namespace

void cast_at_all_boxes(const Boxes& boxes, std::span<const PreparedRay> rays, rays::RayHits& hits) {
  hits.reset(rays.size());
  const std::size_t count = boxes.size();
  for (std::size_t r = 0; r < rays.size(); ++r) {
    Nearest nearest;
    for (std::size_t i = 0; i < count; ++i) {
      const float t = intersect(rays[r], boxes[i]);
      if (t >= 0) nearest.offer(t, static_cast<ObjectId>(i));
    }
    nearest.store(hits, r);
  }
  hits.stats.boxes = rays.size() * count;
}

void cast_down_bvh(const Bvh& bvh, std::span<const PreparedRay> rays, rays::RayHits& hits) {
  hits.reset(rays.size());
  if (bvh.empty()) return;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    Nearest nearest;
    descend(bvh.nodes(), 0, rays[r], hits.stats.nodes, [&](float t, ObjectId object) {
      nearest.offer(t, object);
      ++hits.stats.boxes;
    });
    nearest.store(hits, r);
  }
}

void cast_by_skip_counts(std::span<const BvhNode> nodes, std::span<const PreparedRay> rays,
                         rays::RayHits& hits) {
  hits.reset(rays.size());
  for (std::size_t r = 0; r < rays.size(); ++r) {
    Nearest nearest;
    for (std::size_t i = 0; i < nodes.size();) {
      const BvhNode& node = nodes[i];
      ++hits.stats.nodes;
      const float t = intersect(rays[r], {node.min, node.max});
      if (t < 0) {
        i += 1 + std::size_t{node.descendants};
        continue;
      }
      if (node.object != kNoObject) {
        nearest.offer(t, node.object);
        ++hits.stats.boxes;
      }
      ++i;
    }
    nearest.store(hits, r);
  }
}

void collect_candidates(const Bvh& bvh, std::span<const PreparedRay> rays, Candidates& candidates) {
  candidates.first.clear();
  candidates.objects.clear();
  candidates.nodes = 0;
  for (const PreparedRay& ray : rays) {
    candidates.first.push_back(static_cast<std::uint32_t>(candidates.objects.size()));
    if (bvh.empty()) continue;
    descend(bvh.nodes(), 0, ray, candidates.nodes,
            [&](float, ObjectId object) { candidates.objects.push_back(object); });
  }
  candidates.first.push_back(static_cast<std::uint32_t>(candidates.objects.size()));
}

void cast_at_candidates(const Boxes& boxes, const Candidates& candidates, std::span<const PreparedRay> rays,
                        rays::RayHits& hits) {
  hits.reset(rays.size());
  hits.stats.nodes = candidates.nodes;
  hits.stats.boxes = candidates.objects.size();
  for (std::size_t r = 0; r < rays.size(); ++r) {
    Nearest nearest;
    for (std::uint32_t c = candidates.first[r]; c < candidates.first[r + 1]; ++c) {
      const ObjectId object = candidates.objects[c];
      const float t = intersect(rays[r], boxes[object]);
      if (t >= 0) nearest.offer(t, object);
    }
    nearest.store(hits, r);
  }
}

}  // namespace sightline::methods
