/** @file
 * Occlusion on the CPU: occluders are drawn into a depth buffer, then things are tested against it. See
 * <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_OCCLUSION_H
#define SIGHTLINE_C_OCCLUSION_H

#include <sightline/c/status.h>
#include <sightline/c/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- occluders out of meshes --- */

/** Which sides of a triangle are drawn, and so occlude. Its front is the side from which its corners turn
 * counter-clockwise, whatever a transform mirrors. */
enum { SIGHTLINE_BOTH_SIDES = 0, SIGHTLINE_FRONT_SIDE = 1 };

/** Triangles that occlude: what can be looked through must not be among them. Any number of threads may draw
 * one mesh at once. */
typedef struct sightline_occluder_mesh sightline_occluder_mesh;

/** Three floats a position, three indices a triangle, and of `sides` one a triangle or one for all of them;
 * NULL and 0: both sides of each. Triangles that join to fewer than three corners are left out. Errors:
 * BAD_ARGUMENT; BAD_MESH for indices that are not a multiple of three or out of range (the index says which),
 * for positions that are not finite (which position) and for another number of sides; TOO_MANY. Cost: n log
 * n, some 2 us a triangle: build once. Allocates: about 300 bytes a triangle. */
SIGHTLINE_API sightline_status sightline_occluder_mesh_create(const float* positions, size_t position_count,
                                                              const uint32_t* indices, size_t index_count,
                                                              const uint8_t* sides, size_t side_count,
                                                              sightline_occluder_mesh** mesh);
SIGHTLINE_API void sightline_occluder_mesh_destroy(sightline_occluder_mesh* mesh);
/** How many triangles are left; 0 for NULL. */
SIGHTLINE_API size_t sightline_occluder_mesh_triangles(const sightline_occluder_mesh* mesh);

/* --- occluders made of meshes --- */

/** How much of a mesh occludes. */
enum {
  SIGHTLINE_OCCLUDES_WHOLE = 0, /**< all of it, in no more triangles than were allowed */
  SIGHTLINE_OCCLUDES_PARTS = 1, /**< what lies inside it, its largest flat parts, or both */
  SIGHTLINE_OCCLUDES_THIN = 2,  /**< nothing: it is open or thin, and has no large flat part */
  SIGHTLINE_OCCLUDES_EMPTY = 3  /**< nothing: it has no triangle */
};

/** What occludes in a mesh's place. Read by many threads at once. */
typedef struct sightline_occluder sightline_occluder;

/** Made by sightline_occluder_parts_default(). */
typedef struct sightline_occluder_parts {
  uint32_t struct_size;    /**< bytes of this struct */
  uint32_t yield;          /**< SIGHTLINE_OCCLUDES_... */
  const float* positions;  /**< three floats each, in metres, in the mesh's space */
  size_t position_count;   /**< points */
  const uint32_t* indices; /**< three a triangle */
  size_t index_count;      /**< a multiple of three */
  const uint8_t* sides;    /**< one a triangle: index_count / 3 */
  size_t solid_triangles;  /**< so many, the first, lie inside the mesh; the others are its own */
  const float* boxes;      /**< minimum and maximum, six floats each: inside the mesh */
  size_t box_count;        /**< boxes */
} sightline_occluder_parts;

/** Nothing. */
static inline sightline_occluder_parts sightline_occluder_parts_default(void) {
  sightline_occluder_parts parts;
  parts.struct_size = (uint32_t)sizeof parts;
  parts.yield = SIGHTLINE_OCCLUDES_EMPTY;
  parts.positions = NULL, parts.position_count = 0;
  parts.indices = NULL, parts.index_count = 0, parts.sides = NULL, parts.solid_triangles = 0;
  parts.boxes = NULL, parts.box_count = 0;
  return parts;
}

/** Makes an occluder of any mesh, closed or not, given as to sightline_occluder_mesh_create(): flat pieces
 * merged, and of closed parts what lies inside them. It covers no point that the mesh does not cover as near
 * or nearer; like a solid box, what lies inside is for eyes and near planes outside of the mesh. At most so
 * many triangles, 64 are good, and so many boxes, 8; at most 4096 each, 0 for none, not both. Errors: as
 * sightline_occluder_mesh_create(); BAD_ARGUMENT. Cost: n log n; a tenth of a second to half of one a large
 * part. Allocates: about 400 bytes a triangle, meanwhile. */
