#include "workbench/device/triangle_draws.hpp"

#include <algorithm>
#include <bit>

namespace sightline::device {

namespace {

constexpr std::uint32_t kTriangleVert[] =
#include "shaders/triangle.vert.inc"
    ;
constexpr std::uint32_t kTriangleShadeFrag[] =
#include "shaders/triangle_shade.frag.inc"
    ;
constexpr std::uint32_t kTriangleTestedVert[] =
#include "shaders/triangle_tested.vert.inc"
    ;
constexpr std::uint32_t kTriangleTestedFrag[] =
#include "shaders/triangle_tested.frag.inc"
    ;
constexpr std::uint32_t kIdFrag[] =
#include "shaders/triangle_id.frag.inc"
    ;
constexpr std::uint32_t kTriangleSeenFrag[] =
#include "shaders/triangle_seen.frag.inc"
    ;

struct TrianglePush {
  vk::DeviceAddress looks, coordinates, seen;
};

std::vector<shared::CornerData> corners(const TriangleGeometry& geometry, const Scene& scene) {
  std::vector<shared::CornerData> out;
  out.reserve(geometry.positions.size());
  for (const Vec3& position : geometry.positions) out.push_back({position, 0, 0});
  for (std::size_t i = 0; i < geometry.indices.size(); ++i)
    out[geometry.indices[i]].object = geometry.objects[i / 3];
  for (shared::CornerData& corner : out)
    corner.colour = colour_of(corner.object, scene.surface[corner.object]);
  return out;
}

// Shaded; `tested`: by alpha and side, as materials ask.
GraphicsPipeline opaque_pipeline(const Device& device, bool tested) {
  if (!tested)
    return {device,
            {.vertex = kTriangleVert,
             .fragment = kTriangleShadeFrag,
             .input = Input::corner,
             .colour = kColourFormat}};
  return {device,
          {.vertex = kTriangleTestedVert,
           .fragment = kTriangleTestedFrag,
           .input = Input::corner,
           .colour = kColourFormat}};
}

GraphicsPipeline blended_pipeline(const Device& device) {
  return {device,
          {.vertex = kTriangleTestedVert,
           .fragment = kTriangleTestedFrag,
           .input = Input::corner,
           .colour = kColourFormat,
           .blend = true,
           .depth_write = false}};
}

}  // namespace

TriangleDraws::ItemPipelines::ItemPipelines(const Device& device)
    : ids(device,
          {.vertex = kTriangleVert, .fragment = kIdFrag, .input = Input::corner, .colour = kIdFormat}),
      seen(device, {.vertex = kTriangleVert,
                    .fragment = kTriangleSeenFrag,
                    .input = Input::corner,
                    .depth_write = false}) {}

TriangleDraws::TriangleDraws(Renderer& renderer, const TriangleGeometry& geometry)
    : renderer_(renderer),
      objects_(geometry.objects),
      corners_(upload(renderer.device(), corners(geometry, renderer.scene()), "triangle corners")),
      coordinates_(upload_bytes(renderer.device(), std::as_bytes(geometry.texture_coordinates),
                                "triangle texture coordinates")),
      indices_(upload_bytes(renderer.device(), std::as_bytes(geometry.indices), "triangle indices")) {
  const Scene& scene = renderer.scene();
  bool tested = false;
  for (const Surface surface : scene.surface) {
    is_transparent_.push_back(surface == Surface::transparent);
    tested = tested || surface == Surface::cut_out;
  }
  sides_ = scene.sides.front();
  if (std::ranges::any_of(scene.sides, [&](Sides sides) { return sides != sides_; })) tested = true;
  if (tested) sides_ = Sides::both;
  opaque_.emplace(opaque_pipeline(renderer.device(), tested));
  if (std::ranges::find(is_transparent_, 1) != is_transparent_.end())
    blended_.emplace(blended_pipeline(renderer.device()));
}

std::uint64_t TriangleDraws::bytes() const noexcept {
  return corners_.size() + coordinates_.size() + indices_.size();
}

std::size_t TriangleDraws::unblended_count(std::span<const DrawCommand> draws) const noexcept {
  const auto blended = std::ranges::find_if(
      draws, [&](const DrawCommand& draw) { return is_transparent_[objects_[draw.first_instance]] != 0; });
  return static_cast<std::size_t>(blended - draws.begin());
}

void TriangleDraws::copy_commands(std::span<const DrawCommand> draws) {
  if (commands_.size() < draws.size_bytes() || commands_.size() == 0)
    commands_ = Buffer(renderer_.device(), 2 * draws.size_bytes(), Memory::upload, "draw commands");
  std::ranges::copy(draws, commands_.mapped<DrawCommand>());
}

void TriangleDraws::submit(const Recorder& frame, const GraphicsPipeline& pipeline,
                           std::span<const DrawCommand> draws, std::size_t first, Submission submission,
                           Sides sides) const {
  if (draws.empty()) return;
  frame.bind(pipeline, Recorder::Compare::nearer_or_equal, 0,
             sides == Sides::front ? vk::CullModeFlagBits::eBack : vk::CullModeFlagBits::eNone);
  frame.push(TrianglePush{renderer_.buffers().looks.address(), coordinates_.address(), seen_.address()});
  // Strictly nearer: a triangle that crosses cells is drawn once for each, and shaded once all the same.
  frame.commands.setDepthCompareOp(frame.reversed() ? vk::CompareOp::eGreater : vk::CompareOp::eLess);
  frame.commands.bindVertexBuffers(0, corners_.handle(), vk::DeviceSize{0});
  frame.commands.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint32);
  if (submission != Submission::multi_draw) {
    for (const DrawCommand& draw : draws)
      frame.commands.drawIndexed(draw.index_count, 1, draw.first_index, 0, draw.first_instance);
    return;
  }
  const std::size_t most = renderer_.device().limits().maxDrawIndirectCount;
  for (std::size_t done = 0; done < draws.size(); done += most) {
    const auto count = static_cast<std::uint32_t>(std::min(most, draws.size() - done));
    frame.commands.drawIndexedIndirect(commands_.handle(), (first + done) * kCommandSize, count,
                                       kCommandSize);
  }
}

