// What each device method's file gives to the registry.
#pragma once

#include "workbench/methods/device_method.hpp"

namespace sightline::methods {

extern const DeviceMethodInfo kNoneOnDevice;
extern const DeviceMethodInfo kVfcVcOnDevice;
extern const DeviceMethodInfo kRoc;
extern const DeviceMethodInfo kHroc;
extern const DeviceMethodInfo kVertexChunk;
extern const DeviceMethodInfo kResidentChunk;
extern const DeviceMethodInfo kHiz;

template <class M>
std::unique_ptr<DeviceMethod> make_on_device(device::Renderer& renderer, const Parameters& parameters) {
  return std::make_unique<M>(renderer, parameters);
}

}  // namespace sightline::methods
