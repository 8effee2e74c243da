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

  struct Condition {
    std::uint32_t mask = ~0u, value = 1;  ///< (flags[o] & mask) == value
  };
  /// Lists the objects that meet a condition, the transparent ones by one of their own. `transparent_order`
  /// holds all transparent objects as they are to be drawn; 0 leaves the transparent commands as they were.
  void build(const Recorder& frame, vk::DeviceAddress flags, Condition opaque, Condition transparent,
             vk::DeviceAddress transparent_order, const DrawBuffers& out) const {
    build(frame, flags, opaque, transparent, transparent_order, out, {}, nullptr);
  }
  void build(const Recorder& frame, vk::DeviceAddress flags, Condition condition,
             vk::DeviceAddress transparent_order, const DrawBuffers& out) const {
    build(frame, flags, condition, condition, transparent_order, out);
  }
  /// The same, and beside it the opaque objects that meet a second condition, into a second list.
  void build(const Recorder& frame, vk::DeviceAddress flags, Condition opaque, Condition transparent,
             vk::DeviceAddress transparent_order, const DrawBuffers& out, Condition second,
             const DrawBuffers* second_out) const;
  /// Lists every object.
  static constexpr Condition kAll{0, 0};

  /// Room for all objects; as yet the commands draw nothing.
  [[nodiscard]] DrawBuffers make_buffers(Device& device) const;

private:
  const SceneBuffers& scene_;
  ComputePipeline scan_blocks_, scan_write_;
  Buffer scan_;
};

}  // namespace sightline::vulkan
