#include "device.hpp"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstdlib>
#include <limits>
#include <string_view>

#include <sightline/workbench/error.hpp>

namespace sightline::app {

namespace {

// A software rasteriser allocates and frees megabytes a frame. Given back to the system each time, they would
// be faulted in again: a fifth of a frame, and noise.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
#endif
}

}  // namespace

std::unique_ptr<device::Device> open_device(const std::string& name) {
  if (name.empty())
    throw Error("--device: it is empty, expected a device's index or part of its name, or any");
  keep_freed_memory();
  device::DeviceOptions options;
  options.choice = name == "any" ? "" : name;
  const char* const validation = std::getenv("SIGHTLINE_VALIDATION");
  options.validation = validation && *validation && std::string_view(validation) != "0";
  return std::make_unique<device::Device>(options);
}

std::unique_ptr<device::Device> open_device_or_cpu(const std::string& name) {
  if (name.empty())
    throw Error("--device: it is empty, expected cpu, a device's index or part of its name, or any");
  return name == "cpu" ? nullptr : open_device(name);
}

std::unique_ptr<device::Device> open_device_if_any() {
  if (device::list_devices().empty()) return nullptr;
  try {
    return open_device("any");
  } catch (const Error& error) {
    fmt::print(stderr, "sightline: {}; nothing is drawn\n", error.what());
    return nullptr;
  }
}

void expect_silence(const device::Device* device) {
  if (device && device->messages() > 0) {
    throw Error(
        fmt::format("validation: {} messages, the first: {}", device->messages(), device->first_message()));
  }
}

}  // namespace sightline::app
