/* Culling: views, masks, layers, values, threads, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kCount = 1000, kRoom = kCount + 64 * 64 };

static uint32_t ids[kRoom];
static uint8_t masks[kRoom];
static sightline_box boxes[kCount];
static sightline_handle handles[kCount];

static void run_here(void* user, uint32_t count, void (*job)(void*, uint32_t), void* data) {
  *(uint32_t*)user += count;
  for (uint32_t i = count; i-- > 0;) job(data, i);
}

static void begin_zone(void* user, const char* name) {
  EXPECT(strncmp(name, "sightline: ", 11) == 0);
  ++((int*)user)[0];
}
static void end_zone(void* user) {
  ++((int*)user)[1];
}

static void tell_zones(sightline_culler* culler, const sightline_world* world) {
  sightline_cull_options options = sightline_cull_options_default();
  sightline_cull_result result;
  int calls[2] = {0, 0};
  options.zones.begin = begin_zone, options.zones.end = end_zone, options.zones.user = calls;
  EXPECT(cull_ahead(culler, world, &options, ids, kRoom, &result) == SIGHTLINE_OK);
  EXPECT(calls[0] == 3 && calls[1] == 3);
  options.zones.end = NULL;
  EXPECT_REFUSED(cull_ahead(culler, world, &options, ids, kRoom, &result), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT(calls[0] == 3);
}

static sightline_world* filled_world(void) {
  static uint32_t layers[kCount], values[kCount];
  sightline_world* world = sightline_world_create();
  row_of_boxes(boxes, kCount);
  for (uint32_t i = 0; i < kCount; ++i) layers[i] = i < 10 ? 2 : 1, values[i] = 5000 + i;
  const sightline_box_view view = sightline_boxes_of(boxes, kCount);
  const sightline_handles to = sightline_handles_of(handles, sizeof *handles, kCount);
  sightline_object_columns columns = sightline_object_columns_default();
  columns.layers = sightline_column_of(layers, sizeof *layers, kCount);
  columns.values = sightline_column_of(values, sizeof *values, kCount);
  EXPECT(sightline_world_insert(world, &view, &to, &columns) == SIGHTLINE_OK);
  return world;
}

static void cull_views(sightline_culler* culler, const sightline_world* world) {
  sightline_camera back = sightline_camera_default();
  sightline_view ahead = view_ahead(), behind;
  back.forward[2] = 1;
  EXPECT(sightline_camera_view(&back, 64, 48, &behind) == SIGHTLINE_OK);
  sightline_cull_view views[3];
  views[0] = sightline_cull_view_of(&behind);
  views[1] = views[2] = sightline_cull_view_of(&ahead);
  views[2].layers = 2;
  const sightline_cull_output output = sightline_cull_output_of(ids, masks, kRoom);
  sightline_cull_result result;
  EXPECT(sightline_cull(culler, world, views, 3, NULL, &output, &result) == SIGHTLINE_OK);
  EXPECT(result.count > 900 && result.tested <= 3 * kCount && result.nodes_visited > 0);
  EXPECT(result.culled_occlusion == 0 && result.cost == 0 && result.reserved[0] == 0 &&
         result.reserved[1] == 0);
  const size_t all = result.count;
  size_t few = 0;
  for (size_t i = 0; i < all; ++i) {
    EXPECT(masks[i] == (ids[i] < 10 ? 6 : 2));
    few += masks[i] == 6;
  }
  EXPECT(few == 10);
  EXPECT(sightline_cull(culler, world, views, 1, NULL, &output, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 0);
  views[1].min_area = 100;
  EXPECT(sightline_cull(culler, world, &views[1], 1, NULL, &output, &result) == SIGHTLINE_OK);
  EXPECT(result.count > 0 && result.count < all);

  /* Values for ids; the order is the same for any number of jobs. */
  uint32_t jobs = 0;
  sightline_cull_options options = sightline_cull_options_default();
  options.values_for_ids = 1;
  options.jobs.run = run_here, options.jobs.user = &jobs, options.jobs.threads = 4;
  EXPECT(sightline_cull_capacity(world, &options) > sightline_cull_capacity(world, NULL));
  static uint32_t first[kRoom];
  views[1].min_area = 0;
  EXPECT(sightline_cull(culler, world, &views[1], 1, NULL, &output, &result) == SIGHTLINE_OK);
  memcpy(first, ids, result.count * sizeof *ids);
  EXPECT(sightline_cull(culler, world, &views[1], 1, &options, &output, &result) == SIGHTLINE_OK);
  EXPECT(jobs > 0 && result.count == all);
  for (size_t i = 0; i < all; ++i) EXPECT(ids[i] == 5000 + first[i]);
}

