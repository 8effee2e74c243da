#include "workbench/device/recorder.hpp"

#include "library/geometry/mutant.h"

namespace sightline::device {

Recorder::Recorder(const Device& device, const vk::raii::CommandBuffer& commands, Timer& timer,
                   const View& view, bool reversed, vk::DescriptorSet view_set, const Targets& targets)
    : commands(commands), view(view), targets(targets), device_(device), timer_(timer), reversed_(reversed) {
  for (const auto point : {vk::PipelineBindPoint::eGraphics, vk::PipelineBindPoint::eCompute}) {
    commands.bindDescriptorSets(point, *device.layout(), 0, view_set, {});
  }
}

Recorder::Pass::Pass(Recorder& frame, std::string_view name, PassKind kind) : frame_(frame) {
  full_barrier(frame_.commands);
  frame_.timer_.begin(frame_.commands, name, kind);
  // llvmpipe takes a timestamp when the work around it is flushed, and dispatches run at once: without this
  // barrier a pass that begins with one would not count it.
  full_barrier(frame_.commands);
}

Recorder::Pass::~Pass() {
  full_barrier(frame_.commands);
  frame_.timer_.end(frame_.commands);
}

void Recorder::begin_rendering(const Into& into) const {
  const Image& depth_image = into.depth ? *into.depth : targets.depth;
  const auto load = [](bool clear) {
    return clear ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad;
  };
  vk::RenderingAttachmentInfo colour, depth;
  if (into.colour) {
    colour.imageView = into.colour->view();
    colour.imageLayout = into.colour->layout();
    colour.loadOp = load(into.clear_colour);
    colour.storeOp = vk::AttachmentStoreOp::eStore;
    colour.clearValue.color = vk::ClearColorValue(into.clear_value);
  }
  depth.imageView = depth_image.view();
  depth.imageLayout = into.read_depth ? kReadLayout : depth_image.layout();
  depth.loadOp = load(into.clear_depth);
  depth.storeOp = into.read_depth ? vk::AttachmentStoreOp::eNone : vk::AttachmentStoreOp::eStore;
  depth.clearValue.depthStencil = vk::ClearDepthStencilValue{reversed() ? 0.0f : 1.0f, 0};
  vk::RenderingInfo info;
  info.renderArea = vk::Rect2D{{0, 0}, {depth_image.width(), depth_image.height()}};
  info.layerCount = 1;
  if (into.colour) info.setColorAttachments(colour);
  info.pDepthAttachment = &depth;
  commands.beginRendering(info);
}

void Recorder::bind(const GraphicsPipeline& pipeline, Compare compare, float bias,
                    vk::CullModeFlagBits culled) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline.handle());
  const auto width = static_cast<float>(targets.depth.width()),
             height = static_cast<float>(targets.depth.height());
  // A negative height turns Vulkan's y down into the View convention's y up.
  commands.setViewport(0, vk::Viewport{0, height, width, -height, 0, 1});
  commands.setScissor(0, vk::Rect2D{{0, 0}, {targets.depth.width(), targets.depth.height()}});
  const bool equal = compare == Compare::equal;
  commands.setDepthCompareOp(equal        ? vk::CompareOp::eEqual
                             : reversed() ? vk::CompareOp::eGreaterOrEqual
                                          : vk::CompareOp::eLessOrEqual);
  commands.setCullMode(culled);
  if (SIGHTLINE_MUTANT(boxes_without_depth_bias)) bias = 0;
  commands.setDepthBias(reversed() ? bias : -bias, 0, 0);
}

void Recorder::fill(const Buffer& buffer, std::uint32_t word, vk::DeviceSize bytes) const {
  commands.fillBuffer(buffer.handle(), 0, std::max<vk::DeviceSize>(bytes, 4), word);
  full_barrier(commands);
}

}  // namespace sightline::device
