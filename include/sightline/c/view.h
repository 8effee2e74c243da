/** @file
 * Boxes, spheres and columns where they lie in the caller's memory, cameras, and the caller's threads: what
 * the functions of the other headers are given. See <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_VIEW_H
#define SIGHTLINE_C_VIEW_H

#include <sightline/c/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- boxes --- */

/** A box in metres, borders included: min <= max within 1e11 m of 0. */
typedef struct sightline_box {
  double min[3], max[3]; /**< x, y, z */
} sightline_box;

/** What lies where the pointers of a sightline_box_view point. */
enum {
  SIGHTLINE_MIN_MAX_FLOAT = 0,      /**< data[0]: minimum x, y, z; data[1]: maximum x, y, z */
  SIGHTLINE_MIN_MAX_DOUBLE = 1,     /**< the same in double precision */
  SIGHTLINE_CENTRE_HALF_FLOAT = 2,  /**< data[0]: centre x, y, z; data[1]: half size along x, y, z, >= 0 */
  SIGHTLINE_CENTRE_HALF_DOUBLE = 3, /**< the same in double precision */
  SIGHTLINE_ARRAYS_FLOAT = 4 /**< data[0] to data[5]: minimum x, y, z, maximum x, y, z, an array each */
};

/** `count` boxes in metres in the caller's own memory: members of structs, rows of a table, arrays. They are
 * read while a function that was given the view runs, not later, and rounded outwards where they do not fit
 * what the library keeps. Made by one of the functions below. */
typedef struct sightline_box_view {
  uint32_t struct_size; /**< bytes of this struct */
  uint32_t form;        /**< SIGHTLINE_MIN_MAX_FLOAT ... */
  const void* data[6];  /**< of box 0; as the form says */
  size_t stride;        /**< bytes from a box to the next; without a meaning for arrays */
  size_t count;         /**< boxes */
  double origin[3];     /**< added to single-precision coordinates; 0 unless you set it */
} sightline_box_view;

/** A view of any form, `first` and `second` as data[0] and data[1]. */
static inline sightline_box_view sightline_boxes_of_form(uint32_t form, const void* first, const void* second,
                                                         size_t stride, size_t count) {
  sightline_box_view view;
  view.struct_size = (uint32_t)sizeof view;
  view.form = form;
  view.data[0] = first, view.data[1] = second;
  view.data[2] = view.data[3] = view.data[4] = view.data[5] = NULL;
  view.stride = stride, view.count = count;
  view.origin[0] = view.origin[1] = view.origin[2] = 0;
  return view;
}
/** An array of sightline_box. */
static inline sightline_box_view sightline_boxes_of(const sightline_box* boxes, size_t count) {
  return sightline_boxes_of_form(SIGHTLINE_MIN_MAX_DOUBLE, boxes ? boxes->min : NULL,
                                 boxes ? boxes->max : NULL, sizeof(sightline_box), count);
}
/** Minimum and maximum, three numbers each, `stride` bytes from a box to the next. */
static inline sightline_box_view sightline_boxes_min_max_float(const float* minimum, const float* maximum,
                                                               size_t stride, size_t count) {
  return sightline_boxes_of_form(SIGHTLINE_MIN_MAX_FLOAT, minimum, maximum, stride, count);
}
/** The same in double precision. */
static inline sightline_box_view sightline_boxes_min_max_double(const double* minimum, const double* maximum,
                                                                size_t stride, size_t count) {
  return sightline_boxes_of_form(SIGHTLINE_MIN_MAX_DOUBLE, minimum, maximum, stride, count);
}
/** Centre and half size, three numbers each; half sizes are not negative. */
static inline sightline_box_view sightline_boxes_centre_half_float(const float* centre, const float* half,
                                                                   size_t stride, size_t count) {
  return sightline_boxes_of_form(SIGHTLINE_CENTRE_HALF_FLOAT, centre, half, stride, count);
}
/** The same in double precision. */
static inline sightline_box_view sightline_boxes_centre_half_double(const double* centre, const double* half,
                                                                    size_t stride, size_t count) {
  return sightline_boxes_of_form(SIGHTLINE_CENTRE_HALF_DOUBLE, centre, half, stride, count);
}
/** An array a coordinate, `count` numbers each: the fastest to cull flat. */
static inline sightline_box_view sightline_boxes_arrays(const float* min_x, const float* min_y,
                                                        const float* min_z, const float* max_x,
                                                        const float* max_y, const float* max_z,
                                                        size_t count) {
  sightline_box_view view =
      sightline_boxes_of_form(SIGHTLINE_ARRAYS_FLOAT, min_x, min_y, sizeof(float), count);
  view.data[2] = min_z, view.data[3] = max_x, view.data[4] = max_y, view.data[5] = max_z;
  return view;
}