static void cull_with_occlusion(sightline_culler* culler, const sightline_world* world) {
  const sightline_view ahead = view_ahead();
  sightline_cull_view view = sightline_cull_view_of(&ahead);
  const sightline_cull_output output = sightline_cull_output_of(ids, NULL, kRoom);
  sightline_cull_result result;
  sightline_occlusion* occlusion = sightline_occlusion_create();
  view.occlusion = occlusion;
  EXPECT_REFUSED(sightline_cull(culler, world, &view, 1, NULL, &output, &result), SIGHTLINE_STALE_BUFFER, 0);
  EXPECT(sightline_occlusion_begin(occlusion, &ahead) == SIGHTLINE_OK);
  const sightline_box_view nearest = sightline_boxes_of(boxes, 1);
  EXPECT(sightline_occlusion_draw_boxes(occlusion, &nearest) == SIGHTLINE_OK);
  EXPECT(sightline_cull(culler, world, &view, 1, NULL, &output, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 1 && ids[0] == handles[0].index && result.culled_occlusion > 900);

  /* Of another view, or of last frame's. */
  sightline_cull_view views[2];
  views[0] = sightline_cull_view_of(&ahead), views[1] = view;
  views[1].view.origin[0] = 0.5;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &result), SIGHTLINE_STALE_BUFFER, 1);
  sightline_occlusion_destroy(occlusion);
}

/* Each is one wrong thing in a right call. */
static void refuse_calls(sightline_culler* culler, const sightline_world* world) {
  const sightline_view ahead = view_ahead();
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  sightline_cull_view views[9];
  for (int v = 0; v < 9; ++v) views[v] = sightline_cull_view_of(&ahead);
  sightline_cull_output output = sightline_cull_output_of(ids, masks, kRoom);
  sightline_cull_result r;
  EXPECT_REFUSED(sightline_cull(NULL, world, views, 1, NULL, &output, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, NULL, views, 1, NULL, &output, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, NULL, 1, NULL, &output, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, NULL, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, NULL), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 0, NULL, &output, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 9, NULL, &output, &r), bad, none);
  EXPECT_REFUSED(sightline_cull(culler, world, views, TOO_MUCH, NULL, &output, &r), bad, none);

  views[1].struct_size -= 8;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &r), bad, 1);
  views[1] = views[0], views[1].reserved = 1;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &r), bad, 1);
  views[1] = views[0], views[1].min_area = NAN;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &r), bad, 1);
  views[1] = views[0], views[1].view.eye_to_clip[5] = NAN;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &r), SIGHTLINE_BAD_VIEW, 1);
  views[1] = sightline_cull_view_of(NULL);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 2, NULL, &output, &r), SIGHTLINE_BAD_VIEW, 1);
  views[0].struct_size -= 4;  // ends inside a pointer
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, 0);
  views[0].struct_size = 0;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, 0);
  views[0] = sightline_cull_view_of(&ahead);

  const sightline_status small = SIGHTLINE_BUFFER_TOO_SMALL;
  output.capacity = sightline_cull_capacity(world, NULL) - 1;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), small, none);
  output.capacity = TOO_MUCH;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, none);
  output = sightline_cull_output_of(NULL, masks, kRoom);
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, none);
  output = sightline_cull_output_of(ids, masks, kRoom), output.struct_size = 12;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, none);
  output = sightline_cull_output_of(ids, masks, kRoom), output.reserved = 12;
  EXPECT_REFUSED(sightline_cull(culler, world, views, 1, NULL, &output, &r), bad, none);
}

static void refuse_options(sightline_culler* culler, const sightline_world* world) {
  sightline_cull_options wrong[6];
  for (int i = 0; i < 6; ++i) wrong[i] = sightline_cull_options_default();
  wrong[0].struct_size = 0, wrong[1].struct_size += 1;
  wrong[2].values_for_ids = 2, wrong[3].jobs.threads = 65, wrong[4].jobs.reserved = 1;
  wrong[5].coverage = SIGHTLINE_COVERAGE_AREA + 1;
  for (int i = 0; i < 6; ++i) {
    sightline_cull_result r;
    EXPECT_REFUSED(cull_ahead(culler, world, &wrong[i], ids, kRoom, &r), SIGHTLINE_BAD_ARGUMENT,
                   SIGHTLINE_NO_INDEX);
    EXPECT(sightline_cull_capacity(world, &wrong[i]) == 0);
  }
  EXPECT(sightline_cull_capacity(NULL, NULL) == 0);
}

void test_cull(void) {
  sightline_world* world = filled_world();
  sightline_culler* culler = sightline_culler_create();
  cull_views(culler, world);
  cull_with_occlusion(culler, world);
  tell_zones(culler, world);
  refuse_calls(culler, world);
  refuse_options(culler, world);
  sightline_culler_destroy(culler);
  sightline_culler_destroy(NULL);
  sightline_world_destroy(world);
}
