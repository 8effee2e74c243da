// From flags, one an object, to draw commands, on the device.
#pragma once

#include "vulkan/recorder.hpp"
#include "vulkan/scene_buffers.hpp"

namespace sightline::vulkan {

/// A list of objects and the indirect commands that draw it: one a mesh for opaque objects, in slot order,
/// then one a transparent object in the order that is given.
struct DrawBuffers {
  Buffer list, commands;
  std::uint32_t opaque_commands = 0, transparent_commands = 0;
};

/// Compacts flags into DrawBuffers by a prefix sum, so that the order of drawing never depends on timing.
class VisibleDraws {
public:
  VisibleDraws(Device& device, const SceneBuffers& scene);

  /// Lists the objects o with (flags[o] & mask) == value. `transparent_order` holds all transparent objects
  /// as they are to be drawn; 0 leaves the transparent commands out of date.
  void build(const Recorder& frame, vk::DeviceAddress flags, std::uint32_t mask, std::uint32_t value,
             vk::DeviceAddress transparent_order, const DrawBuffers& out) const;

  [[nodiscard]] DrawBuffers make_buffers(Device& device) const;

private:
  const SceneBuffers& scene_;
  ComputePipeline scan_blocks_, scan_sums_, scan_write_, draw_commands_;
  Buffer prefix_, sums_;
};

}  // namespace sightline::vulkan