SIGHTLINE_API sightline_status sightline_occluder_create(const float* positions, size_t position_count,
                                                         const uint32_t* indices, size_t index_count,
                                                         const uint8_t* sides, size_t side_count,
                                                         uint32_t most_triangles, uint32_t most_boxes,
                                                         sightline_occluder** occluder);
SIGHTLINE_API void sightline_occluder_destroy(sightline_occluder* occluder);
/** All of it, as long as `occluder` lives. `parts` was made by sightline_occluder_parts_default().
 * Errors: BAD_ARGUMENT. */
SIGHTLINE_API sightline_status sightline_occluder_contents(const sightline_occluder* occluder,
                                                           sightline_occluder_parts* parts);

/* --- triangles to ask for --- */

/** The triangles of many objects, laid out to be asked for frame after frame. Objects are numbered 0 ...
 * sightline_occludees_objects() - 1. Many threads may read while nobody changes it. */
typedef struct sightline_occludees sightline_occludees;

/** Without an object; never NULL. */
SIGHTLINE_API sightline_occludees* sightline_occludees_create(void);
SIGHTLINE_API void sightline_occludees_destroy(sightline_occludees* occludees);
/** Takes all objects anew: of object o the next triangles_per_object[o] triangles of `corners`, three points
 * of three floats each, about the origin of the views that will ask. `corner_count` is in points. Errors:
 * BAD_ARGUMENT; BAD_MESH where it is not three times the sum; TOO_MANY. Cost: a copy. Allocates: 144 bytes
 * for every four triangles begun of an object. */
SIGHTLINE_API sightline_status sightline_occludees_assign(sightline_occludees* occludees,
                                                          const float* corners, size_t corner_count,
                                                          const uint32_t* triangles_per_object,
                                                          size_t object_count);
/** Gives one object, which has moved, new corners: three points for each of its triangles. Errors:
 * BAD_ARGUMENT, also where there is no such object; BAD_MESH for another number of corners. Cost: a copy. */
SIGHTLINE_API sightline_status sightline_occludees_set(sightline_occludees* occludees, uint32_t object,
                                                       const float* corners, size_t corner_count);
/** 0 for NULL. */
SIGHTLINE_API uint32_t sightline_occludees_objects(const sightline_occludees* occludees);
/** Triangles of an object; 0 for NULL and where there is no such object. */
SIGHTLINE_API uint32_t sightline_occludees_triangles(const sightline_occludees* occludees, uint32_t object);

/* --- the depth buffer: drawing is for one thread, asking for many at once while nobody draws --- */

/** One view's depth of occluders: begin it with a view, draw, ask. It answers for that view alone. What is
 * said of places on the image holds for pixel centres alone where it was begun for those. */
typedef struct sightline_occlusion sightline_occlusion;

/** Never NULL. Allocates: a little. */
SIGHTLINE_API sightline_occlusion* sightline_occlusion_create(void);
SIGHTLINE_API void sightline_occlusion_destroy(sightline_occlusion* occlusion);
/** Empties it and takes the view, of at most 8192 pixels a side. Errors: BAD_ARGUMENT, BAD_VIEW. Cost: grows
 * with the image's tiles of 8 x 8 pixels. Allocates: 4 bytes a pixel and 24 a tile, where the view is larger
 * than any before. */
SIGHTLINE_API sightline_status sightline_occlusion_begin(sightline_occlusion* occlusion,
                                                         const sightline_view* view);
/** Which places on the image are answered for: pixel centres alone, where a rasteriser takes its one sample,
 * or any place, for multisampling, jitter and upscaling. */
enum { SIGHTLINE_COVERAGE_CENTRES = 0, SIGHTLINE_COVERAGE_AREA = 1 };
/** The same for those places (sightline_occlusion_begin answers for any), in pixels `scale` times as
 * wide as the view's: 1, 2 or 4; coarser has fewer tiles and hides less, what is promised stays the same.
 * Errors: also BAD_ARGUMENT for a coverage or scale that is none. Cost, Allocates: the same. */
