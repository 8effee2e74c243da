// One frame being recorded: named passes, rendering into the targets, draws, dispatches.
#pragma once

#include <cstddef>
#include <span>

#include <sightline/view.hpp>

#include "workbench/device/image.hpp"
#include "workbench/device/pipeline.hpp"
#include "workbench/device/shared.h"
#include "workbench/device/timer.hpp"

namespace sightline::device {

struct Targets {
  Image colour, depth;
  Targets(Device& device, std::uint32_t width, std::uint32_t height)
      : colour(device, kColourFormat, width, height, "the picture"),
        depth(device, kDepthFormat, width, height, "depth") {}
};

/// Depth bias in units of the last place towards the eye, for occlusion tests by bounding boxes.
inline constexpr float kTestBias = 4;

class Recorder {
public:
  Recorder(const Device& device, const vk::raii::CommandBuffer& commands, Timer& timer, const View& view,
           bool reversed, vk::DescriptorSet view_set, const Targets& targets);

  const vk::raii::CommandBuffer& commands;
  const View& view;
  const Targets& targets;

  /// Whether the near plane lies at depth 1.
  [[nodiscard]] bool reversed() const noexcept { return reversed_; }

  /// A named pass with a timestamp at either end, and a barrier before and after.
  class Pass {
  public:
    Pass(Recorder& frame, std::string_view name, PassKind kind);
    ~Pass();
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

  private:
    Recorder& frame_;
  };
  [[nodiscard]] Pass pass(std::string_view name, PassKind kind) { return {*this, name, kind}; }

  struct Into {
    const Image* colour = nullptr;  ///< none: depth only
    const Image* depth = nullptr;   ///< null: the frame's own
    bool clear_colour = false, clear_depth = false;
    bool read_depth = false;  ///< between Image::begin_reading() and end_reading(): tested, never written
    std::array<std::uint32_t, 4> clear_value{};  ///< bits of the clear colour
  };
  void begin_rendering(const Into& into) const;
  void end_rendering() const { commands.endRendering(); }

  enum class Compare : std::uint8_t { nearer_or_equal, equal };
  /// Binds a pipeline with the frame's viewport; `bias` moves depths towards the eye, in units of the last
  /// place. Triangles that run clockwise as seen are back faces.
  void bind(const GraphicsPipeline& pipeline, Compare compare = Compare::nearer_or_equal, float bias = 0,
            vk::CullModeFlagBits culled = vk::CullModeFlagBits::eNone) const;

  template <class T>
  void push(const T& constants) const {
    static_assert(sizeof(T) <= 128);
    commands.pushConstants<T>(*device_.layout(), vk::ShaderStageFlagBits::eAll, 0, constants);
  }

  /// Workgroups that fit side by side.
  [[nodiscard]] std::uint32_t widest_dispatch() const noexcept { return device_.widest_dispatch(); }

  /// Runs at least `threads` invocations in groups of `group`, laid out as invocation.h reads them, then
  /// makes their writes seen.
  template <class T>
  void dispatch(const ComputePipeline& pipeline, const T& constants, std::uint32_t threads,
                std::uint32_t group = 256) const {
    const std::uint32_t groups = (threads + group - 1) / group, widest = widest_dispatch();
    run(pipeline, constants, std::min(groups, widest), (groups + widest - 1) / widest);
  }
  /// Runs `rows` of `groups` workgroups each.
  template <class T>
  void run(const ComputePipeline& pipeline, const T& constants, std::uint32_t groups,
           std::uint32_t rows) const {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline.handle());
    push(constants);
    commands.dispatch(groups, rows, 1);
    full_barrier(commands);
  }

  /// Where the device finds how many groups to run: a VkDispatchIndirectCommand.
  struct Groups {
    const Buffer& buffer;
    vk::DeviceSize offset = 0;
    [[nodiscard]] vk::DeviceAddress address() const noexcept { return buffer.address() + offset; }
  };
  template <class T>
  void dispatch(const ComputePipeline& pipeline, const T& constants, const Groups& groups) const {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline.handle());
    push(constants);
    commands.dispatchIndirect(groups.buffer.handle(), groups.offset);
    full_barrier(commands);
  }

  /// Sets `bytes` of a buffer to a word, then makes them seen.
  void fill(const Buffer& buffer, std::uint32_t word, vk::DeviceSize bytes) const;

private:
  const Device& device_;
  Timer& timer_;
  bool reversed_;
};

}  // namespace sightline::device
