/** @file
 * A world of boxes that come, move and go, and the culling of it. See <sightline/sightline.h> for what holds
 * for all. */
#ifndef SIGHTLINE_C_WORLD_H
#define SIGHTLINE_C_WORLD_H

#include <sightline/c/occlusion.h>
#include <sightline/c/status.h>
#include <sightline/c/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/** No id, index or value. */
#define SIGHTLINE_NO_OBJECT 0xffffffffu
/** In all layers. */
#define SIGHTLINE_ALL_LAYERS 0xffffffffu
/** The most views that one call culls together. */
#define SIGHTLINE_MAX_VIEWS 8

/* --- the world: read by many threads at once, each culling with a culler of its own, while none changes it;
 * changing is for one --- */

/** Boxes that each keep their place to half a millimetre anywhere within 1e11 m of 0. */
typedef struct sightline_world sightline_world;

/** What objects are given besides their boxes; each column has an element an object, or none at all. Made by
 * sightline_object_columns_default(). */
typedef struct sightline_object_columns {
  uint32_t struct_size;    /**< bytes of this struct */
  uint32_t reserved;       /**< 0 */
  sightline_column layers; /**< a bit a layer; none: all. A view sees what shares a bit with its layers. */
  sightline_column values; /**< numbers that sightline_cull() can write instead of ids; none: the id */
  /** From where objects are seen; none: from anywhere. A view sees an object iff the distance from its eye to
   * the centre of the object's box, as kept, is in the range, times the view's distance_scale. */
  sightline_distances distances;
} sightline_object_columns;

/** No columns. */
static inline sightline_object_columns sightline_object_columns_default(void) {
  sightline_object_columns columns;
  columns.struct_size = (uint32_t)sizeof columns, columns.reserved = 0;
  columns.layers = columns.values = sightline_column_of(NULL, sizeof(uint32_t), 0);
  columns.distances = sightline_distances_of(NULL, sizeof(sightline_distance_range), 0);
  return columns;
}

/** An empty world; never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_world* sightline_world_create(void);
/** Cost: linear. */
SIGHTLINE_API void sightline_world_destroy(sightline_world* world);

/** Puts boxes->count objects in and writes their handles. `columns` may be NULL; all have one length. Errors:
 * BAD_ARGUMENT (pointers, strides, lengths), BAD_BOX (not min <= max within 1e11 m of 0), TOO_MANY (beyond
 * 2^31 objects). Cost: linear, some 400 to 600 ns an object. Allocates: 53 to 70 bytes an
 * object. */
SIGHTLINE_API sightline_status sightline_world_insert(sightline_world* world, const sightline_box_view* boxes,
                                                      const sightline_handles* handles,
                                                      const sightline_object_columns* columns);
/** Gives each object a new box; one that is listed twice keeps the last. Errors: BAD_ARGUMENT, BAD_BOX,
 * STALE_HANDLE. Cost: linear, some 10 ns an object that moves every frame, twice that where it is given in
 * double precision, some 200 ns one that seldom does; to be called once a frame, with nothing too, for it
 * files what has come to rest. Allocates: where objects gather, or move, as never before. */
SIGHTLINE_API sightline_status sightline_world_move(sightline_world* world, const sightline_handles* handles,
                                                    const sightline_box_view* boxes);
/** Takes the objects out. Errors: BAD_ARGUMENT; STALE_HANDLE, also for one that is listed twice. Cost:
 * linear. Allocates: a list of free ids. */
SIGHTLINE_API sightline_status sightline_world_remove(sightline_world* world,
                                                      const sightline_handles* handles);
/** Gives each object new layers. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost: linear. Allocates: 4 bytes an id,
 * some 6 an object, the first time. */
SIGHTLINE_API sightline_status sightline_world_set_layers(sightline_world* world,
                                                          const sightline_handles* handles,
                                                          const sightline_column* layers);
/** Gives each object a new value. Errors, Cost: the same. Allocates: 4 bytes an id, the first time. */
SIGHTLINE_API sightline_status sightline_world_set_values(sightline_world* world,
                                                          const sightline_handles* handles,
                                                          const sightline_column* values);
/** Gives each object new distances. Errors: BAD_ARGUMENT, also for what is no range; STALE_HANDLE. Cost: the
 * same. Allocates: 8 bytes an id, some 12 an object, the first time. */
