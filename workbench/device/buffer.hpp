// Device buffers, addressed by pointer in shaders.
#pragma once

#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "workbench/device/device.hpp"

namespace sightline::device {

enum class Memory : std::uint8_t {
  device,    ///< the GPU's own; filled by upload()
  upload,    ///< written by the CPU through mapped(), read by the GPU
  readback,  ///< written by the GPU, read by the CPU through mapped()
};

/// A buffer that serves every use but images. Empty by default.
class Buffer {
public:
  Buffer() = default;
  /// At least 16 bytes; zeroed where the CPU sees it. Throws Error when memory runs out; `what` names it.
  Buffer(Device& device, vk::DeviceSize bytes, Memory memory, std::string_view what);
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;

  [[nodiscard]] vk::Buffer handle() const noexcept { return **buffer_; }
  [[nodiscard]] vk::DeviceAddress address() const noexcept { return address_; }
  [[nodiscard]] vk::DeviceSize size() const noexcept { return size_; }
  template <class T>
  [[nodiscard]] T* mapped() const noexcept {
    return static_cast<T*>(mapped_);
  }

private:
  MemoryPiece memory_;
  std::optional<vk::raii::Buffer> buffer_;
  vk::DeviceSize size_ = 0;
  vk::DeviceAddress address_ = 0;
  void* mapped_ = nullptr;
};

/// A device buffer that holds these bytes.
Buffer upload_bytes(Device& device, std::span<const std::byte> bytes, std::string_view what);

template <class T>
Buffer upload(Device& device, const std::vector<T>& values, std::string_view what) {
  return upload_bytes(device, std::as_bytes(std::span(values)), what);
}

/// The first `count` values of a buffer, copied back; waits.
std::vector<std::uint32_t> read_words(Device& device, const Buffer& buffer, std::size_t count);

/// Everything before is finished and seen by everything after. Frames are bound by draws, not by barriers.
void full_barrier(const vk::raii::CommandBuffer& commands);

}  // namespace sightline::device
