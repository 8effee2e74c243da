// Off-screen images that are drawn into and read back.
#pragma once

#include <vector>

#include "workbench/device/buffer.hpp"

namespace sightline::device {

inline constexpr vk::Format kColourFormat = vk::Format::eR8G8B8A8Unorm;
inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;
inline constexpr vk::Format kIdFormat = vk::Format::eR32Uint;

/// Of a depth image while shaders read it.
inline constexpr vk::ImageLayout kReadLayout = vk::ImageLayout::eDepthStencilReadOnlyOptimal;

/// A colour, depth or id attachment of four bytes a pixel, always in the layout of its attachment between
/// calls.
class Image {
public:
  Image(Device& device, vk::Format format, std::uint32_t width, std::uint32_t height, std::string_view what);
  Image(Image&&) = delete;

  [[nodiscard]] vk::ImageView view() const noexcept { return **view_; }
  [[nodiscard]] vk::ImageLayout layout() const noexcept { return layout_; }
  [[nodiscard]] std::uint32_t width() const noexcept { return width_; }
  [[nodiscard]] std::uint32_t height() const noexcept { return height_; }

  /// Records a copy of all pixels, row 0 first, into the buffer, where a row takes `row` pixels, or as many
  /// as it has; barriers included.
  void copy_to(const vk::raii::CommandBuffer& commands, const Buffer& buffer, std::uint32_t row = 0) const;
  /// Records that shaders may read this depth image, and nothing write it, until end_reading(); barriers
  /// included.
  void begin_reading(const vk::raii::CommandBuffer& commands) const;
  void end_reading(const vk::raii::CommandBuffer& commands) const;
  /// All pixels, row 0 first; waits.
  [[nodiscard]] std::vector<std::uint32_t> read() const;

private:
  void move_to(const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) const;

  Device& device_;
  std::uint32_t width_, height_;
  vk::ImageLayout layout_;
  vk::ImageAspectFlags aspect_;
  MemoryPiece memory_;
  std::optional<vk::raii::Image> image_;
  std::optional<vk::raii::ImageView> view_;
};

}  // namespace sightline::device