void TriangleDraws::draw(const Recorder& frame, std::span<const DrawCommand> draws, Submission submission) {
  if (submission == Submission::multi_draw) copy_commands(draws);
  const std::size_t unblended = unblended_count(draws);
  frame.begin_rendering(
      {.colour = &frame.targets.colour,
       .clear_colour = true,
       .clear_depth = true,
       .clear_value = {std::bit_cast<std::uint32_t>(0.62f), std::bit_cast<std::uint32_t>(0.70f),
                       std::bit_cast<std::uint32_t>(0.80f), std::bit_cast<std::uint32_t>(1.0f)}});
  submit(frame, *opaque_, draws.first(unblended), 0, submission, sides_);
  if (blended_) submit(frame, *blended_, draws.subspan(unblended), unblended, submission);
  frame.end_rendering();
}

TriangleDraws::Items TriangleDraws::items(const View& view, std::span<const DrawCommand> opaque,
                                          Submission submission, std::span<const DrawCommand> see_through) {
  if (submission == Submission::multi_draw) copy_commands(opaque);
  Device& device = renderer_.device();
  if (!item_pipelines_) item_pipelines_.emplace(device);
  if (!ids_ || ids_->width() != view.width || ids_->height() != view.height) {
    ids_.reset();
    ids_.emplace(device, kIdFormat, view.width, view.height, "the item buffer");
  }
  const std::size_t objects = is_transparent_.size();
  if (seen_.size() == 0) seen_ = Buffer(device, objects * 4, Memory::device, "the item buffer");
  renderer_.frame(view, [&](Recorder& frame) {
    frame.fill(seen_, 0, seen_.size());
    frame.begin_rendering({.colour = &*ids_,
                           .clear_colour = true,
                           .clear_depth = true,
                           .clear_value = {kNoObject, kNoObject, kNoObject, kNoObject}});
    submit(frame, item_pipelines_->ids, opaque.first(unblended_count(opaque)), 0, submission);
    frame.end_rendering();
    full_barrier(frame.commands);
    frame.begin_rendering({});
    submit(frame, item_pipelines_->seen, see_through, 0, Submission::calls);
    frame.end_rendering();
  });
  return {ids_->read(), read_words(device, seen_, objects)};
}

}  // namespace sightline::device
