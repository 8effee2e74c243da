#include "workbench/device/device.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

namespace sightline::device {

namespace {

constexpr std::uint64_t kWaitNanoseconds = 1'000'000'000;  // at a time
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation) {
  const vk::ApplicationInfo application{"sightline", 1, "sightline", 1, VK_API_VERSION_1_3};
  std::vector<const char*> layers, extensions;
  if (validation) {
    const auto found = context.enumerateInstanceLayerProperties();
    if (std::ranges::none_of(
            found, [](const auto& layer) { return std::string_view(layer.layerName) == kValidationLayer; })) {
      throw Error(fmt::format("Vulkan: layer {} is not installed, expected package vulkan-validationlayers",
                              kValidationLayer));
    }
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  return {context, vk::InstanceCreateInfo{{}, &application, layers, extensions}};
}

DeviceInfo describe(const vk::raii::PhysicalDevice& device) {
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const char* kind = "other";
  switch (properties.deviceType) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      kind = "discrete GPU";
      break;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      kind = "integrated GPU";
      break;
    case vk::PhysicalDeviceType::eVirtualGpu:
      kind = "virtual GPU";
      break;
    case vk::PhysicalDeviceType::eCpu:
      kind = "CPU";
      break;
    default:
      break;
  }
  return {properties.deviceName.data(), kind,
          fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data())};
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

int preference(const vk::raii::PhysicalDevice& device) {
  switch (device.getProperties().deviceType) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 3;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 2;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 1;
    default:
      return 0;
  }
}

const vk::raii::PhysicalDevice& choose(const std::vector<vk::raii::PhysicalDevice>& devices,
                                       const std::string& choice) {
  if (devices.empty())
    throw Error(
        "Vulkan: there is no device, expected a GPU driver or lavapipe (package mesa-vulkan-drivers)");
  if (choice.empty()) {
    return *std::ranges::max_element(devices, {}, preference);
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  const bool is_index = error == std::errc() && end == choice.data() + choice.size();
  if (is_index && index < devices.size()) return devices[index];
  std::string names;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo info = describe(devices[i]);
    if (!is_index && lower(info.name).find(lower(choice)) != std::string::npos) return devices[i];
    names += fmt::format("{}{} '{}'", names.empty() ? "" : ", ", i, info.name);
  }
  throw Error(
      fmt::format("device '{}': there is none with that index or name, expected one of {}", choice, names));
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> out;
  try {
    const vk::raii::Context context;
    const vk::raii::Instance instance = make_instance(context, false);
    for (const auto& device : instance.enumeratePhysicalDevices()) out.push_back(describe(device));
  } catch (const std::exception&) {  // no loader or no driver: no devices
    out.clear();
  }
  return out;
}

VkBool32 Device::note(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  auto& device = *static_cast<Device*>(self);
  if (device.messages_++ == 0) device.first_message_ = data->pMessage;
  return VK_FALSE;
}

void Device::open_instance(bool validation) {
  try {
    context_.emplace();
  } catch (const std::exception&) {
    throw Error("Vulkan: the loader libvulkan.so.1 is not installed, expected package libvulkan1");
  }
  try {
    instance_.emplace(make_instance(*context_, validation));
  } catch (const vk::IncompatibleDriverError&) {
    choose({}, {});  // no driver and no device are one thing to the user
  }
  if (!validation) return;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  messenger_.emplace(*instance_, vk::DebugUtilsMessengerCreateInfoEXT{{},
                                                                      Severity::eWarning | Severity::eError,
                                                                      Type::eValidation | Type::ePerformance,
                                                                      &Device::note,
                                                                      this});
}

