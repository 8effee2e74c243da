/** @file
 * What rays meet first among boxes. See <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_RAYS_H
#define SIGHTLINE_C_RAYS_H

#include <sightline/c/status.h>
#include <sightline/c/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A half line, or a piece of one. */
typedef struct sightline_ray {
  float origin[3];    /**< metres, about the origin that the boxes were built with */
  float direction[3]; /**< any length but zero; distances are in units of it */
  float max_distance; /**< INFINITY is one */
} sightline_ray;

/** Boxes to cast rays at, for one thread at a time. */
typedef struct sightline_bvh sightline_bvh;

/** Without a box; never NULL. Allocates: a little. */
SIGHTLINE_API sightline_bvh* sightline_bvh_create(void);
SIGHTLINE_API void sightline_bvh_destroy(sightline_bvh* bvh);
/** Takes the boxes, rounded outwards to single precision about `origin`; NULL: 0. Errors: BAD_ARGUMENT,
 * BAD_BOX, TOO_MANY (beyond 2^30). Cost: n log n, some 300 ns a box. Allocates: about 90 bytes a
 * box, and half of that again while it builds. */
SIGHTLINE_API sightline_status sightline_bvh_build(sightline_bvh* bvh, const sightline_box_view* boxes,
                                                   const double origin[3]);
/** Takes over moved boxes, as many as were built with. Rays get slower where boxes move far; build anew then.
 * Errors: BAD_ARGUMENT, BAD_BOX. Cost: linear, some 15 ns a box. */
SIGHTLINE_API sightline_status sightline_bvh_refit(sightline_bvh* bvh, const sightline_box_view* boxes);
/** Boxes; 0 for NULL. */
SIGHTLINE_API size_t sightline_bvh_size(const sightline_bvh* bvh);

/** Writes, for each of `count` rays, the box that it meets first (SIGHTLINE_NO_OBJECT: none; of equally near
 * ones the lowest) and, unless `distances` is NULL, the distance to it in units of its direction (0 where it
 * starts inside; -1: none). Both have `count` elements. `jobs` may be NULL. A ray that is not finite or has
 * no direction meets nothing. Errors: BAD_ARGUMENT. Cost: 20 to 50 ns a ray among thousands of boxes;
 * neighbours that point alike are fastest. Allocates: until it has seen as many rays. */
SIGHTLINE_API sightline_status sightline_bvh_cast(sightline_bvh* bvh, const sightline_ray* rays, size_t count,
                                                  uint32_t* objects, float* distances,
                                                  const sightline_jobs* jobs);
/** Writes the boxes that at least one of columns x rows rays through the view's image meets first, ascending:
 * an approximation of what is visible; *count says how many. `visible` has `capacity` elements:
 * sightline_bvh_size() or more. `jobs` may be NULL. Errors: BAD_ARGUMENT (also for no rays or more than
 * 2^24), BAD_VIEW, BUFFER_TOO_SMALL. Cost, Allocates: as sightline_bvh_cast. */
SIGHTLINE_API sightline_status sightline_bvh_visible_set(sightline_bvh* bvh, const sightline_view* view,
                                                         uint32_t columns, uint32_t rows, uint32_t* visible,
                                                         size_t capacity, const sightline_jobs* jobs,
                                                         size_t* count);

#ifdef __cplusplus
}
#endif

#endif