SIGHTLINE_API sightline_status sightline_world_set_distances(sightline_world* world,
                                                             const sightline_handles* handles,
                                                             const sightline_distances* distances);

/* --- what objects hide behind them, from culls with SIGHTLINE_OCCLUSION_AUTOMATIC --- */

/** No occluder. */
#define SIGHTLINE_NO_OCCLUDER 0xffffffffu

/** Which occluder an object carries, and where. Made by sightline_occluder_placement_of(). */
typedef struct sightline_occluder_placement {
  uint32_t occluder;   /**< SIGHTLINE_NO_OCCLUDER takes away what the object carried */
  float transform[16]; /**< column-major and affine: from the occluder's space to metres about `origin` */
  uint32_t reserved;   /**< 0 */
  double origin[3];    /**< metres */
} sightline_occluder_placement;

/** Moved by `transform`, about the world's origin; NULL: where it stands. */
static inline sightline_occluder_placement sightline_occluder_placement_of(uint32_t occluder,
                                                                           const float* transform) {
  sightline_occluder_placement placement = {0, {0}, 0, {0, 0, 0}};
  int i;
  placement.occluder = occluder;
  for (i = 0; i < 16; ++i) placement.transform[i] = transform ? transform[i] : i % 5 == 0 ? 1.0f : 0.0f;
  return placement;
}

/** Keeps what sightline_occluder_create() made for objects to carry, as many as like; *name is its name in
 * this world. Errors: BAD_ARGUMENT. Cost: some 2 us a triangle. Allocates: a copy. */
SIGHTLINE_API sightline_status sightline_world_add_occluder(sightline_world* world,
                                                            const sightline_occluder* occluder,
                                                            uint32_t* name);
/** The same of solid boxes, minimum and maximum, six floats each, and solid spheres, centre and radius, four
 * floats each: they lie inside what carries them. Errors: BAD_ARGUMENT, BAD_BOX. Cost, Allocates: a copy. */
SIGHTLINE_API sightline_status sightline_world_add_solids(sightline_world* world, const float* boxes,
                                                          size_t box_count, const float* spheres,
                                                          size_t sphere_count, uint32_t* name);
/** The same of all triangles that the objects show, given as to sightline_occluder_mesh_create(). Errors: as
 * there. Cost: some 2 us a triangle. Allocates: about 300 bytes a triangle. */
SIGHTLINE_API sightline_status sightline_world_add_surface(sightline_world* world, const float* positions,
                                                           size_t position_count, const uint32_t* indices,
                                                           size_t index_count, const uint8_t* sides,
                                                           size_t side_count, uint32_t* name);
/** Forgets an occluder that no object carries; its name may be used again. Errors: BAD_ARGUMENT. */
SIGHTLINE_API sightline_status sightline_world_remove_occluder(sightline_world* world, uint32_t name);
/** Gives each object an occluder, switched on. Call it again when the object has moved, behind
 * sightline_world_move(), or has turned: of one whose box is another one than it was then, nothing is drawn,
 * nor is what reaches out of that box. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost: linear. Allocates: some 250
 * bytes an object that carries one, 4 an id. */
SIGHTLINE_API sightline_status sightline_world_set_occluders(sightline_world* world,
                                                             const sightline_handles* handles,
                                                             const sightline_occluder_placement* placements,
                                                             size_t count);
/** Switches what the objects carry on (1) or off (0), as doors do. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost:
 * linear. */
SIGHTLINE_API sightline_status sightline_world_set_occluding(sightline_world* world,
                                                             const sightline_handles* handles,
                                                             const uint8_t* on, size_t count);
/** Gives an object all of its triangles, three points of three floats each about `origin` (NULL: the
 * world's), which are asked for where its box may be seen, by views of the same origin; none takes them away.
 * Call it again when the object has moved, behind sightline_world_move(), or has turned: while its box is
 * another one, they are not asked. `corner_count` is in points; `sides` is SIGHTLINE_FRONT_SIDE only
 * where no view, a shadow map's included, draws their backs, else SIGHTLINE_BOTH_SIDES. Errors: BAD_ARGUMENT,
 * BAD_MESH, STALE_HANDLE, TOO_MANY. Cost: a copy. Allocates: 144 bytes for every four triangles begun, 4 an
 * id. */
