/* Occlusion in one call: a wall hides what stands behind it while its gate is shut. */
#include <sightline/sightline.h>
#include <stdio.h>
enum { kThings = 4000, kRoom = kThings + SIGHTLINE_CULL_PADDING };
static float boxes[kThings][6] = {{-500, -10, -21, 500, 40, -20}}; /* the first is the wall */
static sightline_handle handles[kThings];
static uint32_t ids[kRoom];

int main(void) {
  for (int i = 1; i < kThings; ++i) {
    const float x = (float)(i % 80 * 4 - 160), z = (float)(-30 - i / 80 * 4);
    float* box = boxes[i];
    box[0] = x, box[1] = 0, box[2] = z, box[3] = x + 1, box[4] = 2, box[5] = z + 1;
  }
  sightline_world* world = sightline_world_create(); /* if a call fails the process ends with it */
  sightline_culler* culler = sightline_culler_create();
  const sightline_box_view all = sightline_boxes_min_max_float(*boxes, *boxes + 3, sizeof *boxes, kThings);
  const sightline_handles given = sightline_handles_of(handles, sizeof *handles, kThings);
  if (sightline_world_insert(world, &all, &given, NULL)) return puts(sightline_last_error()), 2;
  uint32_t solid; /* the wall's box again: every point of it is solid */
  if (sightline_world_add_solids(world, *boxes, 1, NULL, 0, &solid)) return puts(sightline_last_error()), 2;
  const sightline_handles gate = sightline_handles_of(handles, sizeof *handles, 1);
  const sightline_occluder_placement here = sightline_occluder_placement_of(solid, NULL);
  if (sightline_world_set_occluders(world, &gate, &here, 1)) return puts(sightline_last_error()), 2;
  sightline_camera camera = sightline_camera_default();
  sightline_view seen;
  if (sightline_camera_view(&camera, 1280, 720, &seen)) return puts(sightline_last_error()), 2;
  const sightline_cull_view from = sightline_cull_view_of(&seen);
  const sightline_cull_output out = sightline_cull_output_of(ids, NULL, kRoom);
  sightline_cull_options options = sightline_cull_options_default();
  options.occlusion = SIGHTLINE_OCCLUSION_AUTOMATIC, options.costs.object = 20000; /* ns to draw one */
  for (uint8_t shut = 2; shut-- > 0;) {
    sightline_cull_result done;
    if (sightline_world_set_occluding(world, &gate, &shut, 1)) return puts(sightline_last_error()), 2;
    if (sightline_cull(culler, world, &from, 1, &options, &out, &done))
      return puts(sightline_last_error()), 2;
    printf("the gate is %s: draw %zu of %d\n", shut ? "shut" : "open", done.count, kThings);
  }
  return sightline_culler_destroy(culler), sightline_world_destroy(world), 0;
}
