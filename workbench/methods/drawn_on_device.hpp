// Methods that decide on the CPU, drawn by a device.
#pragma once

#include <sightline/workbench/method.hpp>

#include "workbench/device/renderer.hpp"

namespace sightline::methods {

/// Records what the method hands over: objects in its order, or ranges of its own triangles. The renderer
/// outlives the method.
std::unique_ptr<Method> draw_on_device(std::unique_ptr<Method> method, device::Renderer& renderer);

}  // namespace sightline::methods
