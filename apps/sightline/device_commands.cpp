// compare and verify on a Vulkan device.
#include "device.hpp"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstdlib>
#include <limits>
#include <string_view>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/device_measure.hpp"
#include "workbench/report/device_table.hpp"

namespace sightline::app {

namespace {

// Those with a form of their own on the device that promise something; drawing what others keep proves less.
std::vector<std::string> methods_to_verify() {
  std::vector<std::string> names;
  for (const methods::DeviceMethodInfo& info : methods::device_methods()) {
    if (info.guarantee != Guarantee::approximate) names.emplace_back(info.name);
  }
  return names;
}

std::vector<std::string> methods_or(const DeviceCall& call, std::vector<std::string> defaults) {
  return call.methods.empty() ? std::move(defaults) : split("--methods", call.methods);
}

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

void expect_silence(const device::Device& device) {
  if (device.messages() > 0) {
    throw Error(
        fmt::format("validation: {} messages, the first: {}", device.messages(), device.first_message()));
  }
}

int compare_on_device(const DeviceCall& call) {
  const auto device = open_device(call.device);
  Scene scene = load_scene(call.scene);
  attach_pvs(scene, call.pvs);
  const std::string path_name = call.path.empty() ? std::string(camera::default_path(scene)) : call.path;
  const camera::CameraPath path = camera::make_path(scene, path_name, call.views);
  measure::Workbench bench(*device, scene, methods_or(call, methods::methods_on_device(scene)));
  measure::DeviceMeasureOptions options;
  options.measure.width = call.width, options.measure.height = call.height;
  options.measure.repeats = 5;
  options.moving = call.moving;
  options.limit = call.limit;
  const measure::Comparison comparison =
      measure::compare_on_device(bench, path, options, progress("compare"));
  expect_silence(*device);
  fmt::print("{}: {} objects, {} triangles; path '{}', {} views of {}x{} on {}\n\n", scene.name, scene.size(),
             triangle_count(scene), path.name, path.cameras.size(), call.width, call.height,
             comparison.device);
  fmt::print("{}\n{}\n", report::render(report::device_table(comparison)),
             report::device_verdict(comparison));
  if (const report::Table ratios = report::device_ratios(comparison); !ratios.rows.empty())
    fmt::print("\nWhere less than 20 % of the objects are visible:\n{}", report::render(ratios));
  if (!call.json.empty()) measure::write_json(call.json, comparison);
  return Exit::done;
}

int verify_on_device(const DeviceCall& call) {
  const auto device = open_device(call.device);
  Scene scene = load_scene(call.scene);
  attach_pvs(scene, call.pvs);
  measure::Workbench bench(*device, scene, methods_or(call, methods_to_verify()));
  const std::vector<Camera> cameras = camera::random_cameras(scene, call.views, call.seed);
  const measure::DeviceVerification result =
      measure::verify_on_device(bench, cameras, call.width, call.height, call.moving, progress("verify"));
  expect_silence(*device);
  fmt::print(
      "{}: {} random views of {}x{}, seed {}, each as a camera cut and once more, {:g} of the objects "
      "moving, on {}\n\n",
      scene.name, result.views, call.width, call.height, call.seed, call.moving, device->info().name);
  fmt::print("{}", report::render(report::verification_table(result)));
  for (const measure::MethodVerdict& m : result.methods) {
    for (const measure::LostObject& lost : m.examples) fmt::print("{}\n", measure::describe(m, lost));
  }
  return result.passed() ? Exit::done : Exit::check_failed;
}

}  // namespace sightline::app
