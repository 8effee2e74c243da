// Device memory in large blocks, of which buffers and images take pieces: a driver grants few allocations,
// and each is slow.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace sightline::device {

class MemoryPool;

/// A piece of device memory, given back when it goes; empty by default.
class MemoryPiece {
public:
  MemoryPiece() = default;
  MemoryPiece(MemoryPiece&& other) noexcept { *this = std::move(other); }
  MemoryPiece& operator=(MemoryPiece&& other) noexcept;
  ~MemoryPiece();

  [[nodiscard]] vk::DeviceMemory memory() const noexcept;
  [[nodiscard]] vk::DeviceSize offset() const noexcept { return offset_; }
  /// Where the CPU sees it; null where it does not.
  [[nodiscard]] void* mapped() const noexcept;

private:
  friend MemoryPool;
  struct Block;

  MemoryPool* pool_ = nullptr;
  Block* block_ = nullptr;
  vk::DeviceSize offset_ = 0, size_ = 0;
};

/// The memory of one device. Outlives its pieces.
class MemoryPool {
public:
  enum class For : std::uint8_t { buffers, images };

  /// Refuses to hand out more than `limit` bytes; 0: what the device has.
  MemoryPool(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, std::string name,
             std::uint64_t limit);
  ~MemoryPool();
  MemoryPool(const MemoryPool&) = delete;
  MemoryPool& operator=(const MemoryPool&) = delete;

  /// Memory that has the `wanted` properties, and the `preferred` ones where there is such. Throws Error when
  /// there is no more; `what` names what it is for.
  [[nodiscard]] MemoryPiece take(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                                 vk::MemoryPropertyFlags preferred, For use, std::string_view what);

  /// Bytes in pieces.
  [[nodiscard]] std::uint64_t in_use() const noexcept { return in_use_; }
  /// Allocations that the driver has granted and that are still held.
  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_.size(); }

private:
  friend MemoryPiece;
  using Block = MemoryPiece::Block;

  [[nodiscard]] std::optional<std::uint32_t> type_of(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                                     vk::MemoryPropertyFlags preferred) const noexcept;
  /// Why no such piece may be taken; empty where it may.
  [[nodiscard]] std::string objection(vk::DeviceSize size, std::uint32_t type) const;
  [[nodiscard]] Block& add_block(vk::DeviceSize size, std::uint32_t type, For use);
  [[nodiscard]] MemoryPiece piece_of(Block& block, vk::DeviceSize offset, vk::DeviceSize size) noexcept;
  void give_back(Block& block, vk::DeviceSize offset, vk::DeviceSize size) noexcept;

  const vk::raii::Device& device_;
  std::string name_;
  std::uint64_t limit_, in_use_ = 0;
  vk::PhysicalDeviceMemoryProperties types_;
  vk::DeviceSize largest_;
  std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace sightline::device
