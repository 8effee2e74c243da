#include "workbench/methods/raster_occlusion/box_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace sightline::methods {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Box kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

Box unite(const Box& a, const Box& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

float centre(const Box& box, int axis) {
  const auto middle = [](float low, float high) { return 0.5f * low + 0.5f * high; };
  return axis == 0   ? middle(box.min.x, box.max.x)
         : axis == 1 ? middle(box.min.y, box.max.y)
                     : middle(box.min.z, box.max.z);
}

int longest_axis(const Boxes& boxes, std::span<const ObjectId> objects) {
  std::array<float, 3> low, high;
  low.fill(kInfinity);
  high.fill(-kInfinity);
  for (const ObjectId object : objects) {
    for (int axis = 0; axis < 3; ++axis) {
      const float c = centre(boxes[object], axis);
      low[axis] = std::min(low[axis], c);
      high[axis] = std::max(high[axis], c);
    }
  }
  int best = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (high[axis] - low[axis] > high[best] - low[best]) best = axis;
  }
  return best;
}

}  // namespace

BoxTree::BoxTree(const Scene& scene) {
  const auto count = static_cast<std::uint32_t>(scene.size());
  std::vector<ObjectId> order(count);
  std::iota(order.begin(), order.end(), ObjectId{0});
  // Breadth first, so that a parent's number is below its children's.
  struct Work {
    std::uint32_t first, count, parent, depth;
  };
  std::vector<Work> queue{{0, count, kNone, 1}};
  std::vector<std::uint32_t> parent_of_node;
  std::vector<std::uint32_t> object_parent(count, kNone);
  std::vector<std::vector<std::uint32_t>> children;
  for (std::size_t at = 0; at < queue.size(); ++at) {
    const Work work = queue[at];
    const auto node = static_cast<std::uint32_t>(at);
    parent_of_node.push_back(work.parent);
    depth_.push_back(work.depth);
    children.emplace_back();
    levels_ = std::max(levels_, work.depth + 1);
    if (work.parent != kNone) children[work.parent].push_back(node);
    if (work.count <= kWidth) {
      for (std::uint32_t i = 0; i < work.count; ++i) object_parent[order[work.first + i]] = node;
      continue;
    }
    std::vector<Work> parts{{work.first, work.count, node, work.depth + 1}};
    for (int halving = 0; halving < 3; ++halving) {
      std::vector<Work> halves;
      for (const Work& part : parts) {
        const auto objects = std::span(order).subspan(part.first, part.count);
        const std::uint32_t left = part.count / 2;
        const int axis = longest_axis(scene.bounds, objects);
        std::ranges::nth_element(objects, objects.begin() + left, [&](ObjectId a, ObjectId b) {
          const float ca = centre(scene.bounds[a], axis), cb = centre(scene.bounds[b], axis);
          return ca != cb ? ca < cb : a < b;
        });
        if (left > 0) halves.push_back({part.first, left, node, part.depth});
        halves.push_back({part.first + left, part.count - left, node, part.depth});
      }
      parts = std::move(halves);
    }
    queue.insert(queue.end(), parts.begin(), parts.end());
  }

  const auto interior_count = static_cast<std::uint32_t>(queue.size());
  parents_ = std::move(parent_of_node);
  parents_.insert(parents_.end(), object_parent.begin(), object_parent.end());
  for (ObjectId object = 0; object < count; ++object)
    children[object_parent[object]].push_back(interior_count + object);
  nodes_.reserve(interior_count);
  for (const auto& list : children) {
    nodes_.push_back({static_cast<std::uint32_t>(children_.size()), static_cast<std::uint32_t>(list.size())});
    children_.insert(children_.end(), list.begin(), list.end());
  }
  boxes_.resize(interior_count + count);
  for (ObjectId object = 0; object < count; ++object) boxes_[interior_count + object] = scene.bounds[object];
  for (std::uint32_t node = interior_count; node-- > 0;) boxes_[node] = children_box(node);
}

Box BoxTree::children_box(std::uint32_t node) const noexcept {
  Box box = kNothing;
  for (std::uint32_t c = 0; c < nodes_[node].child_count; ++c)
    box = unite(box, boxes_[children_[nodes_[node].first_child + c]]);
  return box;
}

void BoxTree::refit(const Scene& scene, std::span<const ObjectId> moved,
                    std::vector<std::uint32_t>& changed) {
  changed.clear();
  std::vector<std::uint32_t> above;
  for (const ObjectId object : moved) {
    const std::uint32_t leaf = interior() + object;
    boxes_[leaf] = scene.bounds[object];
    changed.push_back(leaf);
    above.push_back(parents_[leaf]);
  }
  // Level by level upwards, as far as a box is another.
  while (!above.empty()) {
    // Deepest first; a parent's number is below its children's.
    std::ranges::sort(above, std::greater());
    above.erase(std::unique(above.begin(), above.end()), above.end());
    const std::uint32_t deepest = depth_[above.front()];
    std::vector<std::uint32_t> next;
    for (const std::uint32_t node : above) {
      if (depth_[node] != deepest) {
        next.push_back(node);
        continue;
      }
      const Box box = children_box(node);
      if (box == boxes_[node]) continue;
      boxes_[node] = box;
      changed.push_back(node);
      if (parents_[node] != kNone) next.push_back(parents_[node]);
    }
    above = std::move(next);
  }
}

}  // namespace sightline::methods
