#include "workbench/methods/raster_occlusion/occlusion.hpp"

#include <algorithm>
#include <bit>

namespace sightline::methods {

namespace {

constexpr std::uint32_t kBoxVert[] =
#include "shaders/box.vert.inc"
    ;
constexpr std::uint32_t kMarkFrag[] =
#include "shaders/mark.frag.inc"
    ;
constexpr std::uint32_t kOccluders[] =
#include "shaders/occluders.comp.inc"
    ;

struct OccludersPush {
  vk::DeviceAddress boxes, marks, occluders;
  std::uint32_t objects;
  float least;
};

using device::PassKind;
using device::Renderer;

}  // namespace

Guarantee guarantee_of(const submission::Contribution& contribution) noexcept {
  return contribution.test == submission::Contribution::Test::area ? Guarantee::approximate
                                                                   : Guarantee::exact;
}

Coverage coverage_of(const submission::Contribution& contribution) noexcept {
  return contribution.test == submission::Contribution::Test::exact ? Coverage::centres : Coverage::area;
}

std::array<std::uint32_t, 2> shader_constants(const submission::Contribution& contribution) noexcept {
  return {static_cast<std::uint32_t>(contribution.test),
          std::bit_cast<std::uint32_t>(contribution.threshold)};
}

device::GraphicsPipeline make_box_pipeline(const device::Device& device,
                                           const submission::Contribution& contribution) {
  return {device,
          {.vertex = kBoxVert,
           .fragment = kMarkFrag,
           .constants = shader_constants(contribution),
           .depth_write = false}};
}

device::Buffer make_marks(const Renderer& renderer) {
  return upload(renderer.device(), std::vector<std::uint32_t>(renderer.scene().size()), "marks");
}

void report_visible(const Renderer& renderer, std::span<const std::uint32_t> flags,
                    device::VisibleDraws::Condition solid, device::VisibleDraws::Condition rest,
                    Frame& frame) {
  const Scene& scene = renderer.scene();
  frame.clear();
  const device::SceneBuffers& buffers = renderer.buffers();
  std::vector<std::uint8_t> drawn(buffers.batch_count());
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const bool blended = scene.surface[object] == Surface::transparent;
    const auto& condition = buffers.is_solid(object) ? solid : rest;
    if ((flags[object] & condition.mask) != condition.value) continue;
    frame.visible.push_back(object);
    frame.stats.triangles += scene.triangles(object);
    frame.stats.draw_calls += blended;
    if (!blended) drawn[buffers.batch_of(object)] = 1;
  }
  frame.stats.draw_calls += static_cast<std::uint64_t>(std::ranges::count(drawn, 1));
  frame.stats.objects = scene.size();
}

MarkAndDraw::MarkAndDraw(Renderer& renderer, const Parameters& parameters, std::optional<float> least)
    : Method(renderer.scene()),
      renderer_(renderer),
      contribution_(submission::contribution_from(parameters)),
      draws_(renderer.draws().make_buffers(renderer.device())) {
  if (!least && contribution_.test != submission::Contribution::Test::area) return;
  occluders_.emplace(Occluders{least.value_or(0),
                               {renderer.device(), kOccluders, shader_constants(contribution_)},
                               make_marks(renderer),
                               renderer.draws().make_buffers(renderer.device())});
}

const device::DrawBuffers& MarkAndDraw::find_occluders(device::Recorder& frame) const {
  if (!occluders_) return draws_;
  const auto pass = frame.pass("find occluders", PassKind::cull);
  const device::SceneBuffers& scene = renderer_.buffers();
  frame.dispatch(occluders_->find,
                 OccludersPush{scene.box_data.address(), marks(), occluders_->marks.address(), scene.objects,
                               occluders_->least},
                 scene.objects);
  renderer_.draws().build(frame, occluders_->marks.address(), {}, 0, occluders_->draws);
  return occluders_->draws;
}

void MarkAndDraw::do_record(FrameContext& context) {
  device::Recorder& frame = *context.recorder;
  const device::DrawBuffers& depth = find_occluders(frame);
  {
    const auto pass = frame.pass("depth of last frame's visible objects", PassKind::occluders);
    renderer_.draw_solid(frame, depth, Renderer::Style::depth, Renderer::Clear::depth);
  }
  test(frame);
  {
    const auto pass = frame.pass("draw commands", PassKind::cull);
    renderer_.draws().build(frame, marks(), {}, renderer_.transparent_order(), draws_);
  }
  const auto pass = frame.pass("draw", PassKind::draw);
  renderer_.draw_solid(frame, draws_, Renderer::Style::lit, Renderer::Clear::colour);
  renderer_.draw_rest(frame, draws_);
}

void MarkAndDraw::read_back(Frame& frame) {
  const std::vector<std::uint32_t> flags = read_marks();
  report_visible(renderer_, flags, {}, {}, frame);
  count(frame.stats);
}

}  // namespace sightline::methods
