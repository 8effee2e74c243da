// A BoxTree on the device, for methods that test its boxes there level by level.
#pragma once

#include "workbench/device/renderer.hpp"
#include "workbench/methods/raster_occlusion/box_tree.hpp"

namespace sightline::methods {

class DeviceBoxTree {
public:
  explicit DeviceBoxTree(device::Renderer& renderer);

  /// Sends the boxes that are others since these objects moved.
  void update(std::span<const ObjectId> moved);

  /// A device::shared::BoxData a node; a BoxTree::Node an inner node, ranges of children(); a word a node.
  [[nodiscard]] vk::DeviceAddress boxes() const noexcept { return boxes_.address(); }
  [[nodiscard]] vk::DeviceAddress nodes() const noexcept { return nodes_.address(); }
  [[nodiscard]] vk::DeviceAddress children() const noexcept { return children_.address(); }
  [[nodiscard]] vk::DeviceAddress parents() const noexcept { return parents_.address(); }

  [[nodiscard]] std::uint32_t interior() const noexcept { return tree_.interior(); }
  [[nodiscard]] std::uint32_t total() const noexcept { return tree_.total(); }
  [[nodiscard]] std::uint32_t levels() const noexcept { return tree_.levels(); }
  /// Room for a word a node.
  [[nodiscard]] device::Buffer words() const;

private:
  [[nodiscard]] device::shared::BoxData box_of(std::uint32_t node) const;

  device::Renderer& renderer_;
  BoxTree tree_;
  device::Buffer boxes_, nodes_, children_, parents_, staging_;
  std::vector<std::uint32_t> changed_;
  std::vector<vk::BufferCopy> regions_;
};

}  // namespace sightline::methods
