/* Ranges of an order: a thousand random worlds held against each object tested by itself, while objects come
 * and go, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kMost = 160 };

static sightline_box boxes[kMost];
static sightline_handle handles[kMost];
static uint32_t buffer[4 * kMost], state = 5;

static double between(double low, double high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * (double)(state >> 8) / 16777216.0;
}

static void move_boxes(int first, int end) {
  for (int i = first; i < end; ++i) {
    for (int a = 0; a < 3; ++a)
      boxes[i].min[a] = between(-30, 30), boxes[i].max[a] = boxes[i].min[a] + between(0, 5);
  }
}

/* How far a box reaches into a view along -z of 1 rad, 4 : 3, from 1 to 100 m; below 0 where it does not. */
static double depth_in(const double eye[3], const sightline_box* box) {
  const double up = tan(0.5), across = up * 64 / 48, slants[2] = {across, up};
  const double nearest = eye[2] - box->min[2], farthest = eye[2] - box->max[2];
  double depth = fmin(nearest - 1, 100 - farthest);
  for (int a = 0; a < 2; ++a) {
    const double length = sqrt(1 + slants[a] * slants[a]);
    depth = fmin(depth, (nearest * slants[a] - (box->min[a] - eye[a])) / length);
    depth = fmin(depth, (nearest * slants[a] + (box->max[a] - eye[a])) / length);
  }
  return depth;
}

static void follow(sightline_order* order, sightline_world* world) {
  sightline_order_report report;
  EXPECT(sightline_order_update(order, world, &report) == SIGHTLINE_OK);
  for (size_t i = 0; i < report.count; ++i) buffer[report.changes[i].slot] = report.changes[i].object;
  EXPECT(sightline_order_slot_limit(order) <= 4 * kMost);
  EXPECT(memcmp(buffer, sightline_order_objects(order), sightline_order_slot_limit(order) * sizeof *buffer) ==
         0);
}

static size_t try_ranges(sightline_range_culler* culler, sightline_order* order) {
  sightline_world* world = sightline_world_create();
  const int first = kMost / 2;
  size_t seen = 0;
  move_boxes(0, kMost);
  memset(buffer, 0xff, sizeof buffer);
  for (int round = 0; round < 2; ++round) {
    const int from = round == 0 ? 0 : first;
    const sightline_box_view some = sightline_boxes_of(boxes + from, (size_t)(kMost / 2));
    const sightline_handles theirs =
        sightline_handles_of(handles + from, sizeof *handles, (size_t)(kMost / 2));
    EXPECT(sightline_world_insert(world, &some, &theirs, NULL) == SIGHTLINE_OK);
    follow(order, world);
    sightline_camera camera = sightline_camera_default();
    sightline_view view;
    for (int a = 0; a < 3; ++a) camera.eye[a] = between(-20, 20);
    camera.vertical_fov = 1, camera.near_plane = 1, camera.far_plane = 100;
    EXPECT(sightline_camera_view(&camera, 64, 48, &view) == SIGHTLINE_OK);
    const sightline_cull_view culled = sightline_cull_view_of(&view);
    sightline_range_options options = sightline_range_options_default();
    sightline_range_result result;
    options.masks = 1;
    EXPECT(sightline_cull_ranges(culler, world, order, &culled, 1, &options, &result) == SIGHTLINE_OK);
    uint8_t found[kMost] = {0};
    for (size_t r = 0; r < result.count; ++r) {
      EXPECT(result.masks[r] == 1);
      for (uint32_t i = 0; i < result.ranges[r].count; ++i, ++seen)
        ++found[buffer[result.ranges[r].first + i]];
    }
    for (int i = 0; i < from + first; ++i) {
      const double depth = depth_in(camera.eye, &boxes[i]);
      EXPECT(buffer[sightline_order_slot(order, world, handles[i])] == handles[i].index);
      EXPECT(depth < 0.01 || found[handles[i].index] == 1);
      EXPECT(depth > -0.01 || found[handles[i].index] == 0);
    }
    options.whole_chunks = 1, options.masks = 0;
    const uint64_t objects = result.objects;
    EXPECT(sightline_cull_ranges(culler, world, order, &culled, 1, &options, &result) == SIGHTLINE_OK);
    EXPECT(result.objects >= objects && result.tested == 0 && result.masks == NULL);
  }
  const sightline_handles gone = sightline_handles_of(handles, sizeof *handles, (size_t)first);
  EXPECT(sightline_world_remove(world, &gone) == SIGHTLINE_OK);
  follow(order, world);
  EXPECT(sightline_order_slot(order, world, handles[0]) == SIGHTLINE_NO_SLOT);
  sightline_world_destroy(world);
  return seen;
}

static void refuse_ranges(sightline_range_culler* culler, sightline_order* order) {
  sightline_world* world = sightline_world_create();
  sightline_order_report report;
  sightline_range_result result;
  sightline_range_options options = sightline_range_options_default();
  const sightline_view ahead = view_ahead();
  sightline_cull_view view = sightline_cull_view_of(&ahead);
  EXPECT_REFUSED(sightline_order_update(order, NULL, &report), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_order_renumber(NULL, world, &report), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_cull_ranges(culler, world, order, &view, 1, NULL, &result), SIGHTLINE_STALE_BUFFER,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_order_renumber(order, world, &report) == SIGHTLINE_OK);
  EXPECT(sightline_cull_ranges(culler, world, order, &view, 1, NULL, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 0);
  EXPECT_REFUSED(sightline_cull_ranges(culler, world, order, &view, 1, NULL, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_cull_ranges(culler, world, order, &view, TOO_MUCH, NULL, &result),
                 SIGHTLINE_BAD_ARGUMENT, TOO_MUCH);
  options.whole_chunks = 2;
  EXPECT_REFUSED(sightline_cull_ranges(culler, world, order, &view, 1, &options, &result),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  options.whole_chunks = 0, options.struct_size = 4;
  EXPECT_REFUSED(sightline_cull_ranges(culler, world, order, &view, 1, &options, &result),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(sightline_order_slot_limit(NULL) == 0 && sightline_order_objects(NULL) == NULL);
  sightline_world_destroy(world);
}

void test_ranges(void) {
  sightline_range_culler* culler = sightline_range_culler_create();
  sightline_order* order = sightline_order_create();
  size_t seen = 0;
  for (int round = 0; round < 500; ++round) seen += try_ranges(culler, order);
  EXPECT(seen > 10000);
  refuse_ranges(culler, order);
  sightline_order_destroy(order);
  sightline_range_culler_destroy(culler);
}