/* --- spheres, handles, columns --- */

/** `count` spheres in metres and single precision in the caller's own memory. Made by one of the functions
 * below; members of structs that stand apart may then be set in `data`. Where x, y and z do not lie side by
 * side, whoever is given the view copies the spheres first, 16 bytes each, whatever comes of the call. */
typedef struct sightline_sphere_view {
  uint32_t struct_size; /**< bytes of this struct */
  uint32_t arrays;      /**< 0: data[0] to data[3] step by `stride` bytes; 1: they are arrays */
  const float* data[4]; /**< of sphere 0: x, y, z, radius */
  size_t stride;        /**< bytes from a sphere to the next; without a meaning for arrays */
  size_t count;         /**< spheres */
} sightline_sphere_view;

/** An array a coordinate, `count` numbers each: the fastest to cull flat. */
static inline sightline_sphere_view sightline_spheres_arrays(const float* x, const float* y, const float* z,
                                                             const float* radius, size_t count) {
  sightline_sphere_view view;
  view.struct_size = (uint32_t)sizeof view;
  view.arrays = 1;
  view.data[0] = x, view.data[1] = y, view.data[2] = z, view.data[3] = radius;
  view.stride = sizeof(float), view.count = count;
  return view;
}
/** Three numbers a centre, one a radius, `stride` bytes from a sphere to the next. */
static inline sightline_sphere_view sightline_spheres_of(const float* centre, const float* radius,
                                                         size_t stride, size_t count) {
  sightline_sphere_view view =
      sightline_spheres_arrays(centre, centre ? centre + 1 : NULL, centre ? centre + 2 : NULL, radius, count);
  view.arrays = 0, view.stride = stride;
  return view;
}

/** Names an object for as long as it stands in its world; `index` is the id that sightline_cull() writes. */
typedef struct sightline_handle {
  uint32_t index, generation; /**< the generation tells objects apart that had the same index */
} sightline_handle;

/** Handles in the caller's own memory: a member of structs, or an array (stride sizeof(sightline_handle)).
 * Only sightline_world_insert() and sightline_instances_insert() write there. */
typedef struct sightline_handles {
  sightline_handle* first; /**< where the first one lies */
  size_t stride;           /**< bytes from a handle to the next */
  size_t count;            /**< handles */
} sightline_handles;

/** `count` handles from `first` on, `stride` bytes from one to the next. */
static inline sightline_handles sightline_handles_of(sightline_handle* first, size_t stride, size_t count) {
  sightline_handles handles;
  handles.first = first, handles.stride = stride, handles.count = count;
  return handles;
}

/** Numbers in the caller's own memory, one an object. */
typedef struct sightline_column {
  const uint32_t* first; /**< where the first one lies */
  size_t stride;         /**< bytes from a number to the next */
  size_t count;          /**< numbers */
} sightline_column;

/** `count` numbers from `first` on, `stride` bytes from one to the next. */
static inline sightline_column sightline_column_of(const uint32_t* first, size_t stride, size_t count) {
  sightline_column column;
  column.first = first, column.stride = stride, column.count = count;
  return column;
}

/** From how far away an object is seen: from `min` metres on, and nearer than `max`. */
typedef struct sightline_distance_range {
  float min; /**< metres, not negative */
  float max; /**< metres, no less than min; infinity: however far */
} sightline_distance_range;

/** Such ranges in the caller's own memory, one an object. */
typedef struct sightline_distances {
  const sightline_distance_range* first; /**< where the first one lies */
  size_t stride;                         /**< bytes from a range to the next */
  size_t count;                          /**< ranges */
} sightline_distances;

