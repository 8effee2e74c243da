// A Vulkan 1.3 device: chosen by index or name, with one queue for graphics and compute.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "workbench/device/features.hpp"
#include "workbench/device/memory_pool.hpp"

namespace sightline::device {

struct DeviceInfo {
  std::string name;
  std::string kind;    ///< "discrete GPU", "CPU", …
  std::string driver;  ///< the driver's name and version
};

struct DeviceOptions {
  std::string choice;                 ///< index, or part of the name in any case; empty: the fastest kind
  bool validation = false;            ///< loads VK_LAYER_KHRONOS_validation and counts its messages
  std::uint64_t memory_limit = 0;     ///< bytes that buffers and images may take; 0: what the device has
  std::vector<std::string> withheld;  ///< features to treat as absent, in Vulkan's names
  std::uint32_t widest_dispatch = 0;  ///< workgroups that fit side by side; 0: as many as the device says
};

/// The devices, in the loader's order; empty where there is no Vulkan at all.
std::vector<DeviceInfo> list_devices();

/// Owns instance and device; outlives everything made from it. Throws Error where there is no such device, or
/// it lacks Vulkan 1.3, a queue, or a feature.
class Device {
public:
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const vk::raii::Device& handle() const noexcept { return *device_; }
  [[nodiscard]] const vk::raii::Queue& queue() const noexcept { return *queue_; }
  [[nodiscard]] const vk::raii::CommandPool& command_pool() const noexcept { return *command_pool_; }
  [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] const vk::PhysicalDeviceLimits& limits() const noexcept { return limits_; }
  /// Workgroups that fit side by side.
  [[nodiscard]] std::uint32_t widest_dispatch() const noexcept { return limits_.maxComputeWorkGroupCount[0]; }
  [[nodiscard]] const Features& features() const noexcept { return *features_; }
  [[nodiscard]] bool has_timestamps() const noexcept { return timestamps_; }
  /// All pipelines share one layout: 128 bytes of push constants, and a set with a uniform buffer, the view,
  /// and for compute shaders the frame's depth with a sampler that takes the nearest texel.
  [[nodiscard]] const vk::raii::PipelineLayout& layout() const noexcept { return *layout_; }

  [[nodiscard]] const vk::raii::DescriptorSetLayout& set_layout() const noexcept { return *set_layout_; }

  /// Throws Error that names `who` unless the device has the feature.
  void require(std::string_view feature, std::string_view who) const;

  /// What buffers and images take their memory from.
  [[nodiscard]] MemoryPool& memory() noexcept { return *memory_; }
  /// Bytes that buffers and images hold.
  [[nodiscard]] std::uint64_t allocated() const noexcept { return memory_->in_use(); }

  /// Records, submits, and waits until the device has finished just this.
  void run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;
  void submit_and_wait(const vk::raii::CommandBuffer& commands) const;

  /// Validation messages (warnings and errors) so far, and the first of them.
  [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }
  [[nodiscard]] const std::string& first_message() const noexcept { return first_message_; }

private:
  void open_instance(bool validation);
  /// Which of the queue families serves graphics and compute; throws Error where the device is not enough.
  std::uint32_t check(const vk::raii::PhysicalDevice& physical);
  void open_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family);
  void make_layout();

  static VKAPI_ATTR VkBool32 VKAPI_CALL note(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                             VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT*, void*);

  std::atomic<std::uint64_t> messages_ = 0;
  std::string first_message_;
  DeviceInfo info_;
  vk::PhysicalDeviceLimits limits_;
  bool timestamps_ = false;
  std::optional<vk::raii::Context> context_;
  std::optional<vk::raii::Instance> instance_;
  std::optional<vk::raii::DebugUtilsMessengerEXT> messenger_;
  std::optional<Features> features_;
  std::optional<vk::raii::Device> device_;
  std::optional<vk::raii::Queue> queue_;
  std::optional<MemoryPool> memory_;
  std::optional<vk::raii::CommandPool> command_pool_;
  std::optional<vk::raii::Fence> finished_;  // of the one submission under way
  std::optional<vk::raii::Sampler> sampler_;
  std::optional<vk::raii::DescriptorSetLayout> set_layout_;
  std::optional<vk::raii::PipelineLayout> layout_;
};

}  // namespace sightline::device
