// A scene on a Vulkan device with the methods under examination there.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "workbench/device/item_buffer.hpp"
#include "workbench/methods/device_method.hpp"
#include "workbench/oracle/item_buffer.hpp"

namespace sightline::measure {

struct DeviceContestant {
  std::string name;  ///< the specification it was made from
  std::unique_ptr<methods::DeviceMethod> method;
};

class Workbench {
public:
  /// Scene and device outlive the workbench. Throws Error for a method that does not exist or does not fit.
  Workbench(device::Device& device, Scene& scene, std::span<const std::string> specifications);

  [[nodiscard]] Scene& scene() noexcept { return scene_; }
  [[nodiscard]] device::Renderer& renderer() noexcept { return renderer_; }
  [[nodiscard]] std::span<DeviceContestant> contestants() noexcept { return contestants_; }
  [[nodiscard]] methods::DeviceMethod& reference() noexcept { return *reference_; }

  /// One frame of one method, which is told what it took.
  device::FrameTimes draw(methods::DeviceMethod& method, const View& view,
                          device::Renderer::Timed timed = device::Renderer::Timed::frame);
  /// The rasteriser's verdict. The next picture is drawn anew in any case.
  [[nodiscard]] oracle::ItemBuffer judge(const View& view);
  /// For a method that draws triangles of its own: what all of them look like to the rasteriser, opaque ones
  /// alone, and their picture. Nothing for the rest, whose truth is the scene's.
  [[nodiscard]] std::optional<oracle::ItemBuffer> judge_own(methods::DeviceMethod& method, const View& view);
  [[nodiscard]] device::Picture own_picture(methods::DeviceMethod& method, const View& view,
                                            methods::DeviceMethod::Order order);
  /// Tells everybody who holds a copy that these objects have moved.
  void update(std::span<const ObjectId> moved);

private:
  Scene& scene_;
  device::Renderer renderer_;
  device::ItemBufferPass judge_;
  std::unique_ptr<methods::DeviceMethod> reference_;
  std::vector<DeviceContestant> contestants_;
};

/// Moves a share of the objects a little every time, each about where it first stood, so that a scene keeps
/// its shape however long it is watched. Same seed, same moves.
class Mover {
public:
  Mover(Scene& scene, double share, std::uint64_t seed);
  /// The objects that have moved.
  std::span<const ObjectId> move();

private:
  Scene& scene_;
  std::size_t count_;
  std::uint64_t seed_;
  std::vector<Affine> home_;
  std::vector<ObjectId> order_;
};

}  // namespace sightline::measure