SIGHTLINE_API sightline_status sightline_world_set_triangles(sightline_world* world, sightline_handle handle,
                                                             const float* corners, size_t corner_count,
                                                             const double* origin, uint8_t sides);

/** Objects; 0 for NULL. */
SIGHTLINE_API size_t sightline_world_size(const sightline_world* world);
/** All ids lie below this; those of removed objects are reused. 0 for NULL. */
SIGHTLINE_API size_t sightline_world_id_limit(const sightline_world* world);
/** 1 or 0; 0 for NULL. */
SIGHTLINE_API int sightline_world_contains(const sightline_world* world, sightline_handle handle);
/** The handle of the object that has this id now; where none has, one that no world contains. */
SIGHTLINE_API sightline_handle sightline_world_handle(const sightline_world* world, uint32_t id);
/** The box as it is kept: it holds what was given, and is at most a millimetre larger.
 * Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_world_box(const sightline_world* world, sightline_handle handle,
                                                   sightline_box* box);
/** The object's layers. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_world_layers(const sightline_world* world, sightline_handle handle,
                                                      uint32_t* layers);
/** The object's value. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_world_value(const sightline_world* world, sightline_handle handle,
                                                     uint32_t* value);
/** The object's distances. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_world_distances(const sightline_world* world,
                                                         sightline_handle handle,
                                                         sightline_distance_range* distances);

/** The most levels of detail of an object. */
#define SIGHTLINE_MAX_LEVELS 8
/** The table of objects that have no level but 0. */
#define SIGHTLINE_NO_LEVELS 0u

/** Keeps a table of levels of detail for objects to share: `count` sizes in pixels, 1 to 7, descending. An
 * object has level i as long as it is sizes[i] or larger and less than sizes[i - 1]; smaller than all of them
 * it has level `count`. It is as large as the diameter of the ball around its box. Errors: BAD_ARGUMENT,
 * TOO_MANY. Allocates: 32 bytes. */
SIGHTLINE_API sightline_status sightline_world_add_levels(sightline_world* world, const float* sizes,
                                                          size_t count, uint32_t* name);
/** Gives each object a table of levels, or SIGHTLINE_NO_LEVELS. Errors: BAD_ARGUMENT, STALE_HANDLE. Cost:
 * linear. Allocates: 2 bytes an id, the first time. */
SIGHTLINE_API sightline_status sightline_world_set_levels(sightline_world* world,
                                                          const sightline_handles* handles,
                                                          const sightline_column* tables);
/** The object's table of levels. Errors: BAD_ARGUMENT, STALE_HANDLE. */
SIGHTLINE_API sightline_status sightline_world_levels(const sightline_world* world, sightline_handle handle,
                                                      uint32_t* table);

/* --- culling --- */

/** Of sightline_cull_view's distance_view: the view itself. */
#define SIGHTLINE_OWN_VIEW 0xffffffffu

/** Which objects can throw a shadow on what a camera sees: see <sightline/c/shadows.h>. */
typedef struct sightline_shadow_casters sightline_shadow_casters;

/** A camera, an eye, a shadow cascade: whatever sees the world. Made by sightline_cull_view_of(). */
typedef struct sightline_cull_view {
  uint32_t struct_size;                 /**< bytes of this struct */
  uint32_t layers;                      /**< sees objects whose layers share a bit with these */
  float min_area;                       /**< px2: drops what covers less, approximately; 0: nothing */
  uint32_t reserved;                    /**< 0 */
  const sightline_occlusion* occlusion; /**< begun with this same view, occluders drawn; or NULL */
  sightline_view view;                  /**< what it sees, and the size of its image */
  float distance_scale;   /**< times the objects' distances: 2 shows them from twice as far; above 0 */
  uint32_t distance_view; /**< place of the view from whose eye distances are measured, as a shadow cascade
                             takes its camera's; SIGHTLINE_OWN_VIEW: this one's */
  const sightline_shadow_casters* casters; /**< begun with this same view: leaves only what can throw a shadow
                                              on what a camera sees; or NULL */
} sightline_cull_view;

/** A view that sees all layers, drops nothing small and has no occlusion; of zeros, which sightline_cull()
 * refuses, for NULL. */
