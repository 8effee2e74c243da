/** @file
 * What a cull did and why: numbers a view, and shapes to be drawn. Who does not ask pays nothing. See
 * <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_INSPECT_H
#define SIGHTLINE_C_INSPECT_H

#include <sightline/c/occlusion.h>
#include <sightline/c/status.h>
#include <sightline/c/view.h>
#include <sightline/c/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What one view of a cull looked at. Each chunk and each object of the groups in view counts once, under the
 * first that drops it, in the order given here. */
typedef struct sightline_view_stats {
  uint64_t sectors;         /**< of the world, that hold an object */
  uint64_t sectors_in_view; /**< of these */
  uint64_t groups;          /**< of up to 32 chunks, that the view does not miss */
  uint64_t chunks;          /**< of these groups: the sum of the next five */
  uint64_t chunks_outside;  /**< of the frustum */
  uint64_t chunks_dropped;  /**< as a whole, by layers, distances or casters */
  uint64_t chunks_hidden;   /**< as a whole, by occlusion */
  uint64_t chunks_whole;    /**< that the view sees without a look at their objects */
  uint64_t chunks_opened;   /**< of which objects were tested one by one */
  uint64_t objects_tested;  /**< in the chunks that were opened, holes among them */
  uint64_t objects;         /**< of these groups: the sum of the next seven */
  uint64_t outside;         /**< of the frustum */
  uint64_t by_layers;       /**< dropped by layers */
  uint64_t by_distances;    /**< dropped by distances */
  uint64_t by_casters;      /**< dropped, for their shadows cannot be seen */
  uint64_t by_area;         /**< dropped by `min_area` */
  uint64_t hidden;          /**< that only occlusion drops */
  uint64_t visible;         /**< that the cull wrote with this view's bit */
} sightline_view_stats;

/** What a box to be drawn is. */
enum {
  SIGHTLINE_DEBUG_SECTOR = 0,  /**< what a sector's objects lie in */
  SIGHTLINE_DEBUG_CHUNK = 1,   /**< what a chunk's objects lie in */
  SIGHTLINE_DEBUG_OCCLUDER = 2 /**< an object whose occluder automatic occlusion has drawn */
};

/** A box to be drawn. */
typedef struct sightline_debug_box {
  sightline_box box; /**< metres */
  uint8_t kind;      /**< SIGHTLINE_DEBUG_... */
  uint8_t seen;      /**< bit v: view v may see some of it; of occluders, drew it */
  uint8_t whole;     /**< bit v: of chunks, view v sees all of it, untested */
  uint32_t objects;  /**< how many it holds; of occluders, the object's id */
} sightline_debug_box;

/** What an inspection found. The arrays lie in the inspector until its next one. */
typedef struct sightline_inspection {
  const sightline_view_stats* views; /**< one a view */
  size_t view_count;                 /**< how many there are */
  const sightline_debug_box* boxes;  /**< sectors, then chunks of groups in view, then occluders */
  size_t box_count;                  /**< how many there are */
} sightline_inspection;

/** Looks into culls; for one thread at a time. */
typedef struct sightline_inspector sightline_inspector;

/** Never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_inspector* sightline_inspector_create(void);
SIGHTLINE_API void sightline_inspector_destroy(sightline_inspector* inspector);

/** What sightline_cull() does for these views, in the same order whenever it is called. `culler` may be NULL;
 * what one drew for them in its last cull with automatic occlusion hides, too.
 * Errors: as of sightline_cull(). Cost: some times a cull's. Threads: only reads the world, the occlusions
 * and the culler. Allocates: nothing once it has seen its largest view. */
SIGHTLINE_API sightline_status sightline_inspect(sightline_inspector* inspector, const sightline_world* world,
                                                 const sightline_cull_view* views, size_t view_count,
                                                 const sightline_culler* culler,
                                                 sightline_inspection* inspection);

/** The corners of what a view sees, three numbers each, in metres: those of the near plane (bottom left,
 * bottom right, top left, top right), then those of the far plane, or of `farthest` metres along the view
 * where that is nearer. Errors: BAD_ARGUMENT, BAD_VIEW. */
SIGHTLINE_API sightline_status sightline_view_corners(const sightline_view* view, double farthest,
                                                      double corners[24]);

/** Writes a buffer's depth as a picture, row by row from the top, a byte a pixel of its view: from 255 for
 * the nearest occluder to 55 for the farthest, 0 where there is none. Errors: BAD_ARGUMENT, STALE_BUFFER,
 * BUFFER_TOO_SMALL. Cost: linear in the pixels. Allocates: 4 bytes a pixel. */
SIGHTLINE_API sightline_status sightline_occlusion_depth_image(const sightline_occlusion* occlusion,
                                                               uint8_t* pixels, size_t count);
/** The same of what automatic occlusion drew for the view at this place in the culler's calls. Errors: the
 * same; STALE_BUFFER, too, where it has drawn nothing there. Cost, Allocates: the same. */
SIGHTLINE_API sightline_status sightline_culler_depth_image(const sightline_culler* culler, size_t place,
                                                            uint8_t* pixels, size_t count);

#ifdef __cplusplus
}
#endif

#endif
