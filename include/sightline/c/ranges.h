/** @file
 * What is seen as ranges of an order that stays, for who draws by chunk: an instance buffer holds the objects
 * of a world slot by slot, and a cull says which slots to draw. The order changes only by report. See
 * <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_RANGES_H
#define SIGHTLINE_C_RANGES_H

#include <sightline/c/status.h>
#include <sightline/c/view.h>
#include <sightline/c/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The slot of no object. */
#define SIGHTLINE_NO_SLOT 0xffffffffu

/** An order of a world's objects, as its chunks hold them: 8 bytes a slot, 5 a chunk, 8 for each change of
 * the largest report. */
typedef struct sightline_order sightline_order;

/** A slot that has another object than it had. */
typedef struct sightline_slot_change {
  uint32_t slot;   /**< below sightline_order_slot_limit(), or it was there before */
  uint32_t object; /**< its id; SIGHTLINE_NO_OBJECT: the slot is free now */
} sightline_slot_change;

/** Slots that have other objects. The array lies in the order until its next report. */
typedef struct sightline_order_report {
  const sightline_slot_change* changes; /**< each slot once */
  size_t count;                         /**< how many there are */
} sightline_order_report;

/** Of no world; never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_order* sightline_order_create(void);
SIGHTLINE_API void sightline_order_destroy(sightline_order* order);

/** Follows what has changed in the world, and reports what that changed in the order. Call it after all
 * changes of a frame, boxes that moved included, and before culls. The first update, one of another world,
 * and one after another order has followed this world, number all objects one after another, without gaps but
 * in chunks of objects that move, or that others have left, and report every slot that has an object, or had
 * one. Errors: BAD_ARGUMENT, TOO_MANY. Cost: grows with the chunks that changed, not with the world. Threads:
 * counts as changing the world. Allocates: where the order grows, or changes as never before. */
SIGHTLINE_API sightline_status sightline_order_update(sightline_order* order, sightline_world* world,
                                                      sightline_order_report* report);
/** The same, but numbers all objects anew, as a first update does. Errors, Cost: as of the first update.
 * Allocates: another order's memory. */
SIGHTLINE_API sightline_status sightline_order_renumber(sightline_order* order, sightline_world* world,
                                                        sightline_order_report* report);

/** All slots lie below this: the length of an instance buffer; 0 for NULL. */
SIGHTLINE_API size_t sightline_order_slot_limit(const sightline_order* order);
/** The object of each of sightline_order_slot_limit() slots, or SIGHTLINE_NO_OBJECT, until the next report;
 * NULL for NULL. */
SIGHTLINE_API const uint32_t* sightline_order_objects(const sightline_order* order);
/** The slot of an object of the world; SIGHTLINE_NO_SLOT for NULL, for a stale handle, or where the world has
 * changed since the report. */
SIGHTLINE_API uint32_t sightline_order_slot(const sightline_order* order, const sightline_world* world,
                                            sightline_handle handle);

/** How a call culls. Made by sightline_range_options_default(). */
typedef struct sightline_range_options {
  uint32_t struct_size;       /**< bytes of this struct */
  uint32_t masks;             /**< 1: masks are wanted, ranges then end where the views change */
  uint32_t whole_chunks;      /**< 1: what a view may see a part of is drawn whole: far fewer ranges */
  uint32_t reserved;          /**< 0 */
  sightline_jobs jobs;        /**< the caller's threads */
  sightline_cull_zones zones; /**< told what a cull spends its time on */
} sightline_range_options;

/** Object by object, by the calling thread. */
static inline sightline_range_options sightline_range_options_default(void) {
  const sightline_cull_options usual = sightline_cull_options_default();
  sightline_range_options options;
  options.struct_size = (uint32_t)sizeof options;
  options.masks = options.whole_chunks = options.reserved = 0;
  options.jobs = usual.jobs, options.zones = usual.zones;
  return options;
}

/** Slots that follow one another, each with an object. */
typedef struct sightline_slot_range {
  uint32_t first; /**< slot */
  uint32_t count; /**< at least 1 */
} sightline_slot_range;

/** What a cull saw. The arrays lie in the culler until its next cull, or until it is destroyed. */
typedef struct sightline_range_result {
  const sightline_slot_range* ranges; /**< no slot stands in two of them */
  const uint8_t* masks;               /**< bit v: view v may see the range; NULL unless asked for */
  size_t count;                       /**< ranges */
  uint64_t objects;                   /**< in all ranges together */
  uint64_t tested;                    /**< objects tested one by one */
  uint64_t nodes_visited;             /**< regions, groups and chunks looked at */
  uint64_t culled_occlusion; /**< objects that occlusion dropped, summed over the views; of a hidden chunk all
                                that layers and distances leave */
} sightline_range_result;

/** Culls worlds into ranges of their order; for one thread at a time. */
typedef struct sightline_range_culler sightline_range_culler;

/** Never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_range_culler* sightline_range_culler_create(void);
SIGHTLINE_API void sightline_range_culler_destroy(sightline_range_culler* culler);

/** Finds the slots of the objects that at least one of the 1 to SIGHTLINE_MAX_VIEWS views may see: those of
 * sightline_cull() without automatic occlusion, or, with whole_chunks, those and more: then no object is
 * tested, `min_area` drops nothing, and columns and occlusion only what they drop of a chunk as a whole.
 * `options` may be NULL. Errors: BAD_ARGUMENT, BAD_VIEW, STALE_BUFFER (also where the world has changed since
 * the order's report, or the order is another world's); the index is the view's. Cost: as sightline_cull(),
 * less the writing: chunks wholly in view take a few ns. Threads: only reads the world, the order and the
 * occlusions. Allocates: nothing once it has seen its largest view. */
SIGHTLINE_API sightline_status sightline_cull_ranges(sightline_range_culler* culler,
                                                     const sightline_world* world,
                                                     const sightline_order* order,
                                                     const sightline_cull_view* views, size_t view_count,
                                                     const sightline_range_options* options,
                                                     sightline_range_result* result);

#ifdef __cplusplus
}
#endif

#endif
