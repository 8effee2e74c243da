#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/methods/raster_occlusion/device_methods.hpp"
#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

std::span<const DeviceMethodInfo> device_methods() noexcept {
  static const std::array kMethods{kNoneOnDevice,  kVfcVcOnDevice, kRoc,   kHroc, kVertexChunk,
                                   kResidentChunk, kHiz,           kIwcpa, kBvha, kSaa};
  return kMethods;
}

const DeviceMethodInfo* find_device_method(std::string_view name) noexcept {
  const auto methods = device_methods();
  const auto at = std::ranges::find(methods, name, &DeviceMethodInfo::name);
  return at == methods.end() ? nullptr : &*at;
}

std::unique_ptr<DeviceMethod> create_device_method(std::string_view specification,
                                                   device::Renderer& renderer) {
  const std::string_view name = specified_name(specification);
  const DeviceMethodInfo* info = find_device_method(name);
  if (info) {
    const Parameters parameters = or_throw(parse_parameters("method", specification, info->parameters));
    if (!info->needs.empty()) renderer.device().require(info->needs, fmt::format("method '{}'", name));
    return info->create(renderer, parameters);
  }
  if (!find_method(name)) {
    throw Error(fmt::format("method '{}': no such method, expected one of {}", name,
                            fmt::join(methods_on_device(renderer.scene()), ", ")));
  }
  return draw_by_device(or_throw(create_method(specification, renderer.scene())), renderer);
}

std::vector<std::string> methods_on_device(const Scene& scene) {
  std::vector<std::string> names;
  for (const DeviceMethodInfo& info : device_methods()) names.emplace_back(info.name);
  for (const MethodInfo& info : cpu_methods()) {
    if (info.fits(scene) && !find_device_method(info.name)) names.emplace_back(info.name);
  }
  return names;
}

}  // namespace sightline::methods