static inline sightline_cull_view sightline_cull_view_of(const sightline_view* view) {
  static const sightline_view none = {{0}, {0}, 0, 0, {0}};
  sightline_cull_view result;
  result.struct_size = (uint32_t)sizeof result;
  result.layers = SIGHTLINE_ALL_LAYERS;
  result.min_area = 0, result.reserved = 0;
  result.occlusion = NULL;
  result.view = view ? *view : none;
  result.distance_scale = 1, result.distance_view = SIGHTLINE_OWN_VIEW;
  result.casters = NULL;
  return result;
}

/** Whether a cull draws the occluders that objects carry. */
enum {
  SIGHTLINE_OCCLUSION_NONE = 0,     /**< it does not; a view may still bring an occlusion */
  SIGHTLINE_OCCLUSION_AUTOMATIC = 1 /**< as far as that pays; no view brings an occlusion */
};

/** What counted work costs, in any one unit; the defaults are nanoseconds. */
typedef struct sightline_cull_costs {
  float object; /**< an object that is left, for who draws it; 0: what sightline_report_frame_time() taught */
  float node;   /**< a region, group or chunk looked at */
  float test;   /**< an object tested against planes */
  float candidate; /**< an object looked at for what it carries */
  float tile;      /**< 8 x 8 pixels emptied or drawn */
  float shape;     /**< a box or a sphere drawn */
  float triangle;  /**< a triangle drawn */
  float query;     /**< a box asked */
  float occludee;  /**< a triangle asked */
  float reserved;  /**< 0 */
} sightline_cull_costs;

/** A profiler that has zones, as Tracy, Optick and Perfetto do: both are called by whichever thread does the
 * work, the caller's or a job's, one zone within another. */
typedef struct sightline_cull_zones {
  void (*begin)(void* user, const char* name); /**< a name that lives as long as the program; or NULL */
  void (*end)(void* user); /**< of the zone that this thread began last; NULL where begin is */
  void* user;              /**< handed to both */
} sightline_cull_zones;

/** How levels of detail are chosen: once a call, for all its views. Read where levels are asked for. */
typedef struct sightline_level_options {
  uint32_t view;    /**< the place of the view by whose image objects have their sizes */
  uint32_t key;     /**< whose memory, below SIGHTLINE_MAX_VIEWS: a camera's of several that take turns */
  float hysteresis; /**< how far beyond a limit a level is kept, as a share of it: 0 to below 1 */
  float fade;       /**< how far above its lower limit a level begins to fade into the next, as a share */
  float scale;      /**< times the sizes; above 0 */
  uint32_t cut;     /**< 1: the camera was cut, nothing is remembered from before */
} sightline_level_options;

/** How a call culls; the same for all its views. Made by sightline_cull_options_default(). */
typedef struct sightline_cull_options {
  uint32_t struct_size;           /**< bytes of this struct */
  uint32_t values_for_ids;        /**< 1: writes the objects' values instead of their ids */
  sightline_jobs jobs;            /**< the caller's threads */
  uint32_t occlusion;             /**< SIGHTLINE_OCCLUSION_... */
  uint32_t reserved;              /**< 0 */
  sightline_cull_costs costs;     /**< finite, not negative; read by automatic occlusion */
  uint32_t coverage;              /**< SIGHTLINE_COVERAGE_...: which places automatic occlusion answers for */
  uint32_t scale;                 /**< pixels of the view along a side of one of its buffer's: 1, 2 or 4 */
  sightline_cull_zones zones;     /**< told what a cull spends its time on */
  sightline_level_options levels; /**< how levels of detail are chosen */
} sightline_cull_options;

/** Ids, by the calling thread, without occlusion. */
static inline sightline_cull_options sightline_cull_options_default(void) {
  static const sightline_cull_costs costs = {0, 10, 1, 8, 2, 30, 15, 12, 10, 0};
  sightline_cull_options options;
  options.struct_size = (uint32_t)sizeof options;
  options.values_for_ids = 0;
  options.jobs.run = NULL, options.jobs.user = NULL, options.jobs.threads = 0, options.jobs.reserved = 0;
  options.occlusion = SIGHTLINE_OCCLUSION_NONE, options.reserved = 0;
  options.costs = costs;
  options.coverage = SIGHTLINE_COVERAGE_AREA, options.scale = 1;
  options.zones.begin = NULL, options.zones.end = NULL, options.zones.user = NULL;
  options.levels.view = options.levels.key = options.levels.cut = 0;
  options.levels.hysteresis = options.levels.fade = 0, options.levels.scale = 1;
  return options;
}

