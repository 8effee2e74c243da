// Views of shadow maps, and who throws shadows.
#include <sightline/shadows.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "bindings/c/calls.hpp"

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(SIGHTLINE_MAX_CASCADES == kMaxCascades);
static_assert(SIGHTLINE_LIGHT_SPOT == static_cast<int>(LightKind::spot) &&
              SIGHTLINE_LIGHT_POINT == static_cast<int>(LightKind::point));

DepthRange read(const sightline_depth_range* depths) {
  return depths ? DepthRange{depths->near_plane, depths->far_plane} : DepthRange{};
}

Status take(const sightline_light& given, Light& light) {
  sightline_light l = sightline_light_default();
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_light, reserved), l) || l.reserved != 0 ||
      l.kind > SIGHTLINE_LIGHT_POINT)
    return {StatusCode::bad_argument,
            "light: struct_size or kind are unknown, expected those of sightline_light_default"};
  light.kind = static_cast<LightKind>(l.kind);
  light.direction = {l.direction[0], l.direction[1], l.direction[2]};
  light.position = {l.position[0], l.position[1], l.position[2]};
  light.cone = l.cone, light.range = l.range, light.near_plane = l.near_plane, light.reach = l.reach;
  return {};
}

}  // namespace

extern "C" {

sightline_status sightline_shadow_view(const sightline_light* light, const sightline_view* camera,
                                       const sightline_depth_range* depths, uint32_t pixels, uint32_t face,
                                       sightline_view* view) {
  if (!light || !camera || !view) return refuse("shadow_view: the light, the camera or the view is NULL");
  Light given;
  if (const Status ok = take(*light, given); !ok) return keep(ok);
  const Result<WorldView> made = shadow_view(given, view_of(*camera), read(depths), pixels, face);
  if (!made) return keep(made.error());
  *view = view_of(*made);
  return SIGHTLINE_OK;
}

sightline_status sightline_split_cascades(const sightline_light* light, const sightline_view* camera,
                                          const sightline_depth_range* depths, float logarithmic,
                                          uint32_t pixels, sightline_cascade* cascades, size_t count) {
  if (!light || !camera || !can_hold(cascades, count))
    return refuse("split_cascades: a pointer is NULL, or a count more than memory holds");
  Light given;
  if (const Status ok = take(*light, given); !ok) return keep(ok);
  std::array<Cascade, kMaxCascades> made;
  if (count > made.size()) return refuse("split_cascades: expected 1 to 16 cascades");
  if (const Status ok = split_cascades(given, view_of(*camera), {read(depths), logarithmic, pixels},
                                       std::span(made).first(count));
      !ok)
    return keep(ok);
  for (std::size_t i = 0; i < count; ++i)
    cascades[i] = {view_of(made[i].view), {made[i].depths.near_plane, made[i].depths.far_plane}};
  return SIGHTLINE_OK;
}

sightline_shadow_casters* sightline_shadow_casters_create(void) {
  return new sightline_shadow_casters;
}
void sightline_shadow_casters_destroy(sightline_shadow_casters* casters) {
  delete casters;
}

sightline_status sightline_shadow_casters_begin(sightline_shadow_casters* casters,
                                                const sightline_view* shadow, const sightline_view* camera,
                                                const sightline_depth_range* depths, float texels,
                                                float metres) {
  if (!casters || !shadow || !camera) return refuse("shadow_casters: the casters, or a view, are NULL");
  return keep(casters->casters.begin(view_of(*shadow), view_of(*camera), read(depths), {texels, metres}));
}

sightline_status sightline_shadow_casters_receive(sightline_shadow_casters* casters,
                                                  const sightline_world* world, const uint32_t* visible,
                                                  size_t count, const sightline_occlusion* depth) {
  if (!casters || !world || !can_hold(visible, count))
    return refuse("shadow_casters: a pointer is NULL, or a count more than memory holds");
  return keep(casters->casters.receive(world->world, {visible, count}, depth ? &depth->buffer : nullptr));
}

sightline_status sightline_shadow_casters_may_cast(const sightline_shadow_casters* casters,
                                                   const sightline_box* box, int* casts) {
  if (!casters || !box || !casts) return refuse("shadow_casters: the casters, the box or the answer is NULL");
  *casts = casters->casters.may_cast(
      {{box->min[0], box->min[1], box->min[2]}, {box->max[0], box->max[1], box->max[2]}});
  return SIGHTLINE_OK;
}

}  // extern "C"
