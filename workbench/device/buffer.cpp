#include "workbench/device/buffer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <sightline/workbench/error.hpp>
#include <utility>

namespace sightline::device {

Buffer::Buffer(Device& device, vk::DeviceSize bytes, Memory memory, std::string_view what) try
    : size_(std::max<vk::DeviceSize>(bytes, 16)) {
  using Usage = vk::BufferUsageFlagBits;
  using Property = vk::MemoryPropertyFlagBits;
  const auto usage = Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eTransferSrc |
                     Usage::eTransferDst | Usage::eIndexBuffer | Usage::eVertexBuffer |
                     Usage::eIndirectBuffer | Usage::eShaderDeviceAddress;
  buffer_.emplace(device.handle(), vk::BufferCreateInfo{{}, size_, usage});
  const vk::MemoryPropertyFlags host = Property::eHostVisible | Property::eHostCoherent;
  memory_ = device.memory().take(
      buffer_->getMemoryRequirements(), memory == Memory::device ? Property::eDeviceLocal : host,
      memory == Memory::readback ? Property::eHostCached : Property{}, MemoryPool::For::buffers, what);
  buffer_->bindMemory(memory_.memory(), memory_.offset());
  address_ = device.handle().getBufferAddress({**buffer_});
  if (memory != Memory::device) {
    mapped_ = memory_.mapped();
    std::memset(mapped_, 0, size_);
  }
} catch (const vk::SystemError& error) {
  throw Error(fmt::format("device: no buffer for {}: {}", what, error.what()));
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(memory_, other.memory_);
  std::swap(buffer_, other.buffer_);
  std::swap(size_, other.size_);
  std::swap(address_, other.address_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

Buffer upload_bytes(Device& device, std::span<const std::byte> bytes, std::string_view what) {
  Buffer out(device, bytes.size(), Memory::device, what);
  constexpr std::size_t kPiece = 64u << 20;  // bounds the staging memory
  if (bytes.empty()) return out;
  const Buffer staging(device, std::min(bytes.size(), kPiece), Memory::upload, "uploads");
  for (std::size_t done = 0; done < bytes.size(); done += kPiece) {
    const std::size_t size = std::min(kPiece, bytes.size() - done);
    std::memcpy(staging.mapped<std::byte>(), bytes.data() + done, size);
    device.run([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging.handle(), out.handle(), vk::BufferCopy{0, done, size});
    });
  }
  return out;
}

std::vector<std::uint32_t> read_words(Device& device, const Buffer& buffer, std::size_t count) {
  std::vector<std::uint32_t> out(count);
  if (count == 0) return out;
  const Buffer back(device, count * 4, Memory::readback, "a read-back");
  device.run([&](const vk::raii::CommandBuffer& commands) {
    full_barrier(commands);
    commands.copyBuffer(buffer.handle(), back.handle(), vk::BufferCopy{0, 0, count * 4});
    full_barrier(commands);
  });
  std::memcpy(out.data(), back.mapped<std::uint32_t>(), count * 4);
  return out;
}

void full_barrier(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier2 barrier{
      vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
      vk::PipelineStageFlagBits2::eAllCommands | vk::PipelineStageFlagBits2::eHost,
      vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite | vk::AccessFlagBits2::eHostRead};
  commands.pipelineBarrier2(vk::DependencyInfo{{}, barrier});
}

}  // namespace sightline::device
