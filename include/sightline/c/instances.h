/** @file
 * Worlds in many places: a floor, a patch of forest, a city's block is a world of its own, placed by a turn,
 * a uniform scale and a translation, one level deep. See <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_INSTANCES_H
#define SIGHTLINE_C_INSTANCES_H

#include <sightline/c/status.h>
#include <sightline/c/view.h>
#include <sightline/c/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Places of worlds. */
typedef struct sightline_instances sightline_instances;

/** Which world an instance shows, and where. */
typedef struct sightline_instance_placement {
  uint32_t world;      /**< as sightline_instances_add_world() named it */
  float transform[16]; /**< column-major, from the world's metres to metres about `origin`: a rotation, a
                          uniform scale of 1e-6 to 1e6 and a translation, right to a part in 1e4 */
  uint32_t reserved;   /**< not read */
  double origin[3];    /**< metres */
} sightline_instance_placement;

/** `count` placements anywhere in the caller's memory, `stride` bytes from one to the next. */
typedef struct sightline_placements {
  const void* first; /**< the first sightline_instance_placement */
  size_t stride;     /**< bytes from one to the next */
  size_t count;      /**< how many there are */
} sightline_placements;

/** What stands at `first`, `stride` bytes from one to the next. */
static inline sightline_placements sightline_placements_of(const void* first, size_t stride, size_t count) {
  sightline_placements placements;
  placements.first = first, placements.stride = stride, placements.count = count;
  return placements;
}

/** Never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_instances* sightline_instances_create(void);
SIGHTLINE_API void sightline_instances_destroy(sightline_instances* instances);

/** Keeps a world for instances to show, which must not be destroyed before it is removed from here, or these
 * are destroyed. It may change between culls; see sightline_instances_update(). Errors: BAD_ARGUMENT,
 * TOO_MANY. Cost: linear in the world's sectors. Allocates: some 80 bytes. */
SIGHTLINE_API sightline_status sightline_instances_add_world(sightline_instances* instances,
                                                             const sightline_world* world, uint32_t* name);
/** Forgets a world; its name may be used again. Errors: BAD_ARGUMENT where there is none of the name, or an
 * instance shows it. */
SIGHTLINE_API sightline_status sightline_instances_remove_world(sightline_instances* instances,
                                                                uint32_t name);
/** To be called when worlds have changed, before the next cull: gives the instances of those that reach
 * elsewhere now new boxes. Errors: BAD_ARGUMENT, BAD_BOX where an instance would reach out of +-1e11 m; the
 * index is its id. Cost: linear in the instances of such worlds. Allocates: as sightline_world_move(). */
SIGHTLINE_API sightline_status sightline_instances_update(sightline_instances* instances);

/** Puts instances in and writes their handles. `layers` may be NULL: a view sees an object iff it shares a
 * layer with the instance and a layer with the object. Errors: BAD_ARGUMENT (a world of no such name, a
 * transform or an origin that is none, lengths that differ), BAD_BOX where what is placed reaches beyond
 * 1e11 m, TOO_MANY; the index is the placement's. Cost: linear, some 500 ns each. Allocates: some 250 bytes
 * each. */
SIGHTLINE_API sightline_status sightline_instances_insert(sightline_instances* instances,
                                                          const sightline_placements* placements,
                                                          const sightline_handles* handles,
                                                          const sightline_column* layers);
/** Gives each instance a new placement, also of another world. Errors: as insert; STALE_HANDLE. Cost: linear.
 * Allocates: as sightline_world_move(). */
SIGHTLINE_API sightline_status sightline_instances_move(sightline_instances* instances,
                                                        const sightline_handles* handles,
                                                        const sightline_placements* placements);
/** Takes the instances out. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost: linear. Allocates: a list of free ids.
 */
SIGHTLINE_API sightline_status sightline_instances_remove(sightline_instances* instances,
                                                          const sightline_handles* handles);
/** Gives each instance new layers. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost: linear. Allocates: as
 * sightline_world_set_layers(). */
SIGHTLINE_API sightline_status sightline_instances_set_layers(sightline_instances* instances,
                                                              const sightline_handles* handles,
                                                              const sightline_column* layers);

