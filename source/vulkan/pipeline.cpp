#include "vulkan/pipeline.hpp"

#include <array>

#include "vulkan/image.hpp"

namespace sightline::vulkan {

namespace {

vk::raii::ShaderModule module(const Device& device, Spirv code) {
  return {device.handle(), vk::ShaderModuleCreateInfo{{}, code.size_bytes(), code.data()}};
}

std::vector<vk::SpecializationMapEntry> entries(Words constants) {
  std::vector<vk::SpecializationMapEntry> out;
  for (std::uint32_t i = 0; i < constants.size(); ++i) out.push_back({i, 4 * i, 4});
  return out;
}

}  // namespace

ComputePipeline::ComputePipeline(const Device& device, Spirv shader, Words constants) {
  const vk::raii::ShaderModule code = module(device, shader);
  const auto map = entries(constants);
  const vk::SpecializationInfo specialisation(
      map, vk::ArrayProxyNoTemporaries<const std::uint32_t>(static_cast<std::uint32_t>(constants.size()),
                                                            constants.data()));
  const vk::PipelineShaderStageCreateInfo stage{
      {}, vk::ShaderStageFlagBits::eCompute, *code, "main", &specialisation};
  pipeline_.emplace(device.handle(), nullptr, vk::ComputePipelineCreateInfo{{}, stage, *device.layout()});
}

GraphicsPipeline::GraphicsPipeline(const Device& device, const GraphicsState& state) {
  using Stage = vk::ShaderStageFlagBits;
  std::vector<vk::raii::ShaderModule> modules;
  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  const auto map = entries(state.constants);
  const vk::SpecializationInfo specialisation(
      map, vk::ArrayProxyNoTemporaries<const std::uint32_t>(
               static_cast<std::uint32_t>(state.constants.size()), state.constants.data()));
  for (const auto& [code, stage] :
       {std::pair{state.vertex, Stage::eVertex}, std::pair{state.geometry, Stage::eGeometry},
        std::pair{state.fragment, Stage::eFragment}}) {
    if (code.empty()) continue;
    modules.push_back(module(device, code));
    stages.push_back({{}, stage, *modules.back(), "main", &specialisation});
  }
  const bool mesh = state.input == Input::mesh;
  const vk::VertexInputBindingDescription binding{0, mesh ? 24u : 32u};
  const std::array attributes{
      vk::VertexInputAttributeDescription{0, 0, vk::Format::eR32G32B32Sfloat, 0},
      vk::VertexInputAttributeDescription{1, 0, vk::Format::eR32G32B32Sfloat, mesh ? 12u : 16u},
      vk::VertexInputAttributeDescription{2, 0, vk::Format::eR32Uint, 12}};
  vk::PipelineVertexInputStateCreateInfo input;
  if (state.input != Input::none) {
    input.setVertexBindingDescriptions(binding);
    input.vertexAttributeDescriptionCount = mesh ? 2 : 3;
    input.pVertexAttributeDescriptions = attributes.data();
  }
  const vk::PipelineInputAssemblyStateCreateInfo assembly{{}, state.topology};
  const vk::PipelineViewportStateCreateInfo viewport{{}, 1, nullptr, 1, nullptr};
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.cullMode = state.cull_back ? vk::CullModeFlagBits::eBack : vk::CullModeFlagBits::eNone;
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
      Factor::eZero,
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
                           vk::DynamicState::eDepthCompareOp, vk::DynamicState::eDepthBias};
  const vk::PipelineDynamicStateCreateInfo dynamic_state{{}, dynamic};
  vk::GraphicsPipelineCreateInfo info{{},      stages,   &input, &assembly, nullptr,        &viewport,
                                      &raster, &samples, &depth, &blend,    &dynamic_state, *device.layout()};
  info.pNext = &rendering;
  pipeline_.emplace(device.handle(), nullptr, info);
}

}  // namespace sightline::vulkan