/** Where a cull writes: arrays of `capacity` elements, sightline_cull_capacity() or more. What stands behind
 * the count that comes back is undefined. Made by sightline_cull_output_of(). */
typedef struct sightline_cull_output {
  uint32_t struct_size; /**< bytes of this struct */
  uint32_t reserved;    /**< 0 */
  uint32_t* ids;        /**< the objects, or their values */
  uint8_t* masks;       /**< bit v: view v may see the object; NULL: not wanted */
  size_t capacity;      /**< elements of each */
  uint8_t* levels;      /**< of detail, 0 the finest; NULL: not wanted */
  uint8_t* fades;       /**< of 255, the share of the next coarser level, with levels; NULL: not wanted */
} sightline_cull_output;

/** Arrays of `capacity` elements; `masks` may be NULL. */
static inline sightline_cull_output sightline_cull_output_of(uint32_t* ids, uint8_t* masks, size_t capacity) {
  sightline_cull_output output;
  output.struct_size = (uint32_t)sizeof output, output.reserved = 0;
  output.ids = ids, output.masks = masks, output.capacity = capacity;
  output.levels = output.fades = NULL;
  return output;
}

/** What a cull did. */
typedef struct sightline_cull_result {
  size_t count;              /**< objects written */
  uint64_t tested;           /**< objects tested one by one */
  uint64_t nodes_visited;    /**< regions, groups and chunks looked at */
  uint64_t culled_occlusion; /**< objects that occlusion dropped, summed over the views; of a hidden chunk all
                                that layers and distances leave */
  double cost;               /**< automatic occlusion: of this cull and of drawing what it left */
  double frustum_cost;       /**< the same by frustum alone: that cull, and drawing all that it leaves */
  uint64_t reserved[2];      /**< 0 */
} sightline_cull_result;

/** Elements that the arrays of a sightline_cull_output need: all objects, and what SIMD and jobs write
 * beyond. `options` may be NULL. 0 for NULL and for options whose struct, threads,
 * occlusion or coverage are unknown. */
SIGHTLINE_API size_t sightline_cull_capacity(const sightline_world* world,
                                             const sightline_cull_options* options);

/** Remembers from frame to frame what helps the next; for one thread at a time. */
typedef struct sightline_culler sightline_culler;

/** Never NULL. Allocates: its first tables. */
SIGHTLINE_API sightline_culler* sightline_culler_create(void);
SIGHTLINE_API void sightline_culler_destroy(sightline_culler* culler);
/** Teaches what an object costs, where the costs' `object` is 0: how many nanoseconds the frame took to
 * draw what the last cull left, without any wait for the display. Errors: BAD_ARGUMENT. */
SIGHTLINE_API sightline_status sightline_report_frame_time(sightline_culler* culler, double nanoseconds);

/** Writes the ids of what at least one of the 1 to SIGHTLINE_MAX_VIEWS views may see and which views see
 * each, in an order that depends on the calls so far alone, culls between moves among them. Nothing that is
 * visible anywhere on the image is left out, but by `layers`, `distances`, `min_area` and `casters`; by
 * occlusion for pixel centres, nothing that is visible at one. All views have the same struct_size. `options`
 * may be NULL. With SIGHTLINE_OCCLUSION_AUTOMATIC what objects carry is drawn as far as that pays, in counted
 * work x costs: no frame, culled and drawn, costs more than 1.05 x one by frustum alone, and all of a
 * culler's together no more than 1.02 x. Errors: BAD_ARGUMENT, BAD_VIEW, BUFFER_TOO_SMALL, STALE_BUFFER; the
 * index is the view's. Cost: grows with what is visible and with the boundary of the views, not with the
 * world. Threads: only reads the world and the occlusions. Allocates: nothing once the culler has grown to
 * the world's size. */
SIGHTLINE_API sightline_status sightline_cull(sightline_culler* culler, const sightline_world* world,
                                              const sightline_cull_view* views, size_t view_count,
                                              const sightline_cull_options* options,
                                              const sightline_cull_output* output,
                                              sightline_cull_result* result);

#ifdef __cplusplus
}
#endif

#endif
