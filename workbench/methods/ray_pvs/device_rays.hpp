// The GPU methods of Ye et al. 2023 without a frame around them: rays in, hits and marks out.
#pragma once

#include <memory>

#include <sightline/workbench/scene.hpp>

#include "library/rays/ray_grid.hpp"
#include "library/rays/ray_hits.hpp"
#include "workbench/device/buffer.hpp"
#include "workbench/device/pipeline.hpp"
#include "workbench/methods/ray_pvs/ray_targets.hpp"

namespace sightline::methods {

/// Milliseconds of one cast, apart as the paper's section 4 asks.
struct DeviceRayTimes {
  double cpu = 0;        ///< work on the CPU between rays and upload: BVHA's walk
  double upload = 0;     ///< copying into memory that the device reads
  double compute = 0;    ///< from submission to the finished hits
  double read_back = 0;  ///< copying the hits back
};

class DeviceRays {
public:
  virtual ~DeviceRays() = default;
  DeviceRays(const DeviceRays&) = delete;
  DeviceRays& operator=(const DeviceRays&) = delete;

  /// Takes over moved objects; the device must be idle.
  void update();
  /// Sends a grid's rays and what else the method needs of the CPU; the device must be idle.
  void prepare(const rays::RayGrid& grid);
  /// Records the cast of the prepared rays: every pass, with barriers around.
  void record(const vk::raii::CommandBuffer& commands);
  /// One word an object, 1 where a ray met it.
  [[nodiscard]] const device::Buffer& marks() const noexcept {
    return targets_.mixed() ? object_marks_ : marks_;
  }
  [[nodiscard]] std::size_t ray_count() const noexcept { return rays_; }

  /// All of it at once, for whoever wants the hits themselves, at what stops rays: targets() says whose.
  void cast(const rays::RayGrid& grid, rays::RayHits& hits, DeviceRayTimes* times = nullptr);
  [[nodiscard]] const RayTargets& targets() const noexcept { return targets_; }

protected:
  DeviceRays(device::Device& device, const Scene& scene);
  virtual void prepare_more(const rays::RayGrid&) {}
  /// Sends targets_.solid() anew, whose numbers hits and marks_ are in.
  virtual void send() = 0;
  virtual void record_passes(const vk::raii::CommandBuffer& commands) = 0;

  /// Makes `buffer` hold at least `bytes`.
  void grow(device::Buffer& buffer, std::size_t bytes, device::Memory memory, std::string_view what);
  template <class T>
  void dispatch(const vk::raii::CommandBuffer& commands, const device::ComputePipeline& pipeline,
                const T& push, std::uint32_t groups_x, std::uint32_t groups_y = 1) const {
    static_assert(sizeof(T) <= 128);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline.handle());
    commands.pushConstants<T>(*device_.layout(), vk::ShaderStageFlagBits::eAll, 0, push);
    commands.dispatch(groups_x, groups_y, 1);
    device::full_barrier(commands);
  }

  void send_see_through();

  device::Device& device_;
  const Scene& scene_;
  RayTargets targets_;
  std::size_t rays_ = 0;
  double cpu_ms_ = 0, upload_ms_ = 0;
  device::Buffer ray_buffer_, hits_, marks_;

private:
  device::ComputePipeline see_through_;
  device::Buffer slot_objects_, see_through_nodes_, object_marks_;  ///< where something hides nothing
};

/// A lane a pair of ray and box, as the paper has it; and the same set by lanes of eight rays and many boxes.
std::unique_ptr<DeviceRays> make_iwcpa(device::Device& device, const Scene& scene);
std::unique_ptr<DeviceRays> make_tuned_iwcpa(device::Device& device, const Scene& scene);
std::unique_ptr<DeviceRays> make_bvha(device::Device& device, const Scene& scene);
std::unique_ptr<DeviceRays> make_saa(device::Device& device, const Scene& scene);

}  // namespace sightline::methods
