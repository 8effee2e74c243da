/* Instances of worlds: a thousand random ones held against each object tested by itself, and what is refused.
 */
#include "expect.h"

#include <math.h>

enum { kObjects = 40, kInstances = 6 };

static sightline_box boxes[kObjects];
static sightline_handle objects[kObjects], handles[kInstances];
static sightline_instance_placement placements[kInstances];
static uint32_t state = 11;

static double between(double low, double high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * (double)(state >> 8) / 16777216.0;
}

/* Turned about y and scaled, somewhere. */
static sightline_instance_placement place(uint32_t world) {
  sightline_instance_placement p = {0, {0}, 0, {0}};
  const double turn = between(0, 6.28), scale = between(0.5, 2);
  p.world = world;
  p.transform[0] = p.transform[10] = (float)(scale * cos(turn)), p.transform[5] = (float)scale;
  p.transform[2] = (float)(-scale * sin(turn)), p.transform[8] = (float)(scale * sin(turn));
  for (int a = 0; a < 3; ++a) p.transform[12 + a] = (float)between(-60, 60), p.origin[a] = between(-10, 10);
  p.transform[15] = 1;
  return p;
}

/* The least distance of the object's best corner over the view's planes, in the instance's own metres. */
static double depth_in(const sightline_view* view, const sightline_instance_placement* p,
                       const sightline_box* box) {
  double placed[16], eye[16], clip[16], least = 1e30;
  for (int i = 0; i < 16; ++i) placed[i] = (double)p->transform[i];
  for (int a = 0; a < 3; ++a) placed[12 + a] += p->origin[a] - view->origin[a];
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      eye[4 * c + r] = 0;
      for (int k = 0; k < 4; ++k) eye[4 * c + r] += (double)view->world_to_eye[4 * k + r] * placed[4 * c + k];
    }
    for (int r = 0; r < 4; ++r) {
      clip[4 * c + r] = 0;
      for (int k = 0; k < 4; ++k) clip[4 * c + r] += (double)view->eye_to_clip[4 * k + r] * eye[4 * c + k];
    }
  }
  for (int plane = 0; plane < 6; ++plane) {
    double n[4], length = 0, best;
    for (int c = 0; c < 4; ++c) {
      const double row = clip[4 * c + plane / 2], w = clip[4 * c + 3];
      n[c] = plane == 4 ? row : plane % 2 ? w - row : w + row;
    }
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    best = n[3];
    for (int a = 0; a < 3; ++a) best += n[a] * (n[a] >= 0 ? box->max[a] : box->min[a]);
    if (best / length < least) least = best / length;
  }
  return least;
}

