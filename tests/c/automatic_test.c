/* Occlusion in one call: what objects carry, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kCount = 300, kRoom = kCount + 64 };

static uint32_t ids[kRoom];
static sightline_box boxes[kCount];
static sightline_handle handles[kCount];
static const float wall[6] = {-50, -50, -5.5f, 50, 50, -4.5f};

static size_t left(sightline_culler* culler, const sightline_world* world) {
  sightline_cull_options options = sightline_cull_options_default();
  sightline_cull_result result;
  options.occlusion = SIGHTLINE_OCCLUSION_AUTOMATIC, options.costs.object = 100000;
  EXPECT(cull_ahead(culler, world, &options, ids, kRoom, &result) == SIGHTLINE_OK);
  EXPECT(result.frustum_cost > 0 && result.cost <= 1.05 * result.frustum_cost);
  EXPECT(result.reserved[0] == 0 && result.reserved[1] == 0);
  const size_t count = result.count;
  options.coverage = SIGHTLINE_COVERAGE_AREA, options.scale = 2;
  EXPECT(cull_ahead(culler, world, &options, ids, kRoom, &result) == SIGHTLINE_OK);
  EXPECT(result.count >= count);
  options.scale = 3;
  EXPECT(cull_ahead(culler, world, &options, ids, kRoom, &result) == SIGHTLINE_BAD_ARGUMENT);
  return count;
}

/* A row of boxes, of which the first is a wall. */
static sightline_world* walled_world(sightline_handles* first) {
  sightline_world* world = sightline_world_create();
  row_of_boxes(boxes, kCount);
  for (int a = 0; a < 3; ++a) boxes[0].min[a] = wall[a], boxes[0].max[a] = wall[a + 3];
  const sightline_box_view view = sightline_boxes_of(boxes, kCount);
  const sightline_handles to = sightline_handles_of(handles, sizeof *handles, kCount);
  EXPECT(sightline_world_insert(world, &view, &to, NULL) == SIGHTLINE_OK);
  *first = sightline_handles_of(handles, sizeof *handles, 1);
  return world;
}

static void hide_by(sightline_world* world, const sightline_handles* first, uint32_t name) {
  const sightline_occluder_placement placement = sightline_occluder_placement_of(name, NULL);
  EXPECT(sightline_world_set_occluders(world, first, &placement, 1) == SIGHTLINE_OK);
}

static void what_hides(void) {
  sightline_handles first;
  sightline_world* world = walled_world(&first);
  sightline_culler* culler = sightline_culler_create();
  const size_t all = left(culler, world);
  EXPECT(all > 250);
  const float quad[12] = {-50, -50, -5, 50, -50, -5, 50, 50, -5, -50, 50, -5}, ball[4] = {0, 0, -5, 0.5f};
  const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  uint32_t solid, sphere, surface, made;
  sightline_occluder* occluder;
  EXPECT(sightline_world_add_solids(world, wall, 1, NULL, 0, &solid) == SIGHTLINE_OK);
  EXPECT(sightline_world_add_solids(world, NULL, 0, ball, 1, &sphere) == SIGHTLINE_OK);
  EXPECT(sightline_world_add_surface(world, quad, 4, indices, 6, NULL, 0, &surface) == SIGHTLINE_OK);
  EXPECT(sightline_occluder_create(quad, 4, indices, 6, NULL, 0, 64, 8, &occluder) == SIGHTLINE_OK);
  EXPECT(sightline_world_add_occluder(world, occluder, &made) == SIGHTLINE_OK);
  sightline_occluder_destroy(occluder);
  const uint32_t names[4] = {solid, surface, made, sphere};
  for (int i = 0; i < 4; ++i) {
    hide_by(world, &first, names[i]);
    EXPECT(i < 3 ? left(culler, world) == 1 : left(culler, world) < all);
  }
  hide_by(world, &first, solid);
  uint8_t on = 0;
  EXPECT(sightline_world_set_occluding(world, &first, &on, 1) == SIGHTLINE_OK);
  EXPECT(left(culler, world) == all);
  hide_by(world, &first, SIGHTLINE_NO_OCCLUDER);
  EXPECT(sightline_world_remove_occluder(world, solid) == SIGHTLINE_OK);
  EXPECT(sightline_world_remove_occluder(world, solid) == SIGHTLINE_BAD_ARGUMENT);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
}

static void refusals(void) {
  sightline_handles first;
  sightline_world* world = walled_world(&first);
  sightline_culler* culler = sightline_culler_create();
  const float corners[9] = {0};
  uint32_t name;
  uint8_t on = 2;
  sightline_occluder_placement placement = sightline_occluder_placement_of(7, NULL);
  EXPECT(sightline_world_add_solids(NULL, wall, 1, NULL, 0, &name) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_add_solids(world, wall, 1, NULL, 0, NULL) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_add_solids(world, NULL, 1, NULL, 0, &name) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_add_occluder(world, NULL, &name) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_add_surface(world, corners, 3, NULL, 3, NULL, 0, &name) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_add_surface(world, corners, 3, ids, 3, NULL, 0, NULL) == SIGHTLINE_BAD_ARGUMENT);
  /* Refused by its counts, before what they claim is copied. */
  const sightline_status many = sizeof(size_t) > 4 ? SIGHTLINE_TOO_MANY : SIGHTLINE_BAD_ARGUMENT;
  EXPECT(sightline_world_add_surface(world, corners, 0xffffffffu, ids, 3, NULL, 0, &name) == many);
  EXPECT_REFUSED(sightline_world_add_surface(world, corners, 3, ids, 3, &on, (size_t)-1 / 4, &name),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(sightline_world_set_occluders(world, &first, &placement, 1) == SIGHTLINE_BAD_ARGUMENT);
  placement = sightline_occluder_placement_of(SIGHTLINE_NO_OCCLUDER, NULL), placement.reserved = 1;
  EXPECT_REFUSED(sightline_world_set_occluders(world, &first, &placement, 1), SIGHTLINE_BAD_ARGUMENT, 0);
  EXPECT(sightline_world_set_occluders(world, &first, NULL, 1) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_set_occluding(world, &first, &on, 1) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_set_triangles(world, handles[0], corners, 2, NULL, SIGHTLINE_BOTH_SIDES) ==
         SIGHTLINE_BAD_MESH);
  EXPECT(sightline_world_set_triangles(world, handles[0], corners, 3, NULL, SIGHTLINE_FRONT_SIDE) ==
         SIGHTLINE_OK);
  EXPECT(sightline_world_set_triangles(world, handles[0], corners, 3, NULL, 2) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_world_set_triangles(world, handles[0], NULL, 0, NULL, SIGHTLINE_BOTH_SIDES) ==
         SIGHTLINE_OK);
  EXPECT(sightline_report_frame_time(culler, -1) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_report_frame_time(culler, NAN) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_report_frame_time(NULL, 1) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_report_frame_time(culler, 1e6) == SIGHTLINE_OK);
  sightline_cull_options options = sightline_cull_options_default();
  options.occlusion = 2;
  EXPECT(sightline_cull_capacity(world, &options) == 0);
  options.occlusion = SIGHTLINE_OCCLUSION_AUTOMATIC, options.costs.reserved = 1;
  EXPECT(sightline_cull_capacity(world, &options) == 0);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
}

void test_automatic(void) {
  what_hides();
  refusals();
}
