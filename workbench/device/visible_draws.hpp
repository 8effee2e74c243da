// From flags, one an object, to draw commands, on the device.
#pragma once

#include <array>
#include <numeric>

#include "workbench/device/recorder.hpp"
#include "workbench/device/scene_buffers.hpp"
#include "workbench/submission/draw_state.hpp"

namespace sightline::device {

/// A list of objects and the indirect commands that draw it: one a batch, in slot order, then one a
/// transparent object in the order that is given.
struct DrawBuffers {
  Buffer list, commands;
  std::array<std::uint32_t, submission::kDrawStates> commands_of{};  ///< how many, by state

  [[nodiscard]] std::uint32_t first_of(submission::DrawState state) const noexcept {
    const auto end = commands_of.begin() + static_cast<std::ptrdiff_t>(state);
    return std::accumulate(commands_of.begin(), end, 0u);
  }
  [[nodiscard]] std::uint32_t count_of(submission::DrawState state) const noexcept {
    return commands_of[static_cast<std::size_t>(state)];
  }
};

/// Compacts flags into DrawBuffers by a prefix sum, so that the order of drawing never depends on timing.
class VisibleDraws {
public:
  VisibleDraws(Device& device, const SceneBuffers& scene);

  struct Condition {
    std::uint32_t mask = ~0u, value = 1;  ///< (flags[o] & mask) == value
  };
  /// Who is listed, of the solid objects and of the rest, and where.
  struct List {
    Condition solid, rest;
    const DrawBuffers* out;
  };
  /// Which slots are looked at.
  enum class Among : std::uint8_t { all, candidates };
  /// Lists the objects that meet a condition; into a second list, where there is one, solid objects alone.
  /// `transparent_order` holds all transparent objects as they are to be drawn; 0 leaves the transparent
  /// commands as they were.
  void build(const Recorder& frame, vk::DeviceAddress flags, const List& first,
             vk::DeviceAddress transparent_order, const List* second = nullptr,
             Among among = Among::all) const;
  void build(const Recorder& frame, vk::DeviceAddress flags, Condition condition,
             vk::DeviceAddress transparent_order, const DrawBuffers& out) const {
    build(frame, flags, List{condition, condition, &out}, transparent_order);
  }
  /// One list, built without transparent commands if the device finds groups() at `groups`, and not if it
  /// finds 0.
  void build_where(const Recorder& frame, vk::DeviceAddress flags, const List& list,
                   const Recorder::Groups& groups) const;
  /// A bit a slot: who may be listed by the next build among candidates, which takes all of them back.
  [[nodiscard]] vk::DeviceAddress candidates() const noexcept;
  /// How many groups each step takes for one list.
  [[nodiscard]] std::uint32_t groups() const noexcept;
  /// Of the first list built last: groups of 64 over its solid objects; then in a word how many they are.
  [[nodiscard]] Recorder::Groups listed() const noexcept;
  /// Lists every object.
  static constexpr Condition kAll{0, 0};

  /// Room for all objects; as yet the commands draw nothing.
  [[nodiscard]] DrawBuffers make_buffers(Device& device) const;

private:
  const SceneBuffers& scene_;
  ComputePipeline scan_blocks_, scan_candidates_, scan_write_;
  Buffer scan_;
};

}  // namespace sightline::device
