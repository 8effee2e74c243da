// The bounding volume hierarchy of Ye et al. 2023, sections 2.3 and 3.4.3: built top down, laid flat depth
// first with skip counts, so that a ray walks it with one index and no stack.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/boxes.hpp>

namespace sightline::rays {

/// 32 bytes, the same in C++, GLSL (std430: two vec4) and a web page's arrays.
struct BvhNode {
  Vec3 min;
  std::uint32_t descendants = 0;  ///< Arr_b: nodes below this one; a miss goes on at i + 1 + descendants
  Vec3 max;
  ObjectId object = kNoObject;  ///< of a leaf; kNoObject in an inner node
};
static_assert(sizeof(BvhNode) == 32);

/// A binary tree over boxes. Node 0 is the root, a node's first child follows it at once (Arr_a).
class Bvh {
public:
  /// Splits the longest axis of a node's bounds at its centre, boxes going by their own centres; at the
  /// median box where a side would stay empty; one object a leaf. No node for no boxes. Boxes are finite with
  /// min <= max.
  void build(const Boxes& boxes);
  /// Takes over moved boxes, as many as were built with: the tree stays, its bounds become tight again.
  void refit(const Boxes& boxes) noexcept;

  [[nodiscard]] std::span<const BvhNode> nodes() const noexcept { return nodes_; }
  [[nodiscard]] bool empty() const noexcept { return nodes_.empty(); }

private:
  void build(const Boxes& boxes, std::span<ObjectId> objects);

  std::vector<BvhNode> nodes_;
};

}  // namespace sightline::rays
