#include "workbench/device/features.hpp"

#include <algorithm>
#include <array>

namespace sightline::device {

namespace {

using Core = vk::PhysicalDeviceFeatures;
using Vulkan12 = vk::PhysicalDeviceVulkan12Features;
using Vulkan13 = vk::PhysicalDeviceVulkan13Features;

struct Feature {
  std::string_view name;
  bool required;
  vk::Bool32 Core::*core = nullptr;
  vk::Bool32 Vulkan12::*vulkan12 = nullptr;
  vk::Bool32 Vulkan13::*vulkan13 = nullptr;
};

constexpr std::array kFeatures{
    Feature{"multiDrawIndirect", true, &Core::multiDrawIndirect},
    Feature{"drawIndirectFirstInstance", true, &Core::drawIndirectFirstInstance},
    Feature{"fragmentStoresAndAtomics", true, &Core::fragmentStoresAndAtomics},
    Feature{"shaderClipDistance", true, &Core::shaderClipDistance},
    Feature{"geometryShader", false, &Core::geometryShader},
    Feature{"bufferDeviceAddress", true, nullptr, &Vulkan12::bufferDeviceAddress},
    Feature{"scalarBlockLayout", true, nullptr, &Vulkan12::scalarBlockLayout},
    Feature{"dynamicRendering", true, nullptr, nullptr, &Vulkan13::dynamicRendering},
    Feature{"synchronization2", true, nullptr, nullptr, &Vulkan13::synchronization2},
    Feature{"maintenance4", true, nullptr, nullptr, &Vulkan13::maintenance4},
};

}  // namespace

Features::Features(const vk::raii::PhysicalDevice& device, std::span<const std::string> withheld) {
  const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, Vulkan12, Vulkan13>();
  for (const Feature& feature : kFeatures) {
    const bool has = feature.core       ? chain.get<vk::PhysicalDeviceFeatures2>().features.*feature.core
                     : feature.vulkan12 ? chain.get<Vulkan12>().*feature.vulkan12
                                        : chain.get<Vulkan13>().*feature.vulkan13;
    present_.push_back(has && std::ranges::find(withheld, feature.name) == withheld.end());
  }
}

bool Features::has(std::string_view name) const noexcept {
  const auto at = std::ranges::find(kFeatures, name, &Feature::name);
  return at != kFeatures.end() && present_[static_cast<std::size_t>(at - kFeatures.begin())];
}

std::vector<std::string_view> Features::missing() const {
  std::vector<std::string_view> names;
  for (const Feature& feature : kFeatures) {
    if (feature.required && !has(feature.name)) names.push_back(feature.name);
  }
  return names;
}

vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, Vulkan12, Vulkan13> Features::enabled()
    const {
  vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, Vulkan12, Vulkan13> chain;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    const Feature& feature = kFeatures[i];
    const vk::Bool32 on = present_[i] ? VK_TRUE : VK_FALSE;
    if (feature.core) chain.get<vk::PhysicalDeviceFeatures2>().features.*feature.core = on;
    if (feature.vulkan12) chain.get<Vulkan12>().*feature.vulkan12 = on;
    if (feature.vulkan13) chain.get<Vulkan13>().*feature.vulkan13 = on;
  }
  return chain;
}

}  // namespace sightline::device
