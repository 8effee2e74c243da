// GPU time of a frame's named passes, by timestamps.
#pragma once

#include <string>
#include <vector>

#include "workbench/device/device.hpp"
#include "workbench/device/frame_times.hpp"

namespace sightline::device {

class Timer {
public:
  explicit Timer(const Device& device);

  /// Forgets the last frame's passes; those of this frame count if it is `on`.
  void reset(const vk::raii::CommandBuffer& commands, bool on);
  void begin(const vk::raii::CommandBuffer& commands, std::string_view name, PassKind kind);
  void end(const vk::raii::CommandBuffer& commands);
  /// Of the frame that was last submitted and waited for; 0 ms where the device has no timestamps.
  [[nodiscard]] std::vector<PassTime> read() const;

private:
  static constexpr std::uint32_t kMostPasses = 128;  ///< passes after these go untimed
  const Device& device_;
  bool on_ = false;
  vk::raii::QueryPool pool_;
  std::vector<PassTime> passes_;
};

}  // namespace sightline::device
