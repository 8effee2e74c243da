// The contract of culling methods that work on a Vulkan device: what Method is on the CPU.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/parameters.hpp>

#include "workbench/device/renderer.hpp"

namespace sightline::methods {

/// One method at work on one renderer's scene. The renderer outlives the method.
class DeviceMethod {
public:
  virtual ~DeviceMethod() = default;
  DeviceMethod() = default;
  DeviceMethod(const DeviceMethod&) = delete;
  DeviceMethod& operator=(const DeviceMethod&) = delete;

  [[nodiscard]] virtual Guarantee guarantee() const noexcept = 0;
  /// Told after Scene::move_object and Renderer::update of each of `objects`, before the next frame.
  virtual void update(std::span<const ObjectId> objects) = 0;
  /// Records culling and drawing, each in named passes. What is left in the targets is the picture.
  virtual void record(device::Recorder& frame) = 0;
  /// What the last frame drew, ascending by id, and its counts; not part of a frame, for checking. Draws are
  /// left empty: they stay on the device.
  virtual void read_back(Frame& frame) = 0;
  /// Told what the last frame took, as Method::took is.
  virtual void took([[maybe_unused]] double milliseconds) noexcept {}
  /// For a method that draws triangles of its own, in their own shading and perhaps their front faces alone:
  /// records all of them, the picture that its frames are to be compared with. Of opaque triangles at one
  /// depth the first drawn shows, which is another in the other order. False, and nothing recorded, for the
  /// rest, whose picture is the scene's.
  enum class Order : std::uint8_t { rising, falling };
  virtual bool record_everything([[maybe_unused]] device::Recorder& frame, [[maybe_unused]] Order order) {
    return false;
  }
  /// Which object each pixel of that picture shows, row 0 first, transparent ones left out; nothing for the
  /// rest. Draws and waits.
  virtual std::optional<std::vector<ObjectId>> everything_seen([[maybe_unused]] const View& view) {
    return std::nullopt;
  }
};

struct DeviceMethodInfo {
  std::string_view name;
  std::string_view paper;
  std::string_view summary;
  Guarantee guarantee;     ///< with default parameters
  std::string_view needs;  ///< "" or the device feature it needs
  std::span<const ParameterInfo> parameters;
  std::unique_ptr<DeviceMethod> (*create)(device::Renderer&, const Parameters&);
};

/// The methods that have a form of their own on the device.
std::span<const DeviceMethodInfo> device_methods() noexcept;
const DeviceMethodInfo* find_device_method(std::string_view name) noexcept;

/// Makes a method from "NAME" or "NAME?key=value&…": its device form where there is one, else its CPU form,
/// drawn by the renderer. Throws Error for unknown names, keys and values, and for what scene or device lack.
std::unique_ptr<DeviceMethod> create_device_method(std::string_view specification,
                                                   device::Renderer& renderer);

/// Any CPU method, drawn by the renderer.
std::unique_ptr<DeviceMethod> draw_by_device(std::unique_ptr<Method> method, device::Renderer& renderer);

/// Names of all methods, of either form, that fit the scene, in the order of the documentation.
std::vector<std::string> methods_on_device(const Scene& scene);

}  // namespace sightline::methods