static size_t try_instances(sightline_instance_culler* culler) {
  sightline_world* world = sightline_world_create();
  sightline_instances* instances = sightline_instances_create();
  uint32_t name = 7;
  size_t seen = 0;
  for (int i = 0; i < kObjects; ++i) {
    for (int a = 0; a < 3; ++a)
      boxes[i].min[a] = between(-20, 20), boxes[i].max[a] = boxes[i].min[a] + between(0, 5);
  }
  const sightline_box_view all = sightline_boxes_of(boxes, kObjects);
  const sightline_handles object_handles = sightline_handles_of(objects, sizeof *objects, kObjects);
  EXPECT(sightline_world_insert(world, &all, &object_handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_instances_add_world(instances, world, &name) == SIGHTLINE_OK && name == 0);
  for (int i = 0; i < kInstances; ++i) placements[i] = place(name);
  const sightline_placements given = sightline_placements_of(placements, sizeof *placements, kInstances);
  const sightline_handles instance_handles = sightline_handles_of(handles, sizeof *handles, kInstances);
  EXPECT(sightline_instances_insert(instances, &given, &instance_handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_instances_objects(instances) == kInstances * kObjects);
  sightline_camera camera = sightline_camera_default();
  sightline_view view;
  for (int a = 0; a < 3; ++a) camera.eye[a] = between(-30, 30), camera.forward[a] = (float)between(-1, 1);
  camera.forward[2] = -1, camera.far_plane = 150;
  EXPECT(sightline_camera_view(&camera, 64, 48, &view) == SIGHTLINE_OK);
  const sightline_cull_view culled = sightline_cull_view_of(&view);
  sightline_instance_options options = sightline_instance_options_default();
  sightline_instance_result result;
  options.masks = 1;
  EXPECT(sightline_cull_instances(culler, instances, &culled, 1, &options, &result) == SIGHTLINE_OK);
  uint8_t found[kInstances][kObjects] = {{0}};
  for (size_t r = 0; r < result.range_count; ++r) {
    const sightline_instance_range range = result.ranges[r];
    EXPECT(range.instance < kInstances && range.first + range.count <= result.id_count);
    for (uint32_t i = 0; i < range.count; ++i, ++seen) {
      EXPECT(result.masks[range.first + i] == 1);
      ++found[range.instance][result.ids[range.first + i]];
    }
  }
  EXPECT(seen == result.objects);
  for (int i = 0; i < kInstances; ++i) {
    for (int o = 0; o < kObjects; ++o) {
      const double depth = depth_in(&view, &placements[i], &boxes[o]);
      const uint8_t times = found[handles[i].index][objects[o].index];
      EXPECT(depth < 0 || times == 1);
      EXPECT(depth > -0.01 || times == 0);
    }
  }
  sightline_instances_destroy(instances);
  sightline_world_destroy(world);
  return seen;
}

static void refuse_instances(sightline_instance_culler* culler) {
  sightline_world* world = sightline_world_create();
  sightline_instances* instances = sightline_instances_create();
  const sightline_view ahead = view_ahead();
  sightline_cull_view view = sightline_cull_view_of(&ahead);
  sightline_instance_options options = sightline_instance_options_default();
  sightline_instance_result result;
  sightline_instance_placement placement;
  sightline_box box = {{-1, -1, -6}, {1, 1, -5}};
  uint32_t name = 9, layer = 2;
  const sightline_box_view all = sightline_boxes_of(&box, 1);
  const sightline_handles one = sightline_handles_of(handles, sizeof *handles, 1),
                          object = sightline_handles_of(objects, sizeof *objects, 1);
  const sightline_placements given = sightline_placements_of(placements, sizeof *placements, 1);
  const sightline_column layers = sightline_column_of(&layer, sizeof layer, 1);
  EXPECT_REFUSED(sightline_instances_add_world(instances, NULL, &name), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_instances_add_world(instances, world, &name) == SIGHTLINE_OK);
  memset(placements, 0, sizeof *placements);
  for (int i = 0; i < 4; ++i) placements[0].transform[5 * i] = 1;
  placements[0].world = 3;
  EXPECT_REFUSED(sightline_instances_insert(instances, &given, &one, NULL), SIGHTLINE_BAD_ARGUMENT, 0);
  placements[0].world = name, placements[0].transform[0] = 2;
  EXPECT_REFUSED(sightline_instances_insert(instances, &given, &one, NULL), SIGHTLINE_BAD_ARGUMENT, 0);
  placements[0].transform[0] = 1;
  EXPECT_REFUSED(sightline_instances_insert(instances, NULL, &one, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_instances_insert(instances, &given, &one, &layers) == SIGHTLINE_OK);
  EXPECT(sightline_instances_contains(instances, handles[0]) && sightline_instances_size(instances) == 1);
  EXPECT(sightline_instances_id_limit(instances) == 1);
  EXPECT(sightline_instances_handle(instances, 0).generation == handles[0].generation);
  EXPECT_REFUSED(sightline_instances_remove_world(instances, name), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_world_insert(world, &all, &object, NULL) == SIGHTLINE_OK);
  EXPECT_REFUSED(sightline_cull_instances(culler, instances, &view, 1, NULL, &result), SIGHTLINE_BAD_ARGUMENT,
                 name);
  EXPECT(sightline_instances_update(instances) == SIGHTLINE_OK);
  EXPECT(sightline_cull_instances(culler, instances, &view, 1, NULL, &result) == SIGHTLINE_OK);
  EXPECT(result.range_count == 1 && result.objects == 1 && result.ids[0] == objects[0].index &&
         !result.masks);
  EXPECT(sightline_instances_placement(instances, handles[0], &placement) == SIGHTLINE_OK);
  EXPECT(placement.world == name && placement.transform[5] == 1);
  EXPECT(sightline_instances_box(instances, handles[0], &box) == SIGHTLINE_OK && box.min[2] <= -6);
  view.layers = 1;
  EXPECT(sightline_cull_instances(culler, instances, &view, 1, NULL, &result) == SIGHTLINE_OK);
  EXPECT(result.range_count == 0);
  layer = 1;
  EXPECT(sightline_instances_set_layers(instances, &one, &layers) == SIGHTLINE_OK);
  options.levels = 1;
  EXPECT(sightline_cull_instances(culler, instances, &view, 1, &options, &result) == SIGHTLINE_OK);
  EXPECT(result.range_count == 1 && result.levels[0] == 0 && result.fades[0] == 0);
  options.levels = 2;
  EXPECT_REFUSED(sightline_cull_instances(culler, instances, &view, 1, &options, &result),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_cull_instances(culler, NULL, &view, 1, NULL, &result), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  placements[0].transform[12] = 100;
  EXPECT(sightline_instances_move(instances, &one, &given) == SIGHTLINE_OK);
  EXPECT(sightline_cull_instances(culler, instances, &view, 1, NULL, &result) == SIGHTLINE_OK);
  EXPECT(result.range_count == 0);
  EXPECT(sightline_instances_remove(instances, &one) == SIGHTLINE_OK);
  EXPECT_REFUSED(sightline_instances_remove(instances, &one), SIGHTLINE_STALE_HANDLE, 0);
  EXPECT_REFUSED(sightline_instances_box(instances, handles[0], &box), SIGHTLINE_STALE_HANDLE,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_instances_remove_world(instances, name) == SIGHTLINE_OK);
  sightline_instances_destroy(instances);
  sightline_instances_destroy(NULL);
  sightline_world_destroy(world);
}

void test_instances(void) {
  sightline_instance_culler* culler = sightline_instance_culler_create();
  size_t seen = 0;
  for (int i = 0; i < 1000; ++i) seen += try_instances(culler);
  EXPECT(seen > 10000);
  refuse_instances(culler);
  sightline_instance_culler_destroy(culler);
  sightline_instance_culler_destroy(NULL);
}
