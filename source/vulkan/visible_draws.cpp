#include "vulkan/visible_draws.hpp"

#include <algorithm>
#include <array>

namespace sightline::vulkan {

namespace {

constexpr std::uint32_t kScanBlocks[] =
#include "shaders/scan_blocks.comp.inc"
    ;
constexpr std::uint32_t kScanWrite[] =
#include "shaders/scan_write.comp.inc"
    ;

// As in scan.h.
constexpr std::uint32_t kLanes = 256, kBlockSlots = kLanes * 8;

struct Push {
  vk::DeviceAddress flags, slot_objects, scan, meshes, objects, transparent_order;
  std::array<vk::DeviceAddress, 2> lists, commands;
  std::array<VisibleDraws::Condition, 2> conditions;
  VisibleDraws::Condition transparent_condition;
  std::uint32_t opaque, mesh_count, transparent;
};

std::uint32_t block_count(const SceneBuffers& scene) {
  return (scene.opaque + kBlockSlots - 1) / kBlockSlots;
}

}  // namespace

VisibleDraws::VisibleDraws(Device& device, const SceneBuffers& scene)
    : scene_(scene),
      scan_blocks_(device, kScanBlocks),
      scan_write_(device, kScanWrite),
      scan_(device, 2 * (std::uint64_t{scene.opaque} + block_count(scene) + 2) * 4, Memory::device,
            "prefix sums") {}

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
                         Condition transparent, vk::DeviceAddress transparent_order, const DrawBuffers& out,
                         Condition second, const DrawBuffers* second_out) const {
  const std::uint32_t lists = second_out != nullptr ? 2 : 1;
  const Push push{flags,
                  scene_.slot_objects.address(),
                  scan_.address(),
                  scene_.mesh_data.address(),
                  scene_.object_data.address(),
                  transparent_order,
                  {out.list.address(), second_out ? second_out->list.address() : 0},
                  {out.commands.address(), second_out ? second_out->commands.address() : 0},
                  {opaque, second},
                  transparent,
                  scene_.opaque,
                  scene_.meshes,
                  transparent_order ? out.transparent_commands : 0};
  const std::uint32_t threads = std::max(1u, block_count(scene_)) * kLanes;
  frame.dispatch(scan_blocks_, push, threads, kLanes, lists);
  frame.dispatch(scan_write_, push, threads, kLanes, lists);
}

}  // namespace sightline::vulkan
