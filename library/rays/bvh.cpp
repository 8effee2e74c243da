#include "library/rays/bvh.hpp"

#include <algorithm>
#include <numeric>

#include "library/geometry/box_math.hpp"
#include "library/geometry/mutant.h"

namespace sightline::rays {

using namespace geometry;

namespace {

BvhNode bounds_of(const Boxes& boxes, std::span<const ObjectId> objects) {
  Box bounds = boxes[objects[0]];
  for (const ObjectId object : objects.subspan(1)) bounds = united(bounds, boxes[object]);
  return {bounds.min, 0, bounds.max, kNoObject};
}

}  // namespace

void Bvh::build(const Boxes& boxes) {
  nodes_.clear();
  if (boxes.size() == 0) return;
  nodes_.reserve(2 * boxes.size() - 1);
  std::vector<ObjectId> objects(boxes.size());
  std::iota(objects.begin(), objects.end(), ObjectId{0});
  build(boxes, objects);
}

// Deep at most as floats can be halved on three axes, and then as the logarithm of what lies in one place.
void Bvh::build(const Boxes& boxes, std::span<ObjectId> objects) {
  const std::size_t index = nodes_.size();
  nodes_.push_back(rays::bounds_of(boxes, objects));
  if (objects.size() == 1) {
    nodes_[index].object = objects[0];
    return;
  }
  const BvhNode& node = nodes_[index];
  const Vec3 size{0.5f * node.max.x - 0.5f * node.min.x, 0.5f * node.max.y - 0.5f * node.min.y,
                  0.5f * node.max.z - 0.5f * node.min.z};
  const std::uint32_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float middle = 0.5f * coordinate(node.min, axis) + 0.5f * coordinate(node.max, axis);
  const auto centre = [&](ObjectId object) {
    const Box box = boxes[object];
    return 0.5f * coordinate(box.min, axis) + 0.5f * coordinate(box.max, axis);
  };
  auto split = std::partition(objects.begin(), objects.end(),
                              [&](ObjectId object) { return centre(object) < middle; });
  if (split == objects.begin() || split == objects.end()) {
    split = objects.begin() + static_cast<std::ptrdiff_t>(objects.size() / 2);
    std::nth_element(objects.begin(), split, objects.end(), [&](ObjectId a, ObjectId b) {
      const float at = centre(a), bt = centre(b);
      return at != bt ? at < bt : a < b;
    });
  }
  const auto left = static_cast<std::size_t>(split - objects.begin());
  build(boxes, objects.first(left));
  build(boxes, objects.subspan(left));
  nodes_[index].descendants = static_cast<std::uint32_t>(nodes_.size() - 1 - index);
}

void Bvh::refit(const Boxes& boxes) noexcept {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    BvhNode& node = nodes_[i];
    if (node.object != kNoObject) {
      const Box box = boxes[node.object];
      node.min = box.min, node.max = box.max;
      continue;
    }
    if (SIGHTLINE_MUTANT(stale_tree_bounds)) continue;
    const BvhNode& first = nodes_[i + 1];
    const BvhNode& second = nodes_[i + 2 + first.descendants];
    const Box both = united({first.min, first.max}, {second.min, second.max});
    node.min = both.min, node.max = both.max;
  }
}

}  // namespace sightline::rays
