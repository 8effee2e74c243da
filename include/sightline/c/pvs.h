/** @file
 * Potentially visible sets baked for the cells of a grid. See <sightline/sightline.h> for what holds for all.
 */
#ifndef SIGHTLINE_C_PVS_H
#define SIGHTLINE_C_PVS_H

#include <sightline/c/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What sightline_pvs_cell_at() says where there is no open cell. */
#define SIGHTLINE_NO_CELL 0xffffffffu

/** One set of objects a cell; cells run x first, then y, then z. Read by many threads at once. */
typedef struct sightline_pvs sightline_pvs;

/** Made by sightline_pvs_cells_default(). */
typedef struct sightline_pvs_cells {
  uint32_t struct_size;    /**< bytes of this struct */
  uint32_t objects;        /**< of the scene that it was baked for */
  uint64_t scene;          /**< its fingerprint, a number of whoever bakes */
  float bounds[6];         /**< minimum and maximum in metres */
  uint32_t counts[3];      /**< cells along x, y and z */
  uint32_t cells;          /**< all of them */
  const uint8_t* open;     /**< one a cell: 0 where nobody can be, and nothing is known */
  const uint64_t* first;   /**< cells + 1: cell c has visible[first[c]] ... visible[first[c + 1] - 1] */
  const uint32_t* visible; /**< ascending within a cell */
  size_t visible_count;    /**< first[cells] */
} sightline_pvs_cells;

/** No cells. */
static inline sightline_pvs_cells sightline_pvs_cells_default(void) {
  sightline_pvs_cells cells;
  int i;
  cells.struct_size = (uint32_t)sizeof cells;
  cells.objects = 0, cells.scene = 0, cells.cells = 0;
  for (i = 0; i < 6; ++i) cells.bounds[i] = 0;
  for (i = 0; i < 3; ++i) cells.counts[i] = 0;
  cells.open = NULL, cells.first = NULL, cells.visible = NULL, cells.visible_count = 0;
  return cells;
}

/** Reads the bytes of a file that sightline_pvs_write() or `sightline bake` made; safe with any bytes.
 * Errors: BAD_ARGUMENT; BAD_FILE for what is damaged, of another version, or no such file, and from a library
 * built without SIGHTLINE_PVS. Cost: linear. Allocates: the cells. */
SIGHTLINE_API sightline_status sightline_pvs_read(const void* bytes, size_t size, sightline_pvs** pvs);
SIGHTLINE_API void sightline_pvs_destroy(sightline_pvs* pvs);

/** The open cell that holds the point in metres, or SIGHTLINE_NO_CELL; the latter for NULL. */
SIGHTLINE_API uint32_t sightline_pvs_cell_at(const sightline_pvs* pvs, const float point[3]);
/** The objects that may be seen from a cell, ascending, as long as `pvs` lives. Errors: BAD_ARGUMENT, also
 * where there is no such cell. */
SIGHTLINE_API sightline_status sightline_pvs_seen_from(const sightline_pvs* pvs, uint32_t cell,
                                                       const uint32_t** objects, size_t* count);
/** Minimum and maximum of a cell in metres. Errors: BAD_ARGUMENT, also where there is no such cell. */
SIGHTLINE_API sightline_status sightline_pvs_cell_bounds(const sightline_pvs* pvs, uint32_t cell,
                                                         float bounds[6]);
/** All of it, as long as `pvs` lives. `cells` was made by sightline_pvs_cells_default().
 * Errors: BAD_ARGUMENT. */
SIGHTLINE_API sightline_status sightline_pvs_contents(const sightline_pvs* pvs, sightline_pvs_cells* cells);

/** Makes the bytes of a file, the same for the same sets, and hands them to sink(user, bytes, size), once;
 * they are gone when it returns. Errors: BAD_ARGUMENT, also for cells that are not as sightline_pvs_cells
 * says; TOO_MANY; BAD_FILE from a library built without SIGHTLINE_PVS. Cost: compresses, seconds for large
 * sets. Allocates: several times the sets. */
SIGHTLINE_API sightline_status sightline_pvs_write(const sightline_pvs_cells* cells,
                                                   void (*sink)(void* user, const void* bytes, size_t size),
                                                   void* user);

#ifdef __cplusplus
}
#endif

#endif
