// Compute and graphics pipelines out of embedded SPIR-V.
#pragma once

#include <span>

#include "workbench/device/device.hpp"

namespace sightline::device {

using Spirv = std::span<const std::uint32_t>;
/// Values of the specialisation constants 0, 1, … of all stages, a word each.
using Words = std::span<const std::uint32_t>;

class ComputePipeline {
public:
  ComputePipeline(const Device& device, Spirv shader, Words constants = {});
  [[nodiscard]] vk::Pipeline handle() const noexcept { return **pipeline_; }

private:
  std::optional<vk::raii::Pipeline> pipeline_;
};

/// What vertices a graphics pipeline reads from its vertex buffer.
enum class Input : std::uint8_t {
  none,
  mesh,    ///< position and normal, 24 bytes
  point,   ///< centre, object id and half extent, 32 bytes (world::ChunkVertex)
  corner,  ///< position, object id and colour, 20 bytes (shared::CornerData)
};

struct GraphicsState {
  Spirv vertex, geometry = {}, fragment = {};
  Words constants = {};
  Input input = Input::none;
  vk::PrimitiveTopology topology = vk::PrimitiveTopology::eTriangleList;
  vk::Format colour = vk::Format::eUndefined;  ///< of the one colour attachment, if there is one
  bool blend = false;
  bool depth_write = true;
};

/// Draws with a depth attachment. Viewport, scissor, the depth comparison, the depth bias and the side that
/// is culled are dynamic; Recorder::bind sets them.
class GraphicsPipeline {
public:
  GraphicsPipeline(const Device& device, const GraphicsState& state);
  [[nodiscard]] vk::Pipeline handle() const noexcept { return **pipeline_; }

private:
  std::optional<vk::raii::Pipeline> pipeline_;
};

}  // namespace sightline::device
