#include "workbench/oracle/raster_item_buffer.hpp"

#include <algorithm>
#include <limits>

#include "workbench/oracle/pixel_rays.hpp"

namespace sightline::oracle {

using namespace device;
using submission::DrawState;

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

/// Metres from the near plane to what each pixel shows.
std::vector<float> distances(const View& view, const std::vector<ObjectId>& ids,
                             const std::vector<float>& depth) {
  const PixelRays rays(view);
  std::vector<float> out(depth.size(), std::numeric_limits<float>::infinity());
  for (std::uint32_t y = 0; y < view.height; ++y) {
    for (std::uint32_t x = 0; x < view.width; ++x) {
      const std::size_t pixel = std::size_t{y} * view.width + x;
      if (ids[pixel] != kNoObject) out[pixel] = static_cast<float>(rays.distance(x, y, depth[pixel]));
    }
  }
  return out;
}

struct Push {
  vk::DeviceAddress objects, list, seen;
};

}  // namespace

RasterItemBuffer::RasterItemBuffer(Renderer& renderer)
    : renderer_(renderer),
      id_pipeline_(
          renderer.device(),
          {.vertex = kObjectVert, .fragment = kObjectIdFrag, .input = Input::mesh, .colour = kIdFormat}),
      seen_pipeline_(
          renderer.device(),
          {.vertex = kObjectVert, .fragment = kSeenFrag, .input = Input::mesh, .depth_write = false}),
      all_(renderer.draws().make_buffers(renderer.device())),
      seen_(renderer.device(), renderer.scene().size() * 4, Memory::device, "the item buffer") {}

ItemBuffer RasterItemBuffer::render(const View& view) {
  Device& device = renderer_.device();
  const SceneBuffers& scene = renderer_.buffers();
  if (!ids_ || ids_->width() != view.width || ids_->height() != view.height) {
    ids_.reset();
    ids_.emplace(device, kIdFormat, view.width, view.height, "the item buffer");
  }
  renderer_.frame(view, [&](Recorder& frame) {
    frame.fill(seen_, 0, seen_.size());
    renderer_.draws().build(frame, seen_.address(), VisibleDraws::kAll, renderer_.transparent_order(), all_);
    const auto draw = [&](const GraphicsPipeline& pipeline, DrawState state) {
      if (all_.count_of(state) == 0) return;
      frame.bind(pipeline, Recorder::Compare::nearer_or_equal, 0, culled_in(state));
      frame.push(Push{scene.object_data.address(), all_.list.address(), seen_.address()});
      frame.commands.bindVertexBuffers(0, scene.vertices.handle(), vk::DeviceSize{0});
      frame.commands.bindIndexBuffer(scene.indices.handle(), 0, vk::IndexType::eUint32);
      frame.commands.drawIndexedIndirect(all_.commands.handle(), all_.first_of(state) * kCommandSize,
                                         all_.count_of(state), kCommandSize);
    };
    frame.begin_rendering({.colour = &*ids_,
                           .clear_colour = true,
                           .clear_depth = true,
                           .clear_value = {kNoObject, kNoObject, kNoObject, kNoObject}});
    for (const DrawState state : {DrawState::both_sides, DrawState::front_faces, DrawState::turned_faces})
      draw(id_pipeline_, state);
    frame.end_rendering();
    full_barrier(frame.commands);
    frame.begin_rendering({});
    draw(seen_pipeline_, DrawState::cut_out);
    draw(seen_pipeline_, DrawState::blended);
    frame.end_rendering();
  });
  ItemBuffer out;
  out.width = view.width, out.height = view.height;
  out.ids = ids_->read();
  out.distances = distances(view, out.ids, renderer_.depth());
  out.pixels = read_words(device, seen_, renderer_.scene().size());
  for (std::uint32_t& seen : out.pixels) seen = seen != 0;
  std::vector<std::uint32_t> owned(out.pixels.size());
  for (const ObjectId id : out.ids) {
    if (id != kNoObject) ++owned[id];
  }
  for (std::size_t o = 0; o < owned.size(); ++o) out.pixels[o] = std::max(out.pixels[o], owned[o]);
  return out;
}

}  // namespace sightline::oracle
