/** @file
 * Shadows: the views of a light's shadow maps, cascades that stand still, and which objects can throw a
 * shadow on anything that a camera sees. See <sightline/sightline.h> for what holds for all. */
#ifndef SIGHTLINE_C_SHADOWS_H
#define SIGHTLINE_C_SHADOWS_H

#include <sightline/c/occlusion.h>
#include <sightline/c/status.h>
#include <sightline/c/view.h>
#include <sightline/c/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The most cascades that one call makes. */
#define SIGHTLINE_MAX_CASCADES 16

/** Where a light's rays come from. */
enum {
  SIGHTLINE_LIGHT_DIRECTIONAL = 0, /**< from one direction: the sun */
  SIGHTLINE_LIGHT_SPOT = 1,        /**< from a point, within a cone */
  SIGHTLINE_LIGHT_POINT = 2        /**< from a point, everywhere */
};

/** What throws shadows. Made by sightline_light_default(). */
typedef struct sightline_light {
  uint32_t struct_size; /**< bytes of this struct */
  uint32_t kind;        /**< SIGHTLINE_LIGHT_...: which of the members below count */
  float direction[3];   /**< along which it shines, any length but zero: directional, spot */
  float cone;           /**< radians from side to side, above 0 and below pi: spot */
  double position[3];   /**< metres: spot, point */
  float range;          /**< metres: how far it shines: spot, point */
  float near_plane;     /**< metres: nearer things throw no shadow: spot, point */
  float reach;          /**< metres from which a thing may throw a shadow: directional */
  float reserved;       /**< 0 */
} sightline_light;

/** A sun straight above. */
static inline sightline_light sightline_light_default(void) {
  sightline_light light;
  light.struct_size = (uint32_t)sizeof light, light.kind = SIGHTLINE_LIGHT_DIRECTIONAL;
  light.direction[0] = 0, light.direction[1] = -1, light.direction[2] = 0;
  light.cone = 1.04719755f;
  light.position[0] = light.position[1] = light.position[2] = 0;
  light.range = 100, light.near_plane = 0.05f, light.reach = 1000, light.reserved = 0;
  return light;
}

/** A part of what a camera sees, by the depth along its view in metres; +-INFINITY: its own planes. */
typedef struct sightline_depth_range {
  float near_plane; /**< metres */
  float far_plane;  /**< metres, beyond near_plane */
} sightline_depth_range;

/** The view of a light's shadow map of pixels x pixels. A spot's and a point's stand about the light's
 * position; `face`, 0 to 5, is the point light's, towards +x, -x, +y, -y, +z, -z. A directional light's is
 * orthographic, holds that part of what the camera sees and all within `reach` of it towards the light, and
 * moves by whole texels. `depths` may be NULL: all that the camera sees. Errors: BAD_ARGUMENT, BAD_VIEW. */
SIGHTLINE_API sightline_status sightline_shadow_view(const sightline_light* light,
                                                     const sightline_view* camera,
                                                     const sightline_depth_range* depths, uint32_t pixels,
                                                     uint32_t face, sightline_view* view);

/** One of the parts that a camera's view is split into. */
typedef struct sightline_cascade {
  sightline_view view;          /**< of its shadow map */
  sightline_depth_range depths; /**< the part that it is for; the next begins where it ends */
} sightline_cascade;

/** Splits what a camera sees into `count` parts by depth, near ones first, each with a map of pixels x pixels
 * that is as large however the camera turns and moves by whole texels. `logarithmic`: 0, parts of one length,
 * to 1, each grows by one factor. `depths` may be NULL. Errors: BAD_ARGUMENT, BAD_VIEW. Cost: a few
 * microseconds a cascade. */
SIGHTLINE_API sightline_status sightline_split_cascades(const sightline_light* light,
                                                        const sightline_view* camera,
                                                        const sightline_depth_range* depths,
                                                        float logarithmic, uint32_t pixels,
                                                        sightline_cascade* cascades, size_t count);

/** Never NULL. Allocates: a little. */
SIGHTLINE_API sightline_shadow_casters* sightline_shadow_casters_create(void);
SIGHTLINE_API void sightline_shadow_casters_destroy(sightline_shadow_casters* casters);
/** Takes the view of a shadow map, and the camera or the part of what it sees that the map is for: `depths`
 * may be NULL. `texels` and `metres`: how far from its place a lit point may look a shadow up, 1 and 0 for a
 * mean of four texels. No object is dropped that a ray from the light passes on its way to a point there.
 * Errors: BAD_ARGUMENT, BAD_VIEW. Cost: some 20 us. */
SIGHTLINE_API sightline_status sightline_shadow_casters_begin(sightline_shadow_casters* casters,
                                                              const sightline_view* shadow,
                                                              const sightline_view* camera,
                                                              const sightline_depth_range* depths,
                                                              float texels, float metres);
/** Takes what the camera sees, ids that a cull of the world wrote: shadows matter on these objects alone and,
 * with `depth`, begun with the camera, not behind its occluders; it may be NULL. Errors: BAD_ARGUMENT,
 * STALE_BUFFER. Cost: some 100 ns an object, and with a depth a millisecond. Allocates: until it has seen its
 * largest image. */
SIGHTLINE_API sightline_status sightline_shadow_casters_receive(sightline_shadow_casters* casters,
                                                                const sightline_world* world,
                                                                const uint32_t* visible, size_t count,
                                                                const sightline_occlusion* depth);
/** Writes whether the box may throw a shadow there, 1 or 0: 0 is certain, of a box that stands in the shadow
 * view. Errors: BAD_ARGUMENT. */
SIGHTLINE_API sightline_status sightline_shadow_casters_may_cast(const sightline_shadow_casters* casters,
                                                                 const sightline_box* box, int* casts);

#ifdef __cplusplus
}
#endif

#endif
