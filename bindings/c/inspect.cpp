// What culls did, and shapes to be drawn.
#include <sightline/inspect.hpp>

#include "bindings/c/calls.hpp"

struct sightline_inspector {
  sightline::CullInspector inspector;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_view_stats) == sizeof(ViewStats) &&
              offsetof(sightline_view_stats, objects) == offsetof(ViewStats, objects) &&
              offsetof(sightline_view_stats, visible) == offsetof(ViewStats, visible));
static_assert(sizeof(sightline_debug_box) == sizeof(DebugBox) &&
              offsetof(sightline_debug_box, kind) == offsetof(DebugBox, kind) &&
              offsetof(sightline_debug_box, whole) == offsetof(DebugBox, whole) &&
              offsetof(sightline_debug_box, objects) == offsetof(DebugBox, objects));

}  // namespace

extern "C" {

sightline_inspector* sightline_inspector_create(void) {
  return new sightline_inspector;
}
void sightline_inspector_destroy(sightline_inspector* inspector) {
  delete inspector;
}

sightline_status sightline_inspect(sightline_inspector* inspector, const sightline_world* world,
                                   const sightline_cull_view* views, size_t view_count,
                                   const sightline_culler* culler, sightline_inspection* inspection) {
  if (!inspector || !world || !views || !inspection)
    return refuse("inspect: the inspector, the world, the views or the inspection are NULL");
  Views given;
  if (const Status ok = take(views, view_count, given); !ok) return keep(ok);
  const Result<Inspection> looked = inspector->inspector.inspect(world->world, {given.data(), view_count},
                                                                 culler ? &culler->culler : nullptr);
  if (!looked) return keep(looked.error());
  *inspection = {reinterpret_cast<const sightline_view_stats*>(looked->views.data()), looked->views.size(),
                 reinterpret_cast<const sightline_debug_box*>(looked->boxes.data()), looked->boxes.size()};
  return SIGHTLINE_OK;
}

sightline_status sightline_view_corners(const sightline_view* view, double farthest, double corners[24]) {
  if (!view || !corners) return refuse("view: it, or its corners, are NULL");
  WorldView given;
  if (const Status ok = take(*view, given); !ok) return keep(ok);
  const auto found = view_corners(given, farthest);
  if (!found) return keep(found.error());
  for (const WorldPoint& p : *found) *corners++ = p.x, *corners++ = p.y, *corners++ = p.z;
  return SIGHTLINE_OK;
}

sightline_status sightline_occlusion_depth_image(const sightline_occlusion* occlusion, uint8_t* pixels,
                                                 size_t count) {
  if (!occlusion || !pixels || !can_hold(pixels, count))
    return refuse("depth image: the occlusion or the pixels are NULL, or their count is none");
  return keep(depth_image(occlusion->buffer, {pixels, count}));
}
sightline_status sightline_culler_depth_image(const sightline_culler* culler, size_t place, uint8_t* pixels,
                                              size_t count) {
  if (!culler || !pixels || !can_hold(pixels, count))
    return refuse("depth image: the culler or the pixels are NULL, or their count is none");
  return keep(depth_image(culler->culler, place, {pixels, count}));
}

}  // extern "C"
