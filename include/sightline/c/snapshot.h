/** @file
 * Worlds as bytes, whole or sector by sector. See <sightline/sightline.h> for what holds for all.
 */
#ifndef SIGHTLINE_C_SNAPSHOT_H
#define SIGHTLINE_C_SNAPSHOT_H

#include <sightline/c/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Writes a world's objects with their handles, columns and tables of levels, but not what they carry: hands
 * one piece of the bytes after another to sink(user, bytes, size), which returns 0 where it takes no more.
 * Errors: BAD_ARGUMENT, also while sectors of the world are out; TOO_MANY where the sink took no more. Cost:
 * linear. Allocates: the bytes of a sector at a time. */
SIGHTLINE_API sightline_status sightline_world_save(const sightline_world* world,
                                                    int (*sink)(void* user, const void* bytes, size_t size),
                                                    void* user);
/** Makes a world of all that sightline_world_save() wrote; safe with any bytes that nobody changes meanwhile.
 * Errors: BAD_ARGUMENT; BAD_FILE, where the index is the byte at which the damaged part begins. Cost: linear.
 * Allocates: the world. */
SIGHTLINE_API sightline_status sightline_world_load(const void* bytes, size_t size, sightline_world** world);

/** Brings a world that lies in bytes in by sectors. */
typedef struct sightline_world_stream sightline_world_stream;

/** Where a sector is. */
typedef enum sightline_sector_state {
  SIGHTLINE_SECTOR_OUT = 0,     /**< in the bytes alone */
  SIGHTLINE_SECTOR_COMING = 1,  /**< asked for */
  SIGHTLINE_SECTOR_IN = 2,      /**< in the world */
  SIGHTLINE_SECTOR_CHANGED = 3, /**< in the world, and no longer as in the bytes: it stays in */
  SIGHTLINE_SECTOR_DAMAGED = 4  /**< its bytes were refused: it stays out */
} sightline_sector_state;

/** A sector of a stream. */
typedef struct sightline_stream_sector {
  sightline_box bounds; /**< of its boxes as saved */
  uint64_t objects;     /**< as saved */
  uint64_t memory;      /**< bytes that it takes in the world, as saved */
  uint64_t first_byte;  /**< where it begins in the bytes */
  const char* error;    /**< why it is damaged, for good; or NULL */
  uint32_t state;       /**< a sightline_sector_state */
  uint32_t reserved;    /**< 0 */
} sightline_stream_sector;

/** Made by sightline_stream_options_default(). */
typedef struct sightline_stream_options {
  uint32_t struct_size; /**< bytes of this struct */
  uint32_t reserved;    /**< 0 */
  uint64_t budget;      /**< bytes that sectors may take in the world */
  double ahead;         /**< metres around the eyes within which sectors are wanted that no view touches */
} sightline_stream_options;

/** Any memory, and what is within 3,200 m. */
static inline sightline_stream_options sightline_stream_options_default(void) {
  sightline_stream_options options;
  options.struct_size = (uint32_t)sizeof options;
  options.reserved = 0, options.budget = UINT64_MAX, options.ahead = 3200;
  return options;
}

/** What sightline_world_stream_update() found. */
typedef struct sightline_stream_report {
  size_t in;       /**< sectors in the world */
  size_t coming;   /**< sectors asked for */
  size_t missing;  /**< sectors that a view touches and that are not in, but for damaged ones */
  size_t damaged;  /**< sectors that were refused so far */
  uint64_t memory; /**< bytes that those in and coming take */
} sightline_stream_report;

/** Checks all of the bytes but the sectors, and makes the new `world` theirs, with all sectors out. World and
 * bytes must live as long as the stream, and the bytes stay as they are.
 * Errors: BAD_ARGUMENT, also for a world that is in use; BAD_FILE. Cost: linear in sectors and ids.
 * Allocates: 16 bytes an id and what columns take by id. */
SIGHTLINE_API sightline_status sightline_world_stream_open(const void* bytes, size_t size,
                                                           sightline_world* world,
                                                           sightline_world_stream** stream);
SIGHTLINE_API void sightline_world_stream_destroy(sightline_world_stream* stream);

/** How many sectors there are; 0 for NULL. */
SIGHTLINE_API size_t sightline_world_stream_size(const sightline_world_stream* stream);
/** One of them. Errors: BAD_ARGUMENT, also where there is none. */
SIGHTLINE_API sightline_status sightline_world_stream_sector(const sightline_world_stream* stream,
                                                             size_t index, sightline_stream_sector* sector);
/** Whether the handle may name an object that is out, and so is stale only now; 0 for NULL. */
SIGHTLINE_API int sightline_world_stream_stands_out(const sightline_world_stream* stream,
                                                    sightline_handle handle);

/** To be called once a frame, before culling, by who may change the world: puts one of the
 * sectors in that sightline_world_stream_work() has made ready, wants what the views touch, nearest first,
 * then what is near, as far as the budget goes, and takes others out. `options` and `report` may be NULL.
 * Errors: BAD_ARGUMENT, BAD_VIEW. Cost: some 100 ns a sector and view; 5 to 10 ns an object that comes or
 * goes. Allocates: lists, until they were as long once; columns' rows. */
SIGHTLINE_API sightline_status sightline_world_stream_update(sightline_world_stream* stream,
                                                             const sightline_cull_view* views,
                                                             size_t view_count,
                                                             const sightline_stream_options* options,
                                                             sightline_stream_report* report);
/** Checks one of the wanted sectors and copies it, for the next update; 0 where none waits, and for NULL.
 * Cost: some 5 to 10 ns an object. Threads: any, several at once, also beside all other calls. Allocates: the
 * sector. */
SIGHTLINE_API int sightline_world_stream_work(sightline_world_stream* stream);
/** Both until all that the views touch is in, as far as the budget goes, and nothing else (`ahead` is not
 * read): for the first view. Errors: as sightline_world_stream_update(). Cost, Allocates: both. */
SIGHTLINE_API sightline_status sightline_world_stream_bring_in(sightline_world_stream* stream,
                                                               const sightline_cull_view* views,
                                                               size_t view_count,
                                                               const sightline_stream_options* options,
                                                               sightline_stream_report* report);
/** Objects that came in with the last update or bring_in that was not refused, and are in behind it: to be
 * given what they carry, occluders and triangles. Valid until the next such call. Errors: BAD_ARGUMENT for
 * NULL. */
SIGHTLINE_API sightline_status sightline_world_stream_came(const sightline_world_stream* stream,
                                                           const sightline_handle** handles, size_t* count);
/** The same of those that were in before it and went out; one that went and came again is in both. */
SIGHTLINE_API sightline_status sightline_world_stream_went(const sightline_world_stream* stream,
                                                           const sightline_handle** handles, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
