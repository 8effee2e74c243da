// From flags, one an object, to draw commands, on the device.
#pragma once

#include "workbench/device/recorder.hpp"
#include "workbench/device/scene_buffers.hpp"

namespace sightline::device {

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
  /// Who is listed, of the opaque and of the transparent objects, and where.
  struct List {
    Condition opaque, transparent;
    const DrawBuffers* out;
  };
  /// Lists the objects that meet a condition; into a second list, where there is one, opaque objects alone.
  /// `transparent_order` holds all transparent objects as they are to be drawn; 0 leaves the transparent
  /// commands as they were.
  void build(const Recorder& frame, vk::DeviceAddress flags, const List& first,
             vk::DeviceAddress transparent_order, const List* second = nullptr) const;
  void build(const Recorder& frame, vk::DeviceAddress flags, Condition condition,
             vk::DeviceAddress transparent_order, const DrawBuffers& out) const {
    build(frame, flags, List{condition, condition, &out}, transparent_order);
  }
  /// One list of opaque objects, built if the device finds groups() at `groups`, and not if it finds 0.
  void build_where(const Recorder& frame, vk::DeviceAddress flags, const List& list,
                   const Recorder::Groups& groups) const;
  /// How many groups each step takes for one list.
  [[nodiscard]] std::uint32_t groups() const noexcept;
  /// Of the first list built last: groups of 64 over its opaque objects; then in a word how many they are.
  [[nodiscard]] Recorder::Groups listed() const noexcept;
  /// Lists every object.
  static constexpr Condition kAll{0, 0};

  /// Room for all objects; as yet the commands draw nothing.
  [[nodiscard]] DrawBuffers make_buffers(Device& device) const;

private:
  const SceneBuffers& scene_;
  ComputePipeline scan_blocks_, scan_write_;
  Buffer scan_;
};

}  // namespace sightline::device
