// Flat culling by a frustum, and projections.
#include <sightline/frustum.hpp>

#include <bit>
#include <cmath>
#include <limits>

#include <sightline/projection.hpp>

#include "bindings/c/calls.hpp"

struct sightline_projector {
  sightline::Projector projector;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_frustum) == sizeof(Frustum) &&
              offsetof(sightline_frustum, origin) == offsetof(Frustum, origin));
static_assert(SIGHTLINE_CULL_PADDING == kCullPadding);
static_assert(SIGHTLINE_OUTSIDE == static_cast<int>(Overlap::outside) &&
              SIGHTLINE_CROSSING == static_cast<int>(Overlap::crossing) &&
              SIGHTLINE_INSIDE == static_cast<int>(Overlap::inside));

Frustum frustum_of(const sightline_frustum& frustum) {
  return std::bit_cast<Frustum>(frustum);
}

Status check_extent(const float extent[6]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(extent[axis]) || !std::isfinite(extent[axis + 3]) || extent[axis] > extent[axis + 3])
      return {StatusCode::bad_box, "extent: expected finite numbers, the minimum before the maximum"};
  }
  return {};
}

}  // namespace

extern "C" {

sightline_status sightline_frustum_make(const sightline_view* view, sightline_frustum* frustum) {
  if (!view || !frustum) return refuse("frustum: the view or the frustum is NULL");
  WorldView given;
  if (const Status ok = take(*view, given); !ok) return keep(ok);
  *frustum = std::bit_cast<sightline_frustum>(make_frustum(given));
  return SIGHTLINE_OK;
}

int sightline_frustum_classify(const sightline_frustum* frustum, const float box[6]) {
  return frustum && box ? static_cast<int>(classify(frustum_of(*frustum), box_of(box))) : SIGHTLINE_CROSSING;
}
int sightline_frustum_overlaps_sphere(const sightline_frustum* frustum, const float sphere[4]) {
  return !frustum || !sphere || overlaps(frustum_of(*frustum), sphere_of(sphere));
}

sightline_status sightline_cull_boxes(const sightline_frustum* frustum, const sightline_box_view* boxes,
                                      uint32_t* visible, size_t capacity, size_t* count) {
  if (!frustum || !boxes || !can_hold(visible, capacity) || !count)
    return refuse("cull boxes: a pointer is NULL, or the capacity more than memory holds");
  BoxView given;
  if (const Status ok = c_api::take(*boxes, given); !ok) return keep(ok);
  const Result<std::size_t> kept = cull_boxes(frustum_of(*frustum), given, {visible, capacity});
  if (!kept) return keep(kept.error());
  *count = *kept;
  return SIGHTLINE_OK;
}

sightline_status sightline_cull_spheres(const sightline_frustum* frustum,
                                        const sightline_sphere_view* spheres, uint32_t* visible,
                                        size_t capacity, size_t* count) {
  if (!frustum || !spheres || !can_hold(visible, capacity) || !count)
    return refuse("cull spheres: a pointer is NULL, or the capacity more than memory holds");
  GivenSpheres given;
  if (const Status ok = c_api::take(*spheres, given); !ok) return keep(ok);
  const Result<std::size_t> kept = cull_spheres(frustum_of(*frustum), given, {visible, capacity});
  if (!kept) return keep(kept.error());
  *count = *kept;
  return SIGHTLINE_OK;
}

sightline_status sightline_projector_create(const sightline_view* view, const float extent[6],
                                            sightline_projector** projector) {
  if (!view || !extent || !projector)
    return refuse("projector: the view, the extent or what to write to is NULL");
  WorldView given;
  if (const Status ok = take(*view, given); !ok) return keep(ok);
  if (const Status ok = check_extent(extent); !ok) return keep(ok);
  *projector = new sightline_projector{make_projector(given.view, box_of(extent))};
  return SIGHTLINE_OK;
}
void sightline_projector_destroy(sightline_projector* projector) {
  delete projector;
}

int sightline_projector_rect(const sightline_projector* projector, const float box[6], float rect[4]) {
  if (!projector || !box || !rect) return 1;
  const Rect r = projected_rect(projector->projector, box_of(box));
  rect[0] = r.min_x, rect[1] = r.min_y, rect[2] = r.max_x, rect[3] = r.max_y;
  return covers_sample(projector->projector, r);
}

float sightline_projector_area(const sightline_projector* projector, const float sphere[4]) {
  if (!projector || !sphere) return std::numeric_limits<float>::infinity();
  return projected_area(projector->projector, sphere_of(sphere));
}
float sightline_projector_area_bound(const sightline_projector* projector, const float sphere[4]) {
  if (!projector || !sphere) return std::numeric_limits<float>::infinity();
  return projected_area_bound(projector->projector, sphere_of(sphere));
}

}  // extern "C"
