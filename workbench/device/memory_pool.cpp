#include "workbench/device/memory_pool.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

namespace sightline::device {

namespace {

constexpr vk::DeviceSize kBlockSize = 32u << 20;
// Pieces of so many bytes have a block each, and so go back to the driver when they go.
constexpr vk::DeviceSize kLargePiece = kBlockSize / 4;
// At least, so that no two pieces share a line of any cache.
constexpr vk::DeviceSize kAlignment = 256;

constexpr vk::DeviceSize rounded_up(vk::DeviceSize value, vk::DeviceSize step) noexcept {
  return (value + step - 1) / step * step;
}

double mebibytes(std::uint64_t bytes) noexcept {
  return static_cast<double>(bytes) / 1048576;
}

}  // namespace

struct MemoryPiece::Block {
  vk::raii::DeviceMemory memory;
  vk::DeviceSize size;
  std::uint32_t type;
  MemoryPool::For use;
  std::byte* mapped = nullptr;
  std::map<vk::DeviceSize, vk::DeviceSize> free;  ///< sizes by offset; no two touch

  [[nodiscard]] bool is_free() const noexcept { return free.size() == 1 && free.begin()->second == size; }

  /// The offset of a piece, first fit.
  [[nodiscard]] std::optional<vk::DeviceSize> take(vk::DeviceSize bytes, vk::DeviceSize alignment) {
    for (auto hole = free.begin(); hole != free.end(); ++hole) {
      const auto [begin, length] = *hole;
      const vk::DeviceSize at = rounded_up(begin, alignment), end = begin + length;
      if (at > end || end - at < bytes) continue;
      if (at + bytes < end) free.emplace(at + bytes, end - at - bytes);
      if (at > begin) {
        hole->second = at - begin;
      } else {
        free.erase(hole);
      }
      return at;
    }
    return std::nullopt;
  }

