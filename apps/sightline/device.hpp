// Vulkan devices, as `--device` names them.
#pragma once

#include <memory>
#include <string>

#include "workbench/device/device.hpp"

namespace sightline::app {

inline constexpr const char* kDeviceHelp =
    "where methods run: cpu, or a Vulkan device by index or part of its name, or any for the fastest kind";

/// Opens the device of `--device`. Validation is on where SIGHTLINE_VALIDATION is set.
std::unique_ptr<device::Device> open_device(const std::string& name);
/// The same; null for "cpu".
std::unique_ptr<device::Device> open_device_or_cpu(const std::string& name);
/// The fastest kind; null where there is none, or none that can draw, which is said on stderr.
std::unique_ptr<device::Device> open_device_if_any();
/// Throws Error where validation complained; nothing on the CPU.
void expect_silence(const device::Device* device);

}  // namespace sightline::app
