/** @file
 * Flat culling of the caller's arrays by a view frustum, and what a box or a sphere covers on the image. See
 * <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_FRUSTUM_H
#define SIGHTLINE_C_FRUSTUM_H

#include <sightline/c/status.h>
#include <sightline/c/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Six inward planes about `origin`, normal and distance each: left, right, bottom, top, near, far. */
typedef struct sightline_frustum {
  float planes[6][4]; /**< their normals point inwards */
  double origin[3];   /**< metres; the planes are about it */
} sightline_frustum;

/** How a box lies to a frustum: surely outside, across its border or near it, wholly inside. */
enum { SIGHTLINE_OUTSIDE = 0, SIGHTLINE_CROSSING = 1, SIGHTLINE_INSIDE = 2 };

/** Room that an output of flat culling needs beyond the input's count. */
#define SIGHTLINE_CULL_PADDING 64

/** The view's frustum, its planes moved outwards by the rounding error of a test: some 1e-6 of the distance
 * from the eye and of the eye's from the view's origin. Errors: BAD_ARGUMENT, BAD_VIEW. */
SIGHTLINE_API sightline_status sightline_frustum_make(const sightline_view* view, sightline_frustum* frustum);
/** SIGHTLINE_OUTSIDE, which is certain, SIGHTLINE_CROSSING or SIGHTLINE_INSIDE of a box, minimum and maximum
 * in metres about the frustum's origin. SIGHTLINE_CROSSING for NULL. */
SIGHTLINE_API int sightline_frustum_classify(const sightline_frustum* frustum, const float box[6]);
/** 0 where a sphere, centre and radius, is surely outside, else 1; 1 for NULL. */
SIGHTLINE_API int sightline_frustum_overlaps_sphere(const sightline_frustum* frustum, const float sphere[4]);

/** Writes the indices of the boxes that overlap the frustum, ascending; *count says how many. `visible` has
 * `capacity` elements: boxes->count + SIGHTLINE_CULL_PADDING or more. Errors: BAD_ARGUMENT,
 * BUFFER_TOO_SMALL. Cost: linear; an array a coordinate without an origin costs least. */
SIGHTLINE_API sightline_status sightline_cull_boxes(const sightline_frustum* frustum,
                                                    const sightline_box_view* boxes, uint32_t* visible,
                                                    size_t capacity, size_t* count);
/** The same for spheres about the frustum's origin. Errors, Cost: the same. */
SIGHTLINE_API sightline_status sightline_cull_spheres(const sightline_frustum* frustum,
                                                      const sightline_sphere_view* spheres, uint32_t* visible,
                                                      size_t capacity, size_t* count);

/** A view prepared for projecting many things. */
typedef struct sightline_projector sightline_projector;

/** `extent`: minimum and maximum, in metres about the view's origin, of what will be projected. Errors:
 * BAD_ARGUMENT, BAD_VIEW; BAD_BOX for an extent that is not finite or turned inside out. Allocates: itself.
 */
SIGHTLINE_API sightline_status sightline_projector_create(const sightline_view* view, const float extent[6],
                                                          sightline_projector** projector);
SIGHTLINE_API void sightline_projector_destroy(sightline_projector* projector);
/** The smallest rectangle of the image, minimum x, y, maximum x, y in pixels, that surely holds the image of
 * a box about the view's origin; the whole plane where a corner lies on or behind the eye plane, or beyond
 * the extent. Returns 1 where the rectangle, clipped to the image, holds a pixel centre, else 0: nothing
 * inside it can leave a pixel. 1 for NULL, and nothing is written. */
SIGHTLINE_API int sightline_projector_rect(const sightline_projector* projector, const float box[6],
                                           float rect[4]);
/** Area of a sphere's image in px2, as `min_area` has it; infinite where the eye is inside, and for NULL. */
SIGHTLINE_API float sightline_projector_area(const sightline_projector* projector, const float sphere[4]);
/** The same, never less than the sphere covers. */
SIGHTLINE_API float sightline_projector_area_bound(const sightline_projector* projector,
                                                   const float sphere[4]);

#ifdef __cplusplus
}
#endif

#endif