/** How many instances there are; 0 for NULL. */
SIGHTLINE_API size_t sightline_instances_size(const sightline_instances* instances);
/** All ids of instances lie below this; 0 for NULL. */
SIGHTLINE_API size_t sightline_instances_id_limit(const sightline_instances* instances);
/** How many objects all instances show together; 0 for NULL. Cost: linear in the worlds. */
SIGHTLINE_API uint64_t sightline_instances_objects(const sightline_instances* instances);
/** 1 or 0; 0 for NULL. */
SIGHTLINE_API int sightline_instances_contains(const sightline_instances* instances, sightline_handle handle);
/** The handle of the instance that has this id now; where none has, one that is not contained. */
SIGHTLINE_API sightline_handle sightline_instances_handle(const sightline_instances* instances, uint32_t id);
/** Where the instance is, and what it shows. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_instances_placement(const sightline_instances* instances,
                                                             sightline_handle handle,
                                                             sightline_instance_placement* placement);
/** A box that holds all that the instance shows. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_instances_box(const sightline_instances* instances,
                                                       sightline_handle handle, sightline_box* box);

/** How a call culls. Made by sightline_instance_options_default(). */
typedef struct sightline_instance_options {
  uint32_t struct_size;                  /**< bytes of this struct */
  uint32_t values_for_ids;               /**< 1: writes the objects' values instead of their ids */
  sightline_jobs jobs;                   /**< the caller's threads, among which instances are shared out */
  uint32_t masks;                        /**< 1: masks are wanted */
  uint32_t levels;                       /**< 1: levels and fades are wanted */
  sightline_level_options level_options; /**< `key` and `cut` are not read; a hysteresis above 0 is refused */
  uint64_t most_objects;                 /**< that there may be room for; 2^31 at most */
  sightline_cull_zones zones;            /**< told what a cull spends its time on */
} sightline_instance_options;

/** Ids alone, by the calling thread, room for 2^26 objects. */
static inline sightline_instance_options sightline_instance_options_default(void) {
  const sightline_cull_options usual = sightline_cull_options_default();
  sightline_instance_options options;
  options.struct_size = (uint32_t)sizeof options;
  options.values_for_ids = options.masks = options.levels = 0;
  options.jobs = usual.jobs, options.level_options = usual.levels, options.zones = usual.zones;
  options.most_objects = (uint64_t)1 << 26;
  return options;
}

/** The objects that are seen of an instance: `count` of the result's ids, from `first` on. */
typedef struct sightline_instance_range {
  uint32_t instance; /**< the id of its handle */
  uint32_t first;    /**< of the result's ids, masks, levels and fades */
  uint32_t count;    /**< at least 1 */
} sightline_instance_range;

/** What a cull saw. The arrays lie in the culler until its next cull, or until it is destroyed. */
typedef struct sightline_instance_result {
  const sightline_instance_range* ranges; /**< an instance each; those that are seen whole may share ids */
  size_t range_count;                     /**< how many there are */
  const uint32_t* ids;                    /**< objects, as their own world names them, or their values */
  const uint8_t* masks;                   /**< bit v: view v may see it; NULL unless asked for */
  const uint8_t* levels;                  /**< of detail, 0 the finest; NULL unless asked for */
  const uint8_t* fades;                   /**< of 255, the share of the next coarser level; NULL likewise */
  size_t id_count;                        /**< elements of each of these */
  uint64_t objects;                       /**< in all ranges together */
  uint64_t tested;                        /**< objects tested one by one, and instances */
  uint64_t nodes_visited;                 /**< regions, groups and chunks looked at */
  uint64_t culled_occlusion;              /**< objects, and whole instances, that occlusion dropped, as
                                             sightline_cull_result counts */
} sightline_instance_result;

/** Culls instances; for one thread at a time. */
typedef struct sightline_instance_culler sightline_instance_culler;

/** Never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_instance_culler* sightline_instance_culler_create(void);
SIGHTLINE_API void sightline_instance_culler_destroy(sightline_instance_culler* culler);

/** Finds the objects that at least one of the 1 to SIGHTLINE_MAX_VIEWS views may see, instance by instance,
 * in an order that depends on the calls so far alone. Nothing that is visible anywhere on the image is
 * left out, but by `layers`, by `min_area` of objects as they are placed, and by `distances`, in metres of
 * the objects' own world from the eye; by an occlusion begun for pixel centres, nothing that is visible at
 * one. `casters` are refused, and what objects carry to hide others is not drawn. `options` may be NULL.
 * Errors: BAD_ARGUMENT (also where a world reaches elsewhere since its instances were placed: the index is
 * its name, and sightline_instances_update() is due), BAD_VIEW, STALE_BUFFER; TOO_MANY where the views may
 * see more than most_objects. Cost: as sightline_cull() of a world in which all that stood by itself, some
 * 600 ns a view for each instance seen in part, some 100 ns for one seen whole. Threads: only reads the
 * instances, the worlds and the occlusions. Allocates: nothing once it has seen its largest view. */
SIGHTLINE_API sightline_status sightline_cull_instances(sightline_instance_culler* culler,
                                                        const sightline_instances* instances,
                                                        const sightline_cull_view* views, size_t view_count,
                                                        const sightline_instance_options* options,
                                                        sightline_instance_result* result);

#ifdef __cplusplus
}
#endif

#endif
