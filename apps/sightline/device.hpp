// Commands on a Vulkan device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "workbench/device/device.hpp"

namespace sightline::app {

inline constexpr const char* kDeviceHelp =
    "where methods run: cpu, or a Vulkan device by index or part of its name, or any for the fastest kind";

/// What `compare` and `verify` are told, when it is to happen on a device.
struct DeviceCall {
  std::string scene, pvs, methods, path{}, device, json{};
  std::uint32_t width = 0, height = 0;
  std::size_t views = 0;
  std::uint64_t seed = 0;
  double moving = 0;
  bool limit = false;
};

/// Opens the device of `--device`. Validation is on where SIGHTLINE_VALIDATION is set.
std::unique_ptr<device::Device> open_device(const std::string& name);
/// Throws Error where validation complained.
void expect_silence(const device::Device& device);

int compare_on_device(const DeviceCall& call);
int verify_on_device(const DeviceCall& call);

}  // namespace sightline::app
