// A tree of boxes with eight children a node, for testing boxes level by level on the device.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::methods {

/// Nodes 0 … interior() - 1 hold others, node 0 is the root; node interior() + o is object o.
class BoxTree {
public:
  static constexpr std::uint32_t kWidth = 8;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Node {
    std::uint32_t first_child = 0, child_count = 0;  ///< range of children()
  };

  /// Halves the objects at the median along the longest axis of their centres, three times a level.
  explicit BoxTree(const Scene& scene);

  /// Fits the boxes to moved objects; `changed` receives the nodes whose box is another now.
  void refit(const Scene& scene, std::span<const ObjectId> moved, std::vector<std::uint32_t>& changed);

  [[nodiscard]] std::uint32_t interior() const noexcept { return static_cast<std::uint32_t>(nodes_.size()); }
  [[nodiscard]] std::uint32_t total() const noexcept { return static_cast<std::uint32_t>(boxes_.size()); }
  /// Levels, objects included.
  [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& children() const noexcept { return children_; }
  [[nodiscard]] const std::vector<std::uint32_t>& parents() const noexcept { return parents_; }
  [[nodiscard]] const Box& box(std::uint32_t node) const noexcept { return boxes_[node]; }

private:
  [[nodiscard]] Box children_box(std::uint32_t node) const noexcept;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> children_, parents_;
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> depth_;  // of interior nodes
  std::uint32_t levels_ = 1;
};

}  // namespace sightline::methods
