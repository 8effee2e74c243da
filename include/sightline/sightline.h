/* The C API of Sightline: a world of boxes that move, and what of it a camera may see. Usable from C, C#,
 * Rust, Python's ctypes and whatever else calls C.
 *
 * Objects are opaque; the caller owns what it creates and destroys it. A function that can fail returns a
 * status; sightline_last_error() says why, in one sentence, for the last failure on the calling thread. A
 * failed call changes nothing. Running out of memory is no status: it ends the process, as in C++ programs
 * built without exceptions. A world may be read by many threads at once (each culling with a culler of its
 * own), and changed by one while no other uses it. NULL where a pointer is needed is SIGHTLINE_BAD_ARGUMENT;
 * every destroy function takes NULL.
 *
 * Lengths are metres, the world is right-handed with y up, matrices are column-major and multiply columns,
 * clip depth is 0 to 1 (either way round). */
#ifndef SIGHTLINE_H
#define SIGHTLINE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define SIGHTLINE_API __attribute__((visibility("default")))
#else
#define SIGHTLINE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum sightline_status {
  SIGHTLINE_OK = 0,
  SIGHTLINE_BAD_ARGUMENT = 1, /* NULL, a count or an option out of range */
  SIGHTLINE_BAD_BOX = 2,      /* not finite, min > max, or beyond 1e11 m */
  SIGHTLINE_STALE_HANDLE = 3, /* names no object that stands in this world */
  SIGHTLINE_BAD_VIEW = 4,     /* not finite, not invertible, or a size out of range */
  SIGHTLINE_BUFFER_TOO_SMALL = 5
} sightline_status;

/* "0.1.0" */
SIGHTLINE_API const char* sightline_version(void);
/* Valid until the next failure on this thread; "" before the first. */
SIGHTLINE_API const char* sightline_last_error(void);

typedef struct sightline_box {
  double min[3], max[3];
} sightline_box;

/* Names an object for as long as it stands; `index` is the id that sightline_cull writes. */
typedef struct sightline_handle {
  uint32_t index, generation;
} sightline_handle;

/* The world as seen moved by -origin, so that the matrices keep their precision far out. */
typedef struct sightline_view {
  float world_to_eye[16]; /* rigid; the eye looks down its own -z */
  float eye_to_clip[16];
  uint32_t width, height; /* pixels */
  double origin[3];
} sightline_view;

/* A perspective camera with a far plane at infinity; everything else is a matter of matrices. */
SIGHTLINE_API sightline_status sightline_view_perspective(const double eye[3], const float forward[3],
                                                          const float up[3], float vertical_fov,
                                                          float near_plane, uint32_t width, uint32_t height,
                                                          sightline_view* view);

/* --- the world --- */

typedef struct sightline_world sightline_world;

SIGHTLINE_API sightline_world* sightline_world_create(void);
SIGHTLINE_API void sightline_world_destroy(sightline_world* world);
/* Writes `count` handles. */
SIGHTLINE_API sightline_status sightline_world_insert(sightline_world* world, const sightline_box* boxes,
                                                      size_t count, sightline_handle* handles);
SIGHTLINE_API sightline_status sightline_world_move(sightline_world* world, const sightline_handle* handles,
                                                    const sightline_box* boxes, size_t count);
SIGHTLINE_API sightline_status sightline_world_remove(sightline_world* world, const sightline_handle* handles,
                                                      size_t count);
/* 0 for NULL. */
SIGHTLINE_API size_t sightline_world_size(const sightline_world* world);
/* All ids lie below this. */
SIGHTLINE_API size_t sightline_world_id_limit(const sightline_world* world);
/* 1 or 0. */
SIGHTLINE_API int sightline_world_contains(const sightline_world* world, sightline_handle handle);
/* The box as it is kept: it holds what was given, and is at most a millimetre larger. */
SIGHTLINE_API sightline_status sightline_world_box(const sightline_world* world, sightline_handle handle,
                                                   sightline_box* box);

/* --- occlusion --- */

typedef struct sightline_occluder_mesh sightline_occluder_mesh;

/* Three floats a position, three indices a triangle. NULL for a NULL pointer or a coordinate not finite. */
SIGHTLINE_API sightline_occluder_mesh* sightline_occluder_mesh_create(const float* positions,
                                                                      size_t position_count,
                                                                      const uint32_t* indices,
                                                                      size_t index_count);
SIGHTLINE_API void sightline_occluder_mesh_destroy(sightline_occluder_mesh* mesh);

typedef struct sightline_occlusion sightline_occlusion;

SIGHTLINE_API sightline_occlusion* sightline_occlusion_create(void);
SIGHTLINE_API void sightline_occlusion_destroy(sightline_occlusion* occlusion);
/* Empties it and takes the view, of at most 8192 pixels a side. */
SIGHTLINE_API sightline_status sightline_occlusion_begin(sightline_occlusion* occlusion,
                                                         const sightline_view* view);
/* Solid boxes: every point inside one must be solid. After begin. */
SIGHTLINE_API sightline_status sightline_occlusion_draw_boxes(sightline_occlusion* occlusion,
                                                              const sightline_box* boxes, size_t count);
/* `transform`: three rows of (linear part | translation), relative to the view's origin. */
SIGHTLINE_API sightline_status sightline_occlusion_draw_mesh(sightline_occlusion* occlusion,
                                                             const sightline_occluder_mesh* mesh,
                                                             const float transform[12]);

/* --- culling --- */

typedef struct sightline_culler sightline_culler;

SIGHTLINE_API sightline_culler* sightline_culler_create(void);
SIGHTLINE_API void sightline_culler_destroy(sightline_culler* culler);

/* Runs job(data, 0) ... job(data, count - 1) on any threads and returns when all are done. */
typedef void (*sightline_run_jobs)(void* user, uint32_t count, void (*job)(void* data, uint32_t index),
                                   void* data);

/* All zero is a sound choice: frustum only, one thread. */
typedef struct sightline_cull_options {
  float min_area;                              /* px2; drops what covers less, approximately; 0: nothing */
  uint32_t threads;                            /* jobs to make, at most 64; 0 and 1: none */
  sightline_run_jobs run_jobs;                 /* NULL: the calling thread */
  void* user;                                  /* for run_jobs */
  const sightline_occlusion* const* occlusion; /* NULL, or one a view, each NULL or begun with that view */
} sightline_cull_options;

typedef struct sightline_cull_result {
  size_t count;              /* objects written */
  uint64_t tested;           /* objects tested one by one */
  uint64_t nodes_visited;    /* groups looked at */
  uint64_t culled_occlusion; /* objects that only occlusion dropped */
} sightline_cull_result;

/* Elements that the buffers of sightline_cull need. `options` may be NULL. */
SIGHTLINE_API size_t sightline_cull_capacity(const sightline_world* world,
                                             const sightline_cull_options* options);

/* Writes the ids of what at least one of the 1 to 8 views may see and, unless `masks` is NULL, which views:
 * bit v for view v. `options` may be NULL. Allocates nothing once the culler has grown to the world's size.
 */
SIGHTLINE_API sightline_status sightline_cull(sightline_culler* culler, const sightline_world* world,
                                              const sightline_view* views, size_t view_count,
                                              const sightline_cull_options* options, uint32_t* ids,
                                              uint8_t* masks, size_t capacity, sightline_cull_result* result);

#ifdef __cplusplus
}
#endif

#endif
