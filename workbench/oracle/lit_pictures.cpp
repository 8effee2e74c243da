#include "workbench/oracle/lit_pictures.hpp"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "library/geometry/linear.hpp"

namespace sightline::oracle {

using namespace device;
using submission::DrawState;

namespace {

constexpr std::uint32_t kTestedVert[] =
#include "shaders/tested.vert.inc"
    ;
constexpr std::uint32_t kShadowedFrag[] =
#include "shaders/shadowed.frag.inc"
    ;

// As shadowed.frag reads it.
struct MapData {
  Mat4 world_to_clip;
  Vec4 light;  // where it is, or with w = 0 whither it lies
  float pixels, metres;
  std::int32_t reach, padding;
  vk::DeviceAddress depth;
};
static_assert(sizeof(MapData) == 104);

struct Push {
  vk::DeviceAddress objects, list, looks, map;
};

// The view from the scene's origin, not from its own.
View about_origin(const WorldView& at) {
  View out = at.view;
  const WorldPoint& o = at.origin;
  out.world_to_eye = geometry::to_mat4(geometry::to_double(out.world_to_eye) *
                                       glm::translate(glm::dmat4(1), glm::dvec3(-o.x, -o.y, -o.z)));
  return out;
}

Vec4 light_of(const View& shadow) {
  const glm::dmat4 to_world = glm::inverse(geometry::to_double(shadow.world_to_eye));
  const glm::dvec4 light = is_orthographic(shadow) ? to_world[2] : to_world[3];
  return {static_cast<float>(light.x), static_cast<float>(light.y), static_cast<float>(light.z),
          is_orthographic(shadow) ? 0.0f : 1.0f};
}

}  // namespace

LitPictures::LitPictures(Renderer& renderer)
    : renderer_(renderer),
      pipeline_(
          renderer.device(),
          {.vertex = kTestedVert, .fragment = kShadowedFrag, .input = Input::mesh, .colour = kColourFormat}),
      casters_(renderer.draws().make_buffers(renderer.device())),
      all_(renderer.draws().make_buffers(renderer.device())),
      flags_(renderer.device(), renderer.scene().size() * 4, Memory::upload, "who casts"),
      map_(renderer.device(), sizeof(MapData), Memory::upload, "the shadow map's view") {}

Picture LitPictures::draw(const View& camera, const WorldView& shadow, const ShadowLookup& lookup,
                          std::span<const ObjectId> casters) {
  const auto flags = std::span(flags_.mapped<std::uint32_t>(), renderer_.scene().size());
  std::ranges::fill(flags, 0u);
  for (const ObjectId caster : casters) flags[caster] = 1;
  return draw_with(camera, about_origin(shadow), lookup, {});
}

Picture LitPictures::draw(const View& camera, const WorldView& shadow, const ShadowLookup& lookup) {
  return draw_with(camera, about_origin(shadow), lookup, VisibleDraws::kAll);
}

void LitPictures::draw_map(const View& shadow, VisibleDraws::Condition condition) {
  const vk::DeviceSize bytes = vk::DeviceSize{4} * shadow.width * shadow.height;
  if (depth_.size() < bytes) depth_ = Buffer(renderer_.device(), bytes, Memory::device, "a shadow map");
  renderer_.frame(shadow, [&](Recorder& frame) {
    renderer_.draws().build(frame, flags_.address(), condition, renderer_.transparent_order(), casters_);
    renderer_.draw_solid(frame, casters_, Renderer::Style::lit, Renderer::Clear::both);
    renderer_.draw_rest(frame, casters_);
    frame.targets.depth.copy_to(frame.commands, depth_);
  });
}

Picture LitPictures::draw_with(const View& camera, const View& shadow, const ShadowLookup& lookup,
                               VisibleDraws::Condition condition) {
  draw_map(shadow, condition);
  *map_.mapped<MapData>() = {world_to_clip(shadow),
                             light_of(shadow),
                             static_cast<float>(shadow.width),
                             lookup.metres,
                             static_cast<std::int32_t>(lookup.reach),
                             0,
                             depth_.address()};
  const SceneBuffers& scene = renderer_.buffers();
  renderer_.frame(camera, [&](Recorder& frame) {
    renderer_.draws().build(frame, flags_.address(), VisibleDraws::kAll, renderer_.transparent_order(), all_);
    frame.begin_rendering({.colour = &frame.targets.colour, .clear_colour = true, .clear_depth = true});
    for (const DrawState state :
         {DrawState::both_sides, DrawState::front_faces, DrawState::turned_faces, DrawState::cut_out}) {
      if (all_.count_of(state) == 0) continue;
      frame.bind(pipeline_, Recorder::Compare::nearer_or_equal, 0, culled_in(state));
      frame.push(
          Push{scene.object_data.address(), all_.list.address(), scene.looks.address(), map_.address()});
      frame.commands.bindVertexBuffers(0, scene.vertices.handle(), vk::DeviceSize{0});
      frame.commands.bindIndexBuffer(scene.indices.handle(), 0, vk::IndexType::eUint32);
      frame.commands.drawIndexedIndirect(all_.commands.handle(), all_.first_of(state) * kCommandSize,
                                         all_.count_of(state), kCommandSize);
    }
    frame.end_rendering();
  });
  return renderer_.picture();
}

}  // namespace sightline::oracle
