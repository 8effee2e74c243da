#include "workbench/device/item_buffer.hpp"

#include <algorithm>

namespace sightline::device {

namespace {

constexpr std::uint32_t kObjectVert[] =
#include "shaders/object.vert.inc"
    ;
constexpr std::uint32_t kObjectIdFrag[] =
#include "shaders/object_id.frag.inc"
    ;
constexpr std::uint32_t kSeenFrag[] =
#include "shaders/seen.frag.inc"
    ;

struct Push {
  vk::DeviceAddress objects, list, seen;
};

}  // namespace

ItemBufferPass::ItemBufferPass(Renderer& renderer)
    : renderer_(renderer),
      id_pipeline_(
          renderer.device(),
          {.vertex = kObjectVert, .fragment = kObjectIdFrag, .input = Input::mesh, .colour = kIdFormat}),
      seen_pipeline_(
          renderer.device(),
          {.vertex = kObjectVert, .fragment = kSeenFrag, .input = Input::mesh, .depth_write = false}),
      all_(renderer.draws().make_buffers(renderer.device())),
      seen_(renderer.device(), renderer.scene().size() * 4, Memory::device, "the item buffer") {}

ItemBuffer ItemBufferPass::render(const View& view) {
  Device& device = renderer_.device();
  const SceneBuffers& scene = renderer_.buffers();
  if (!ids_ || ids_->width() != view.width || ids_->height() != view.height) {
    ids_.reset();
    ids_.emplace(device, kIdFormat, view.width, view.height, "the item buffer");
  }
  renderer_.frame(view, [&](Recorder& frame) {
    frame.fill(seen_, 0, seen_.size());
    renderer_.draws().build(frame, seen_.address(), VisibleDraws::kAll, renderer_.transparent_order(), all_);
    const auto draw = [&](const GraphicsPipeline& pipeline, std::uint32_t first, std::uint32_t count) {
      if (count == 0) return;
      frame.bind(pipeline);
      frame.push(Push{scene.object_data.address(), all_.list.address(), seen_.address()});
      frame.commands.bindVertexBuffers(0, scene.vertices.handle(), vk::DeviceSize{0});
      frame.commands.bindIndexBuffer(scene.indices.handle(), 0, vk::IndexType::eUint32);
      frame.commands.drawIndexedIndirect(all_.commands.handle(), first * sizeof(DrawCommand), count,
                                         sizeof(DrawCommand));
    };
    frame.begin_rendering({.colour = &*ids_,
                           .clear_colour = true,
                           .clear_depth = true,
                           .clear_value = {kNoObject, kNoObject, kNoObject, kNoObject}});
    draw(id_pipeline_, 0, all_.opaque_commands);
    frame.end_rendering();
    full_barrier(frame.commands);
    frame.begin_rendering({});
    draw(seen_pipeline_, all_.opaque_commands, all_.transparent_commands);
    frame.end_rendering();
  });
  ItemBuffer out{view.width, view.height, ids_->read(), {}};
  const std::vector<std::uint32_t> seen = read_words(device, seen_, renderer_.scene().size());
  out.visible.resize(seen.size());
  std::ranges::transform(seen, out.visible.begin(),
                         [](std::uint32_t word) { return static_cast<std::uint8_t>(word != 0); });
  for (const ObjectId id : out.ids) {
    if (id != kNoObject) out.visible[id] = 1;
  }
  return out;
}

}  // namespace sightline::device