SIGHTLINE_API sightline_status sightline_occlusion_begin_with(sightline_occlusion* occlusion,
                                                              const sightline_view* view, uint32_t coverage,
                                                              uint32_t scale);
/** The view it was begun with. Errors: BAD_ARGUMENT; STALE_BUFFER before begin. */
SIGHTLINE_API sightline_status sightline_occlusion_view(const sightline_occlusion* occlusion,
                                                        sightline_view* view);

/** Draws solid boxes, rounded inwards; every point inside a box must be solid. Boxes that are not valid,
 * reach farther than 1e11 m from the eye or have no inside are left out. Front to back is fastest. Errors:
 * BAD_ARGUMENT; STALE_BUFFER before begin. Cost: linear, 20 ns a box and 1 ns a tile it covers. */
SIGHTLINE_API sightline_status sightline_occlusion_draw_boxes(sightline_occlusion* occlusion,
                                                              const sightline_box_view* boxes);
/** Draws solid spheres about the view's origin. Those that are not valid or reach behind the near plane are
 * left out. Leave out, too, those of things that do. Errors, Cost: the same. */
SIGHTLINE_API sightline_status sightline_occlusion_draw_spheres(sightline_occlusion* occlusion,
                                                                const sightline_sphere_view* spheres);
/** Draws the mesh moved by `transform`, a column-major affine matrix, about the view's origin; NULL: where it
 * stands. Errors: BAD_ARGUMENT, also for a transform that is not finite or whose last row is not 0, 0, 0, 1;
 * STALE_BUFFER before begin. Cost: linear, 10 to 20 ns a triangle in view and 1 ns a tile. Allocates: until
 * it has seen its largest mesh. */
SIGHTLINE_API sightline_status sightline_occlusion_draw_mesh(sightline_occlusion* occlusion,
                                                             const sightline_occluder_mesh* mesh,
                                                             const float transform[16]);

/** visible[i]: 1 where some place on the image may see box i, 0 where surely none does; all 1 before begin.
 * `capacity` is boxes->count or more. Errors: BAD_ARGUMENT, BUFFER_TOO_SMALL. Cost: linear, some 10 ns a box.
 */
SIGHTLINE_API sightline_status sightline_occlusion_may_see_boxes(const sightline_occlusion* occlusion,
                                                                 const sightline_box_view* boxes,
                                                                 uint8_t* visible, size_t capacity);
/** The same for spheres about the view's origin. A thing whose box and sphere are both known may be seen only
 * if both may. Errors, Cost: the same. */
SIGHTLINE_API sightline_status sightline_occlusion_may_see_spheres(const sightline_occlusion* occlusion,
                                                                   const sightline_sphere_view* spheres,
                                                                   uint8_t* visible, size_t capacity);
/** Whether some place on the image may see one of the triangles, three points of three floats each about the
 * view's origin; `corner_count` is in points. Closer to the truth than a box, and dearer. Errors:
 * BAD_ARGUMENT. Cost: linear until one is seen. */
SIGHTLINE_API sightline_status sightline_occlusion_may_see_triangles(const sightline_occlusion* occlusion,
                                                                     const float* corners,
                                                                     size_t corner_count, int* visible);
/** Keeps in front, in order, those of `objects` of which a triangle may be seen, and those that `occludees`
 * has not; *kept says how many. What stands behind them is undefined. Errors: BAD_ARGUMENT. Cost: linear. */
SIGHTLINE_API sightline_status sightline_occlusion_keep_seen(const sightline_occlusion* occlusion,
                                                             const sightline_occludees* occludees,
                                                             uint32_t* objects, size_t count, size_t* kept);

/** Writes 1 / (depth along the view in metres) of the occluder at each pixel (perspective), -depth
 * (orthographic), -infinity where there is none: row by row from the top, width x height of the view. Errors:
 * BAD_ARGUMENT, BUFFER_TOO_SMALL; STALE_BUFFER before begin. Cost: linear. */
SIGHTLINE_API sightline_status sightline_occlusion_read_nearness(const sightline_occlusion* occlusion,
                                                                 float* pixels, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
