#include "workbench/device/renderer.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include <sightline/workbench/error.hpp>

#include "workbench/device/view_data.hpp"

namespace sightline::device {

namespace {

constexpr std::uint32_t kObjectVert[] =
#include "shaders/object.vert.inc"
    ;
constexpr std::uint32_t kObjectShadeFrag[] =
#include "shaders/shade.frag.inc"
    ;
constexpr std::uint32_t kTestedVert[] =
#include "shaders/tested.vert.inc"
    ;
constexpr std::uint32_t kTestedFrag[] =
#include "shaders/tested.frag.inc"
    ;

using submission::DrawState;

constexpr std::array kSolid{DrawState::both_sides, DrawState::front_faces, DrawState::turned_faces};

struct DrawPush {
  vk::DeviceAddress objects, list, extra;
};

std::array<std::uint32_t, 4> background() {
  return {std::bit_cast<std::uint32_t>(0.62f), std::bit_cast<std::uint32_t>(0.70f),
          std::bit_cast<std::uint32_t>(0.80f), std::bit_cast<std::uint32_t>(1.0f)};
}

vk::raii::DescriptorPool make_pool(const Device& device) {
  const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, 1},
                         vk::DescriptorPoolSize{vk::DescriptorType::eCombinedImageSampler, 1}};
  return {device.handle(),
          vk::DescriptorPoolCreateInfo{vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes}};
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void grow(Box& box, const Box& other, float by) {
  box.min = {std::min(box.min.x, other.min.x - by), std::min(box.min.y, other.min.y - by),
             std::min(box.min.z, other.min.z - by)};
  box.max = {std::max(box.max.x, other.max.x + by), std::max(box.max.y, other.max.y + by),
             std::max(box.max.z, other.max.z + by)};
}

}  // namespace

double FrameTimes::gpu_ms(PassKind kind) const noexcept {
  double sum = 0;
  for (const PassTime& pass : passes) sum += pass.kind == kind ? pass.milliseconds : 0;
  return sum;
}

Renderer::Renderer(Device& device, const Scene& scene)
    : device_(device),
      scene_(scene),
      held_(scene, "renderer"),
      buffers_(device, scene),
      draws_(device, buffers_),
      extent_(extent(scene)),
      timer_(device),
      commands_(device.handle(), {*device.command_pool(), vk::CommandBufferLevel::ePrimary, 1}),
      view_buffer_(device, sizeof(shared::ViewData), Memory::upload, "the view"),
      transparent_order_(device, buffers_.transparent_ids.size() * 4, Memory::upload,
                         "the transparent objects' order"),
      descriptors_(make_pool(device)),
      view_set_(device.handle(), {*descriptors_, *device.set_layout()}),
      depth_pipeline_(device, {.vertex = kObjectVert, .input = Input::mesh}),
      lit_pipeline_(device, {.vertex = kObjectVert,
                             .fragment = kObjectShadeFrag,
                             .input = Input::mesh,
                             .colour = kColourFormat}),
      cut_out_pipeline_(
          device,
          {.vertex = kTestedVert, .fragment = kTestedFrag, .input = Input::mesh, .colour = kColourFormat}),
      blend_pipeline_(device, {.vertex = kTestedVert,
                               .fragment = kTestedFrag,
                               .input = Input::mesh,
                               .colour = kColourFormat,
                               .blend = true,
                               .depth_write = false}) {
  const vk::DescriptorBufferInfo view{view_buffer_.handle(), 0, sizeof(shared::ViewData)};
  device.handle().updateDescriptorSets(
      vk::WriteDescriptorSet{*view_set_[0], 0, 0, vk::DescriptorType::eUniformBuffer, {}, view}, {});
  for (ObjectId object = 0; object < scene.size(); ++object)
    grow(extent_, scene.bounds[object], scene.radius[object]);
}

void Renderer::update(std::span<const ObjectId> moved) {
  held_.require_sound(moved);
  for (const ObjectId object : moved) grow(extent_, scene_.bounds[object], scene_.radius[object]);
  buffers_.update(device_, scene_, moved);
}

