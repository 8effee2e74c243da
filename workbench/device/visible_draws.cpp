#include "workbench/device/visible_draws.hpp"

#include <algorithm>
#include <array>

namespace sightline::device {

namespace {

constexpr std::uint32_t kScanBlocks[] =
#include "shaders/scan_blocks.comp.inc"
    ;
constexpr std::uint32_t kScanWrite[] =
#include "shaders/scan_write.comp.inc"
    ;

// As in scan.h.
constexpr std::uint32_t kLanes = 64, kBlockSlots = kLanes * 32;

struct Push {
  vk::DeviceAddress flags, slot_objects, scan, meshes, objects, transparent_order;
  std::array<vk::DeviceAddress, 2> lists, commands;
  std::array<VisibleDraws::Condition, 2> conditions;
  VisibleDraws::Condition rest_condition;
  std::uint32_t solid, ordered, batch_count, transparent, list_count, widest;
};

std::uint32_t block_count(const SceneBuffers& scene) {
  return scene.ordered / kBlockSlots + 1;
}

std::uint64_t word_count(const SceneBuffers& scene) {
  return std::uint64_t{scene.ordered} / 32 + 1;
}

std::uint64_t done_at(const SceneBuffers& scene) {
  return 2 * (2 * word_count(scene) + block_count(scene));
}

std::uint64_t candidates_at(const SceneBuffers& scene) {
  return done_at(scene) + 5;
}

Push push_of(const SceneBuffers& scene, const Buffer& scan, const Recorder& frame, vk::DeviceAddress flags,
             const VisibleDraws::List& first, vk::DeviceAddress transparent_order,
             const VisibleDraws::List* second) {
  using List = VisibleDraws::List;
  const auto list = [](const List* of) { return of ? of->out->list.address() : 0; };
  const auto commands = [](const List* of) { return of ? of->out->commands.address() : 0; };
  return {flags,
          scene.slot_objects.address(),
          scan.address(),
          scene.mesh_data.address(),
          scene.object_data.address(),
          transparent_order,
          {list(&first), list(second)},
          {commands(&first), commands(second)},
          {first.solid, second ? second->solid : VisibleDraws::Condition{}},
          first.rest,
          scene.solid,
          scene.ordered,
          scene.batch_count(),
          transparent_order ? first.out->count_of(submission::DrawState::blended) : 0,
          second ? 2u : 1u,
          frame.widest_dispatch()};
}

}  // namespace

VisibleDraws::VisibleDraws(Device& device, const SceneBuffers& scene)
    : scene_(scene),
      scan_blocks_(device, kScanBlocks),
      scan_candidates_(device, kScanBlocks, std::array{1u}),
      scan_write_(device, kScanWrite),
      scan_(device, (candidates_at(scene) + word_count(scene)) * 4, Memory::device, "prefix sums") {
  device.run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(scan_.handle(), 0, VK_WHOLE_SIZE, 0);
    full_barrier(commands);
  });
}

DrawBuffers VisibleDraws::make_buffers(Device& device) const {
  const auto transparent = static_cast<std::uint32_t>(scene_.transparent_ids.size());
  const std::uint64_t commands = std::uint64_t{scene_.batch_count()} + transparent;
  DrawBuffers out{Buffer(device, std::uint64_t{scene_.objects} * 4, Memory::device, "a draw list"),
                  Buffer(device, commands * sizeof(shared::CommandData), Memory::device, "draw commands"),
                  {}};
  std::ranges::copy(scene_.batches, out.commands_of.begin());
  out.commands_of.back() = transparent;
  device.run([&](const vk::raii::CommandBuffer& record) {
    record.fillBuffer(out.commands.handle(), 0, VK_WHOLE_SIZE, 0);
    full_barrier(record);
  });
  return out;
}

std::uint32_t VisibleDraws::groups() const noexcept {
  return block_count(scene_);
}

Recorder::Groups VisibleDraws::listed() const noexcept {
  return {scan_, (done_at(scene_) + 1) * 4};
}

vk::DeviceAddress VisibleDraws::candidates() const noexcept {
  return scan_.address() + candidates_at(scene_) * 4;
}

void VisibleDraws::build(const Recorder& frame, vk::DeviceAddress flags, const List& first,
                         vk::DeviceAddress transparent_order, const List* second, Among among) const {
  const Push push = push_of(scene_, scan_, frame, flags, first, transparent_order, second);
  frame.run(among == Among::candidates ? scan_candidates_ : scan_blocks_, push, groups(), 1);
  frame.run(scan_write_, push, groups(), push.list_count);
}

void VisibleDraws::build_where(const Recorder& frame, vk::DeviceAddress flags, const List& list,
                               const Recorder::Groups& groups) const {
  const Push push = push_of(scene_, scan_, frame, flags, list, 0, nullptr);
  frame.dispatch(scan_blocks_, push, groups);
  frame.dispatch(scan_write_, push, groups);
}

}  // namespace sightline::device
