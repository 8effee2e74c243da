#include "workbench/methods/raster_occlusion/depth_pyramid.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kPyramid[] =
#include "shaders/pyramid.comp.inc"
    ;

struct PyramidPush {
  vk::DeviceAddress from, to;
  std::uint32_t from_width, from_height, to_width, to_height, reversed;
};

}  // namespace

DepthPyramid::DepthPyramid(device::Device& device) : device_(device), reduce_(device, kPyramid) {}

void DepthPyramid::build(device::Recorder& frame) {
  std::uint32_t width = width_ = frame.targets.depth.width(), height = height_ = frame.targets.depth.height();
  const std::uint64_t most = 4 * (std::uint64_t{width} * height * 3 / 2 + width + height + 64);
  if (levels_.size() < most)
    levels_ = device::Buffer(device_, most, device::Memory::device, "the depth pyramid");
  frame.targets.depth.copy_to(frame.commands, levels_);
  vk::DeviceAddress from = levels_.address();
  while (width > 1 || height > 1) {
    const std::uint32_t to_width = (width + 1) / 2, to_height = (height + 1) / 2;
    const vk::DeviceAddress to = from + 4 * std::uint64_t{width} * height;
    frame.dispatch(reduce_, PyramidPush{from, to, width, height, to_width, to_height, frame.reversed()},
                   to_width * to_height);
    from = to;
    width = to_width;
    height = to_height;
  }
}

}  // namespace sightline::methods