void Renderer::resize(std::uint32_t width, std::uint32_t height) {
  if (targets_ && targets_->depth.width() == width && targets_->depth.height() == height) return;
  targets_.reset();
  targets_.emplace(device_, width, height);
  const vk::DescriptorImageInfo depth{{}, targets_->depth.view(), kReadLayout};
  device_.handle().updateDescriptorSets(
      vk::WriteDescriptorSet{*view_set_[0], 1, 0, vk::DescriptorType::eCombinedImageSampler, depth}, {});
}

void Renderer::sort_transparent(const View& view) {
  if (buffers_.transparent_ids.empty()) return;
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  sort_keys_.clear();
  for (const ObjectId object : buffers_.transparent_ids) {
    const Vec3 c = scene_.sphere(object).centre;
    const float depth = (c.x - eye.x) * forward.x + (c.y - eye.y) * forward.y + (c.z - eye.z) * forward.z;
    // IEEE floats compare as integers once negative ones are turned round; inverted for farthest first.
    const auto bits = std::bit_cast<std::uint32_t>(depth);
    const std::uint32_t rising = bits & 0x80000000u ? ~bits : bits | 0x80000000u;
    sort_keys_.push_back(std::uint64_t{~rising} << 32 | object);
  }
  std::ranges::sort(sort_keys_);
  auto* order = transparent_order_.mapped<ObjectId>();
  for (const std::uint64_t key : sort_keys_) *order++ = static_cast<ObjectId>(key);
}

