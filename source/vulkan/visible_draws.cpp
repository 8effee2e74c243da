#include "vulkan/visible_draws.hpp"

namespace sightline::vulkan {

namespace {

constexpr std::uint32_t kScanBlocks[] =
#include "shaders/scan_blocks.comp.inc"
    ;
constexpr std::uint32_t kScanSums[] =
#include "shaders/scan_sums.comp.inc"
    ;
constexpr std::uint32_t kScanWrite[] =
#include "shaders/scan_write.comp.inc"
    ;
constexpr std::uint32_t kDrawCommands[] =
#include "shaders/draw_commands.comp.inc"
    ;

constexpr std::uint32_t kBlock = 256;

struct Push {
  vk::DeviceAddress flags, slot_objects, prefix, sums, list, meshes, objects, commands, transparent_order;
  VisibleDraws::Condition condition, transparent_condition;
  std::uint32_t opaque, mesh_count, transparent;
};

}  // namespace

VisibleDraws::VisibleDraws(Device& device, const SceneBuffers& scene)
    : scene_(scene),
      scan_blocks_(device, kScanBlocks),
      scan_sums_(device, kScanSums),
      scan_write_(device, kScanWrite),
      draw_commands_(device, kDrawCommands),
      prefix_(device, (std::uint64_t{scene.opaque} + 1) * 4, Memory::device, "prefix sums"),
      sums_(device, (std::uint64_t{scene.opaque} / kBlock + 1) * 4, Memory::device, "prefix sums") {}

DrawBuffers VisibleDraws::make_buffers(Device& device) const {
  const auto transparent = static_cast<std::uint32_t>(scene_.transparent_ids.size());
  DrawBuffers out{Buffer(device, std::uint64_t{scene_.objects} * 4, Memory::device, "a draw list"),
                  Buffer(device, (std::uint64_t{scene_.meshes} + transparent) * sizeof(shared::CommandData),
                         Memory::device, "draw commands"),
                  scene_.meshes, transparent};
  device.run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(out.commands.handle(), 0, VK_WHOLE_SIZE, 0);
    full_barrier(commands);
  });
  return out;
}

void VisibleDraws::build(const Recorder& frame, vk::DeviceAddress flags, Condition opaque,
                         Condition transparent, vk::DeviceAddress transparent_order,
                         const DrawBuffers& out) const {
  const std::uint32_t transparent_count = transparent_order ? out.transparent_commands : 0;
  const Push push{flags,
                  scene_.slot_objects.address(),
                  prefix_.address(),
                  sums_.address(),
                  out.list.address(),
                  scene_.mesh_data.address(),
                  scene_.object_data.address(),
                  out.commands.address(),
                  transparent_order,
                  opaque,
                  transparent,
                  scene_.opaque,
                  scene_.meshes,
                  transparent_count};
  if (scene_.opaque > 0) frame.dispatch(scan_blocks_, push, scene_.opaque, kBlock);
  frame.dispatch(scan_sums_, push, 1, kBlock);
  if (scene_.opaque > 0) frame.dispatch(scan_write_, push, scene_.opaque, kBlock);
  frame.dispatch(draw_commands_, push, std::max(1u, scene_.meshes + transparent_count), kBlock);
}

}  // namespace sightline::vulkan
