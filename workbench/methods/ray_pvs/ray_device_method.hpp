// A DeviceRays method in a frame: rays, marks, draws, nothing read back.
#pragma once

#include <memory>
#include <span>

#include "workbench/methods/device_method.hpp"
#include "workbench/methods/ray_pvs/device_rays.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"

namespace sightline::methods {

extern const DeviceMethodInfo kIwcpa;
extern const DeviceMethodInfo kBvha;
extern const DeviceMethodInfo kSaa;

inline constexpr std::array kRayDeviceParameters{kRaysParameter};

std::unique_ptr<DeviceMethod> make_ray_device_method(device::Renderer& renderer, const Parameters& parameters,
                                                     std::unique_ptr<DeviceRays> rays);

template <auto make_rays>
std::unique_ptr<DeviceMethod> make_rays_on_device(device::Renderer& renderer, const Parameters& parameters) {
  return make_ray_device_method(renderer, parameters, make_rays(renderer.device(), renderer.scene()));
}

}  // namespace sightline::methods