FrameTimes Renderer::frame(const View& view, const std::function<void(Recorder&)>& record, Timed timed) {
  or_throw(check(view));
  held_.require_same();
  resize(view.width, view.height);
  FrameTimes times;
  const auto start = std::chrono::steady_clock::now();
  auto& data = *view_buffer_.mapped<shared::ViewData>();
  data = device::view_data(view, extent_);
  unsorted_ = view;
  const vk::raii::CommandBuffer& commands = commands_[0];
  commands.begin(vk::CommandBufferBeginInfo{vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  timer_.reset(commands, timed == Timed::passes);
  Recorder recorder(device_, commands, timer_, view, data.reversed != 0, *view_set_[0], *targets_);
  const auto before = std::chrono::steady_clock::now();
  record(recorder);
  times.record_ms = milliseconds_since(before);
  full_barrier(commands);
  commands.end();
  device_.submit_and_wait(commands);
  times.frame_ms = milliseconds_since(start);
  times.passes = timer_.read();
  return times;
}

vk::DeviceAddress Renderer::transparent_order() {
  if (unsorted_) sort_transparent(*unsorted_);
  unsorted_.reset();
  return buffers_.transparent_ids.empty() ? 0 : transparent_order_.address();
}

vk::CullModeFlagBits culled_in(DrawState state) noexcept {
  switch (state) {
    case DrawState::front_faces:
      return vk::CullModeFlagBits::eBack;
    case DrawState::turned_faces:
      return vk::CullModeFlagBits::eFront;
    default:
      return vk::CullModeFlagBits::eNone;
  }
}

Renderer::Commands Renderer::commands_of(const DrawBuffers& draws, DrawState state) noexcept {
  return {draws.commands.handle(), draws.first_of(state), draws.count_of(state), draws.list.address(), state};
}

void Renderer::bind(const Recorder& frame, const GraphicsPipeline& pipeline, const Commands& commands,
                    Recorder::Compare compare, vk::DeviceAddress extra) const {
  frame.bind(pipeline, compare, 0, culled_in(commands.state));
  frame.push(DrawPush{buffers_.object_data.address(), commands.list, extra});
  frame.commands.bindVertexBuffers(0, buffers_.vertices.handle(), vk::DeviceSize{0});
  frame.commands.bindIndexBuffer(buffers_.indices.handle(), 0, vk::IndexType::eUint32);
}

void Renderer::submit(const Recorder& frame, const Commands& commands) {
  frame.commands.drawIndexedIndirect(commands.buffer, commands.first * kCommandSize, commands.count,
                                     kCommandSize);
}

void Renderer::draw_indirect(const Recorder& frame, const GraphicsPipeline& pipeline,
                             const Commands& commands, Recorder::Compare compare,
                             vk::DeviceAddress extra) const {
  if (commands.count == 0) return;
  bind(frame, pipeline, commands, compare, extra);
  submit(frame, commands);
}

void Renderer::bind_lit(const Recorder& frame, const Commands& commands) const {
  const bool solid = submission::is_solid(commands.state);
  const GraphicsPipeline& pipeline = solid                                  ? lit_pipeline_
                                     : commands.state == DrawState::cut_out ? cut_out_pipeline_
                                                                            : blend_pipeline_;
  bind(frame, pipeline, commands, Recorder::Compare::nearer_or_equal, solid ? 0 : buffers_.looks.address());
}

void Renderer::draw_lit(const Recorder& frame, const Commands& commands) const {
  if (commands.count == 0) return;
  bind_lit(frame, commands);
  submit(frame, commands);
}

void Renderer::draw_solid(const Recorder& frame, const DrawBuffers& draws, Style style, Clear clear,
                          Recorder::Compare compare) const {
  const bool lit = style == Style::lit;
  frame.begin_rendering({.colour = lit ? &frame.targets.colour : nullptr,
                         .clear_colour = clear == Clear::colour || clear == Clear::both,
                         .clear_depth = clear == Clear::depth || clear == Clear::both,
                         .clear_value = background()});
  for (const DrawState state : kSolid)
    draw_indirect(frame, lit ? lit_pipeline_ : depth_pipeline_, commands_of(draws, state), compare, 0);
  frame.end_rendering();
}

void Renderer::draw_solid(const Recorder& frame, const DrawBuffers& draws, const GraphicsPipeline& pipeline,
                          vk::DeviceAddress extra, Recorder::Compare compare) const {
  frame.begin_rendering({.colour = &frame.targets.colour});
  for (const DrawState state : kSolid)
    draw_indirect(frame, pipeline, commands_of(draws, state), compare, extra);
  frame.end_rendering();
}

void Renderer::draw_rest(const Recorder& frame, const DrawBuffers& draws) const {
  if (draws.count_of(DrawState::cut_out) + draws.count_of(DrawState::blended) == 0) return;
  frame.begin_rendering({.colour = &frame.targets.colour});
  for (const DrawState state : {DrawState::cut_out, DrawState::blended})
    draw_lit(frame, commands_of(draws, state));
  frame.end_rendering();
}

void Renderer::draw(const Recorder& frame, std::span<const ObjectId> visible,
                    std::span<const DrawCommand> draws, bool one_by_one) {
  host_list_.send(device_, visible, "a draw list");
  // Draws that are calls of their own are no list.
  host_commands_.send(device_, one_by_one ? std::span<const DrawCommand>() : draws, "draw commands");
  frame.begin_rendering({.colour = &frame.targets.colour,
                         .clear_colour = true,
                         .clear_depth = true,
                         .clear_value = background()});
  const auto state_of = [&](const DrawCommand& draw) {
    return submission::draw_state(scene_, visible[draw.first_instance]);
  };
  for (std::size_t first = 0, end = 0; first < draws.size(); first = end) {
    const DrawState state = state_of(draws[first]);
    while (end < draws.size() && state_of(draws[end]) == state) ++end;
    const Commands commands{host_commands_.buffer().handle(), static_cast<std::uint32_t>(first),
                            static_cast<std::uint32_t>(end - first), host_list_.buffer().address(), state};
    if (!one_by_one) {
      draw_lit(frame, commands);
      continue;
    }
    bind_lit(frame, commands);
    for (const DrawCommand& draw : draws.subspan(first, end - first)) {
      frame.commands.drawIndexed(draw.index_count, draw.instance_count, draw.first_index, draw.vertex_offset,
                                 draw.first_instance);
    }
  }
  frame.end_rendering();
}

Picture Renderer::picture() const {
  if (!targets_) return {};
  return {targets_->colour.width(), targets_->colour.height(), targets_->colour.read()};
}

std::vector<float> Renderer::depth() const {
  if (!targets_) return {};
  const std::vector<std::uint32_t> words = targets_->depth.read();
  std::vector<float> out(words.size());
  std::ranges::transform(words, out.begin(), [](std::uint32_t word) { return std::bit_cast<float>(word); });
  return out;
}

}  // namespace sightline::device
