// What Sightline asks of a Vulkan device, and the sentence when a device lacks it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace sightline::device {

/// The features of a device, in Vulkan's own names, and which of them are to be treated as absent.
class Features {
public:
  /// Reads what the device has. `withheld` names features that are treated as absent.
  Features(const vk::raii::PhysicalDevice& device, std::span<const std::string> withheld);

  /// Whether the device has it; names not in the table of features.cpp count as absent.
  [[nodiscard]] bool has(std::string_view name) const noexcept;
  /// Those without which nothing works.
  [[nodiscard]] std::vector<std::string_view> missing() const;
  /// The chain to create a device with: all features of the table that are present, nothing else.
  [[nodiscard]] vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2,
                                   vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceVulkan13Features>
  enabled() const;

private:
  std::vector<bool> present_;
};

}  // namespace sightline::device
