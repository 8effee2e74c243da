// What rays meet first.
#include <sightline/rays.hpp>

#include "bindings/c/calls.hpp"

struct sightline_bvh {
  sightline::BoxBvh bvh;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_ray) == sizeof(Ray) &&
              offsetof(sightline_ray, direction) == offsetof(Ray, direction) &&
              offsetof(sightline_ray, max_distance) == offsetof(Ray, max_distance));

Status take(const sightline_jobs* given, JobSystem& jobs) {
  return given ? c_api::take(*given, jobs) : Status{};
}

}  // namespace

extern "C" {

sightline_bvh* sightline_bvh_create(void) {
  return new sightline_bvh;
}
void sightline_bvh_destroy(sightline_bvh* bvh) {
  delete bvh;
}

sightline_status sightline_bvh_build(sightline_bvh* bvh, const sightline_box_view* boxes,
                                     const double origin[3]) {
  if (!bvh || !boxes) return refuse("bvh: the bvh or the boxes are NULL");
  BoxView given;
  if (const Status ok = c_api::take(*boxes, given); !ok) return keep(ok);
  const WorldPoint about = origin ? WorldPoint{origin[0], origin[1], origin[2]} : WorldPoint{};
  return keep(bvh->bvh.build(given, about));
}

sightline_status sightline_bvh_refit(sightline_bvh* bvh, const sightline_box_view* boxes) {
  if (!bvh || !boxes) return refuse("bvh: the bvh or the boxes are NULL");
  BoxView given;
  if (const Status ok = c_api::take(*boxes, given); !ok) return keep(ok);
  return keep(bvh->bvh.refit(given));
}

size_t sightline_bvh_size(const sightline_bvh* bvh) {
  return bvh ? bvh->bvh.size() : 0;
}

sightline_status sightline_bvh_cast(sightline_bvh* bvh, const sightline_ray* rays, size_t count,
                                    uint32_t* objects, float* distances, const sightline_jobs* jobs) {
  if (!bvh || !can_hold(rays, count) || !can_hold(objects, count))
    return refuse("cast: a pointer is NULL, or the rays more than memory holds");
  JobSystem threads;
  if (const Status ok = take(jobs, threads); !ok) return keep(ok);
  const std::span<float> lengths(distances, distances ? count : 0);
  return keep(bvh->bvh.cast({reinterpret_cast<const Ray*>(rays), count}, {objects, count}, lengths, threads));
}

sightline_status sightline_bvh_visible_set(sightline_bvh* bvh, const sightline_view* view, uint32_t columns,
                                           uint32_t rows, uint32_t* visible, size_t capacity,
                                           const sightline_jobs* jobs, size_t* count) {
  if (!bvh || !view || !can_hold(visible, capacity) || !count)
    return refuse("visible set: a pointer is NULL, or the capacity more than memory holds");
  JobSystem threads;
  if (const Status ok = take(jobs, threads); !ok) return keep(ok);
  const Result<std::size_t> seen =
      bvh->bvh.visible_set(view_of(*view), columns, rows, {visible, capacity}, threads);
  if (!seen) return keep(seen.error());
  *count = *seen;
  return SIGHTLINE_OK;
}

}  // extern "C"