std::uint32_t Device::check(const vk::raii::PhysicalDevice& physical) {
  if (physical.getProperties().apiVersion < VK_API_VERSION_1_3) {
    throw Error(fmt::format("device '{}': it has no Vulkan 1.3, which is expected", info_.name));
  }
  if (const auto missing = features_->missing(); !missing.empty()) {
    throw Error(
        fmt::format("device '{}': it lacks {}, which drawing needs", info_.name, fmt::join(missing, ", ")));
  }
  const auto families = physical.getQueueFamilyProperties();
  const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  const auto family =
      std::ranges::find_if(families, [&](const auto& f) { return (f.queueFlags & wanted) == wanted; });
  if (family == families.end()) {
    throw Error(fmt::format("device '{}': it has no queue for both graphics and compute", info_.name));
  }
  timestamps_ = family->timestampValidBits != 0;
  return static_cast<std::uint32_t>(family - families.begin());
}

void Device::open_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  constexpr float kPriority = 1;
  const vk::DeviceQueueCreateInfo queue{{}, family, 1, &kPriority};
  auto chain = features_->enabled();
  chain.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue);
  device_.emplace(physical, chain.get<vk::DeviceCreateInfo>());
  queue_.emplace(*device_, family, 0);
  command_pool_.emplace(
      *device_, vk::CommandPoolCreateInfo{vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family});
  finished_.emplace(*device_, vk::FenceCreateInfo{});
}

void Device::make_layout() {
  constexpr auto kNearest = vk::Filter::eNearest;
  constexpr auto kEdge = vk::SamplerAddressMode::eClampToEdge;
  sampler_.emplace(*device_, vk::SamplerCreateInfo{{}, kNearest, kNearest, {}, kEdge, kEdge, kEdge});
  using Stage = vk::ShaderStageFlagBits;
  const std::array bindings{
      vk::DescriptorSetLayoutBinding{0, vk::DescriptorType::eUniformBuffer, 1, Stage::eAll},
      vk::DescriptorSetLayoutBinding{1, vk::DescriptorType::eCombinedImageSampler,
                                     Stage::eCompute | Stage::eFragment, **sampler_}};
  set_layout_.emplace(*device_, vk::DescriptorSetLayoutCreateInfo{{}, bindings});
  const vk::PushConstantRange push{vk::ShaderStageFlagBits::eAll, 0, 128};
  layout_.emplace(*device_, vk::PipelineLayoutCreateInfo{{}, **set_layout_, push});
}

Device::Device(const DeviceOptions& options) try {
  open_instance(options.validation);
  const std::vector<vk::raii::PhysicalDevice> devices = instance_->enumeratePhysicalDevices();
  const vk::raii::PhysicalDevice& physical = choose(devices, options.choice);
  info_ = describe(physical);
  limits_ = physical.getProperties().limits;
  if (options.widest_dispatch) limits_.maxComputeWorkGroupCount[0] = options.widest_dispatch;
  features_.emplace(physical, options.withheld);
  open_device(physical, check(physical));
  memory_.emplace(physical, *device_, info_.name, options.memory_limit);
  make_layout();
} catch (const vk::SystemError& error) {
  throw Error(fmt::format("Vulkan: the device cannot be opened: {}", error.what()));
}

Device::~Device() = default;

void Device::require(std::string_view feature, std::string_view who) const {
  if (!features_->has(feature)) {
    throw Error(fmt::format("device '{}': it lacks {}, which {} needs", info_.name, feature, who));
  }
}

void Device::submit_and_wait(const vk::raii::CommandBuffer& commands) const {
  try {
    const vk::CommandBufferSubmitInfo buffer{*commands};
    queue_->submit2(vk::SubmitInfo2{{}, {}, buffer}, **finished_);
    while (device_->waitForFences(**finished_, true, kWaitNanoseconds) == vk::Result::eTimeout) {
    }
    device_->resetFences(**finished_);
  } catch (const vk::SystemError& error) {
    throw Error(fmt::format("device '{}': the frame was not finished: {}", info_.name, error.what()));
  }
}

void Device::run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const {
  const vk::raii::CommandBuffers buffers(*device_, {**command_pool_, vk::CommandBufferLevel::ePrimary, 1});
  buffers[0].begin(vk::CommandBufferBeginInfo{vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(buffers[0]);
  buffers[0].end();
  submit_and_wait(buffers[0]);
}

}  // namespace sightline::device