/** `count` ranges from `first` on, `stride` bytes from one to the next. */
static inline sightline_distances sightline_distances_of(const sightline_distance_range* first, size_t stride,
                                                         size_t count) {
  sightline_distances distances;
  distances.first = first, distances.stride = stride, distances.count = count;
  return distances;
}

/* --- views --- */

/** A camera's matrices, and the size of its image in pixels: 1 to 16384 a side. The world is seen moved by
 * -origin, so that the matrices keep their precision far out; rows of the image run from y = +w down. */
typedef struct sightline_view {
  float world_to_eye[16]; /**< rigid; the eye looks down its own -z, with +y up */
  float eye_to_clip[16];  /**< the projection */
  uint32_t width, height; /**< pixels */
  double origin[3];       /**< metres */
} sightline_view;

/** A camera as people describe it. Made by sightline_camera_default(). */
typedef struct sightline_camera {
  uint32_t struct_size;      /**< bytes of this struct */
  uint32_t reversed_depth;   /**< 1: the near plane at depth 1, the far plane at 0 */
  double eye[3];             /**< metres */
  double origin[3];          /**< metres: 0; near the eye, where that is many kilometres from 0 */
  float forward[3];          /**< any length but zero, not along `up` */
  float up[3];               /**< any length but zero */
  float vertical_fov;        /**< radians, above 0 and below pi */
  float orthographic_height; /**< metres; above 0: an orthographic view, which has no field of view */
  float near_plane;          /**< metres; above 0 for perspective */
  float far_plane;           /**< metres; beyond near_plane; may be INFINITY for perspective */
  float shift[2];            /**< off-centre projection: the image's shift in half image sizes */
} sightline_camera;

/** At 0, along -z with y up, 60 degrees high, from 0.1 m to 2000 m. */
static inline sightline_camera sightline_camera_default(void) {
  sightline_camera camera;
  int axis;
  camera.struct_size = (uint32_t)sizeof camera;
  camera.reversed_depth = 0;
  for (axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = 0, camera.origin[axis] = 0;
    camera.forward[axis] = axis == 2 ? -1.0f : 0.0f, camera.up[axis] = axis == 1 ? 1.0f : 0.0f;
  }
  camera.vertical_fov = 1.04719755f;
  camera.orthographic_height = 0;
  camera.near_plane = 0.1f, camera.far_plane = 2000;
  camera.shift[0] = camera.shift[1] = 0;
  return camera;
}

/** The view of a camera with an image of width x height pixels.
 * Errors: BAD_ARGUMENT; BAD_VIEW for a camera that is not finite, has no direction, or whose planes, field of
 * view or size are out of range. Cost: some 500 ns. */
SIGHTLINE_API sightline_status sightline_camera_view(const sightline_camera* camera, uint32_t width,
                                                     uint32_t height, sightline_view* view);

/** Whether a view of the caller's own matrices can be culled with: finite, world_to_eye affine, both
 * invertible, 1 to 16384 pixels a side, the origin within 1e11 m of 0. All functions that are given a view
 * ask this themselves. Errors: BAD_ARGUMENT, BAD_VIEW. Cost: some 200 ns. */
SIGHTLINE_API sightline_status sightline_view_check(const sightline_view* view);

/* --- threads --- */

/** Runs job(data, 0) ... job(data, count - 1), each once, in any order and on any threads, and returns when
 * all are done. Jobs do not wait for each other. */
typedef void (*sightline_run_jobs)(void* user, uint32_t count, void (*job)(void* data, uint32_t index),
                                   void* data);

/** The caller's threads. All zero: the calling thread does the work. Answers are the same for any number of
 * jobs and threads. */
typedef struct sightline_jobs {
  sightline_run_jobs run; /**< NULL: the calling thread does the work */
  void* user;             /**< handed to run */
  uint32_t threads;       /**< jobs to make, at most 64; 0: 1 */
  uint32_t reserved;      /**< 0 */
} sightline_jobs;

#ifdef __cplusplus
}
#endif

#endif