  void give_back(vk::DeviceSize offset, vk::DeviceSize bytes) {
    auto hole = free.emplace(offset, bytes).first;
    if (const auto after = std::next(hole); after != free.end() && offset + bytes == after->first) {
      hole->second += after->second;
      free.erase(after);
    }
    if (hole == free.begin()) return;
    if (const auto before = std::prev(hole); before->first + before->second == offset) {
      before->second += hole->second;
      free.erase(hole);
    }
  }
};

MemoryPiece& MemoryPiece::operator=(MemoryPiece&& other) noexcept {
  std::swap(pool_, other.pool_);
  std::swap(block_, other.block_);
  std::swap(offset_, other.offset_);
  std::swap(size_, other.size_);
  return *this;
}

MemoryPiece::~MemoryPiece() {
  if (pool_) pool_->give_back(*block_, offset_, size_);
}

vk::DeviceMemory MemoryPiece::memory() const noexcept {
  return *block_->memory;
}

void* MemoryPiece::mapped() const noexcept {
  return block_->mapped ? block_->mapped + offset_ : nullptr;
}

MemoryPool::MemoryPool(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                       std::string name, std::uint64_t limit)
    : device_(device),
      name_(std::move(name)),
      limit_(limit),
      types_(physical.getMemoryProperties()),
      largest_(
          physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>()
              .get<vk::PhysicalDeviceMaintenance3Properties>()
              .maxMemoryAllocationSize) {}

MemoryPool::~MemoryPool() = default;

std::optional<std::uint32_t> MemoryPool::type_of(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                                 vk::MemoryPropertyFlags preferred) const noexcept {
  for (const auto flags : {wanted | preferred, wanted}) {
    for (std::uint32_t type = 0; type < types_.memoryTypeCount; ++type) {
      const bool fits = allowed >> type & 1;
      if (fits && (types_.memoryTypes[type].propertyFlags & flags) == flags) return type;
    }
  }
  return std::nullopt;
}

std::string MemoryPool::objection(vk::DeviceSize size, std::uint32_t type) const {
  const vk::DeviceSize heap = types_.memoryHeaps[types_.memoryTypes[type].heapIndex].size;
  const std::uint64_t limit = limit_ ? std::min<std::uint64_t>(limit_, heap) : heap;
  if (size > largest_) return fmt::format("expected at most {:.1f} MiB at once", mebibytes(largest_));
  if (size > limit || in_use_ > limit - size)
    return fmt::format("expected at most {:.1f} MiB in all", mebibytes(limit));
  return {};
}

MemoryPool::Block& MemoryPool::add_block(vk::DeviceSize size, std::uint32_t type, For use) {
  const vk::MemoryAllocateFlagsInfo flags{use == For::buffers ? vk::MemoryAllocateFlagBits::eDeviceAddress
                                                              : vk::MemoryAllocateFlags{}};
  auto block = std::make_unique<Block>(
      Block{{device_, vk::MemoryAllocateInfo{size, type, &flags}}, size, type, use, nullptr, {{0, size}}});
  const bool seen =
      static_cast<bool>(types_.memoryTypes[type].propertyFlags & vk::MemoryPropertyFlagBits::eHostVisible);
  if (seen && use == For::buffers)
    block->mapped = static_cast<std::byte*>(block->memory.mapMemory(0, VK_WHOLE_SIZE));
  return *blocks_.emplace_back(std::move(block));
}

MemoryPiece MemoryPool::piece_of(Block& block, vk::DeviceSize offset, vk::DeviceSize size) noexcept {
  MemoryPiece piece;
  piece.pool_ = this, piece.block_ = &block;
  piece.offset_ = offset, piece.size_ = size;
  in_use_ += size;
  return piece;
}

MemoryPiece MemoryPool::take(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                             vk::MemoryPropertyFlags preferred, For use, std::string_view what) {
  const vk::DeviceSize size = requirements.size;
  const auto refuse = [&](std::string_view why) {
    return Error(
        fmt::format("device '{}': no memory for {}: {:.1f} MiB asked for beside {:.1f} MiB in use, {}", name_,
                    what, mebibytes(size), mebibytes(in_use_), why));
  };
  const auto type = type_of(requirements.memoryTypeBits, wanted, preferred);
  if (!type) throw refuse("and the device has no memory of that kind");
  if (const std::string why = objection(size, *type); !why.empty()) throw refuse(why);

  const bool large = size >= kLargePiece;
  const vk::DeviceSize alignment = std::max(requirements.alignment, kAlignment);
  for (std::size_t i = 0; i < blocks_.size() && !large; ++i) {
    Block& block = *blocks_[i];
    if (block.type != *type || block.use != use) continue;
    if (const auto at = block.take(size, alignment)) return piece_of(block, *at, size);
  }
  // What a small heap has left may be less than a whole block.
  const vk::DeviceSize heap = types_.memoryHeaps[types_.memoryTypes[*type].heapIndex].size;
  const vk::DeviceSize whole = std::min({kBlockSize, largest_, heap / 16});
  try {
    if (!large && size < whole) {
      try {
        Block& block = add_block(whole, *type, use);
        return piece_of(block, *block.take(size, alignment), size);
      } catch (const vk::OutOfDeviceMemoryError&) {  // a smaller one may fit
      } catch (const vk::OutOfHostMemoryError&) {
      }
    }
    Block& block = add_block(size, *type, use);
    return piece_of(block, *block.take(size, alignment), size);
  } catch (const vk::SystemError& error) {
    throw refuse(error.what());
  }
}

void MemoryPool::give_back(Block& block, vk::DeviceSize offset, vk::DeviceSize size) noexcept {
  in_use_ -= size;
  block.give_back(offset, size);
  if (!block.is_free()) return;
  // One empty block of a kind stays, for what comes and goes every frame.
  const bool spare = block.size == kBlockSize && std::ranges::none_of(blocks_, [&](const auto& other) {
                       return other.get() != &block && other->type == block.type && other->use == block.use &&
                              other->is_free();
                     });
  if (!spare) std::erase_if(blocks_, [&](const auto& other) { return other.get() == &block; });
}

}  // namespace sightline::device
