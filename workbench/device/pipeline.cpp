#include "workbench/device/pipeline.hpp"

#include <array>

#include "library/geometry/mutant.h"
#include "workbench/device/image.hpp"
#include "workbench/device/shared.h"

namespace sightline::device {

namespace {

class VertexInput {
public:
  explicit VertexInput(Input input) {
    using enum vk::Format;
    switch (input) {
      case Input::none:
        break;
      case Input::mesh:
        set(24, {{0, 0, eR32G32B32Sfloat, 0}, {1, 0, eR32G32B32Sfloat, 12}});
        break;
      case Input::point:
        set(32, {{0, 0, eR32G32B32Sfloat, 0}, {1, 0, eR32G32B32Sfloat, 16}, {2, 0, eR32Uint, 12}});
        break;
      case Input::corner:
        set(sizeof(shared::CornerData),
            {{0, 0, eR32G32B32Sfloat, 0}, {1, 0, eR32Uint, 12}, {2, 0, eR32Uint, 16}});
        break;
    }
  }
  /// Points into this.
  [[nodiscard]] vk::PipelineVertexInputStateCreateInfo info() const {
    vk::PipelineVertexInputStateCreateInfo input;
    if (attributes_.empty()) return input;
    input.setVertexBindingDescriptions(binding_);
    input.setVertexAttributeDescriptions(attributes_);
    return input;
  }

private:
  void set(std::uint32_t stride, std::vector<vk::VertexInputAttributeDescription> attributes) {
    binding_.stride = stride;
    attributes_ = std::move(attributes);
  }

  vk::VertexInputBindingDescription binding_;
  std::vector<vk::VertexInputAttributeDescription> attributes_;
};

vk::raii::ShaderModule module(const Device& device, Spirv code) {
  return {device.handle(), vk::ShaderModuleCreateInfo{{}, code.size_bytes(), code.data()}};
}

/// The specialisation constants 0, 1, … of a pipeline; where there are mutants, also which of them is
/// planted.
class Constants {
public:
  explicit Constants(Words values) : values_(values.begin(), values.end()) {
    for (std::uint32_t i = 0; i < values.size(); ++i) entries_.push_back({i, 4 * i, 4});
#ifdef SIGHTLINE_MUTANTS
    entries_.push_back({100, static_cast<std::uint32_t>(4 * values.size()), 4});
    values_.push_back(mutants::kPlanted);
#endif
  }
  /// Points into this.
  [[nodiscard]] vk::SpecializationInfo info() const {
    vk::SpecializationInfo info;
    info.setMapEntries(entries_);
    info.setData<std::uint32_t>(values_);
    return info;
  }

private:
  std::vector<std::uint32_t> values_;
  std::vector<vk::SpecializationMapEntry> entries_;
};

}  // namespace

ComputePipeline::ComputePipeline(const Device& device, Spirv shader, Words constants) {
  const vk::raii::ShaderModule code = module(device, shader);
  const Constants held(constants);
  const vk::SpecializationInfo specialisation = held.info();
  const vk::PipelineShaderStageCreateInfo stage{
      {}, vk::ShaderStageFlagBits::eCompute, *code, "main", &specialisation};
  pipeline_.emplace(device.handle(), nullptr, vk::ComputePipelineCreateInfo{{}, stage, *device.layout()});
}

GraphicsPipeline::GraphicsPipeline(const Device& device, const GraphicsState& state) {
  using Stage = vk::ShaderStageFlagBits;
  std::vector<vk::raii::ShaderModule> modules;
  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  const Constants constants(state.constants);
  const vk::SpecializationInfo specialisation = constants.info();
  for (const auto& [code, stage] :
       {std::pair{state.vertex, Stage::eVertex}, std::pair{state.geometry, Stage::eGeometry},
        std::pair{state.fragment, Stage::eFragment}}) {
    if (code.empty()) continue;
    modules.push_back(module(device, code));
    stages.push_back({{}, stage, *modules.back(), "main", &specialisation});
  }
  const VertexInput vertices(state.input);
  const vk::PipelineVertexInputStateCreateInfo input = vertices.info();
  const vk::PipelineInputAssemblyStateCreateInfo assembly{{}, state.topology};
  const vk::PipelineViewportStateCreateInfo viewport{{}, 1, nullptr, 1, nullptr};
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.depthBiasEnable = VK_TRUE;
  raster.lineWidth = 1;
  const vk::PipelineMultisampleStateCreateInfo samples;
  const vk::PipelineDepthStencilStateCreateInfo depth{
      {}, VK_TRUE, state.depth_write, vk::CompareOp::eLessOrEqual};
  using Factor = vk::BlendFactor;
  using Component = vk::ColorComponentFlagBits;
  const vk::PipelineColorBlendAttachmentState attachment{
      state.blend,
      Factor::eSrcAlpha,
      Factor::eOneMinusSrcAlpha,
      vk::BlendOp::eAdd,
      Factor::eOne,  // what is opaque stays so
      Factor::eOneMinusSrcAlpha,
      vk::BlendOp::eAdd,
      Component::eR | Component::eG | Component::eB | Component::eA};
  vk::PipelineColorBlendStateCreateInfo blend;
  vk::PipelineRenderingCreateInfo rendering;
  if (state.colour != vk::Format::eUndefined) {
    blend.setAttachments(attachment);
    rendering.setColorAttachmentFormats(state.colour);
  }
  rendering.depthAttachmentFormat = kDepthFormat;
  const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                           vk::DynamicState::eDepthCompareOp, vk::DynamicState::eDepthBias,
                           vk::DynamicState::eCullMode};
  const vk::PipelineDynamicStateCreateInfo dynamic_state{{}, dynamic};
  vk::GraphicsPipelineCreateInfo info{{},      stages,   &input, &assembly, nullptr,        &viewport,
                                      &raster, &samples, &depth, &blend,    &dynamic_state, *device.layout()};
  info.pNext = &rendering;
  pipeline_.emplace(device.handle(), nullptr, info);
}

}  // namespace sightline::device
