// A DeviceRays method in a frame: rays, marks, draws, nothing read back.
#pragma once

#include <memory>
#include <span>

#include "workbench/device/renderer.hpp"
#include "workbench/methods/methods.hpp"
#include "workbench/methods/ray_pvs/device_rays.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"

namespace sightline::methods {

inline constexpr std::array kRayDeviceParameters{kRaysParameter};

std::unique_ptr<Method> make_ray_device_method(device::Renderer& renderer, const Parameters& parameters,
                                               std::unique_ptr<DeviceRays> rays);

template <auto make_rays>
std::unique_ptr<Method> make_rays_on_device(const MethodSite& site, const Parameters& parameters) {
  return make_ray_device_method(*site.renderer, parameters, make_rays(site.renderer->device(), site.scene));
}

}  // namespace sightline::methods
