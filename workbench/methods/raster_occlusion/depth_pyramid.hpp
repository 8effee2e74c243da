// A pyramid of depths: each level holds the farthest of four of the one below.
#pragma once

#include "workbench/device/renderer.hpp"

namespace sightline::methods {

class DepthPyramid {
public:
  explicit DepthPyramid(device::Device& device);

  /// Of the frame's depth as it stands: level 0 is as large as the image, each next one half as wide and
  /// high, rounded up, down to one texel; one after the other, row 0 first.
  void build(device::Recorder& frame);

  [[nodiscard]] vk::DeviceAddress address() const noexcept { return levels_.address(); }
  /// Of the image that the last build was of; 0 before.
  [[nodiscard]] std::uint32_t width() const noexcept { return width_; }
  [[nodiscard]] std::uint32_t height() const noexcept { return height_; }

private:
  device::Device& device_;
  device::ComputePipeline reduce_;
  device::Buffer levels_;
  std::uint32_t width_ = 0, height_ = 0;
};

}  // namespace sightline::methods
