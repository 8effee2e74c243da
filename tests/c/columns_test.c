/* Layers and distances of a thousand random worlds, held against a loop over all objects. */
#include "expect.h"

#include <math.h>

enum { kMost = 200, kRoom = kMost + 64 };

typedef struct thing {
  float centre[3], half[3];
  sightline_handle handle;
  uint32_t layers;
  sightline_distance_range range;
} thing;

static thing things[kMost];
static uint32_t ids[kRoom], state = 1;
static uint8_t masks[kRoom], seen[kMost], got[kMost];

static float between(float low, float high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * (float)(state >> 8) / 16777216.0f;
}
static uint32_t below(uint32_t count) {
  return (uint32_t)between(0, (float)count);
}

static void columns_of_all(size_t count) {
  for (size_t i = 0; i < count; ++i) {
    thing* t = &things[i];
    t->layers = below(16);
    t->range.min = below(2) ? between(0, 60) : 0;
    t->range.max = below(5) ? t->range.min + between(0, 200) : HUGE_VALF;
  }
}

/* Which views see each of the world's objects. */
static void cull_into(const sightline_world* world, sightline_culler* culler,
                      const sightline_cull_view* views, uint8_t* by_id) {
  const sightline_cull_output output = sightline_cull_output_of(ids, masks, kRoom);
  sightline_cull_result result;
  EXPECT(sightline_cull(culler, world, views, 2, NULL, &output, &result) == SIGHTLINE_OK);
  memset(by_id, 0, kMost);
  for (size_t i = 0; i < result.count; ++i) by_id[ids[i]] = masks[i];
}

/* 1, 0, or -1 where nobody can know. */
static int sees(const sightline_world* world, const thing* t, const sightline_cull_view* view,
                const double* eye) {
  sightline_box box;
  double square = 0;
  EXPECT(sightline_world_box(world, t->handle, &box) == SIGHTLINE_OK);
  for (int a = 0; a < 3; ++a) {
    const double along = 0.5 * (box.min[a] + box.max[a]) - eye[a];
    square += along * along;
  }
  const double d = sqrt(square), min = (double)t->range.min * (double)view->distance_scale,
               max = (double)t->range.max * (double)view->distance_scale;
  if ((t->layers & view->layers) == 0) return 0;
  if ((min > 0 && fabs(d - min) < 1e-3) || fabs(d - max) < 1e-3) return -1;
  return d >= min && d < max;
}

static size_t try_world(uint32_t seed) {
  const size_t count = 1 + below(kMost - 1);
  sightline_world *world = sightline_world_create(), *plain = sightline_world_create();
  sightline_culler* culler = sightline_culler_create();
  for (size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) things[i].centre[a] = between(-100, 100), things[i].half[a] = between(0, 3);
  }
  const sightline_box_view boxes =
      sightline_boxes_centre_half_float(things[0].centre, things[0].half, sizeof(thing), count);
  const sightline_handles handles = sightline_handles_of(&things[0].handle, sizeof(thing), count);
  const sightline_column layers = sightline_column_of(&things[0].layers, sizeof(thing), count);
  const sightline_distances distances = sightline_distances_of(&things[0].range, sizeof(thing), count);
  sightline_object_columns columns = sightline_object_columns_default();
  columns_of_all(count);
  columns.layers = layers, columns.distances = distances;
  EXPECT(sightline_world_insert(plain, &boxes, &handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_world_insert(world, &boxes, &handles, &columns) == SIGHTLINE_OK);
  if (seed % 2) {
    columns_of_all(count);
    EXPECT(sightline_world_set_layers(world, &handles, &layers) == SIGHTLINE_OK);
    EXPECT(sightline_world_set_distances(world, &handles, &distances) == SIGHTLINE_OK);
  }

  sightline_camera cameras[2];
  sightline_cull_view views[2], without[2];
  for (int v = 0; v < 2; ++v) {
    sightline_view view;
    cameras[v] = sightline_camera_default();
    for (int a = 0; a < 3; ++a)
      cameras[v].eye[a] = (double)between(-60, 60), cameras[v].forward[a] = between(-1, 1);
    cameras[v].forward[2] = -1;
    EXPECT(sightline_camera_view(&cameras[v], 64, 48, &view) == SIGHTLINE_OK);
    views[v] = without[v] = sightline_cull_view_of(&view);
    views[v].layers = below(16), views[v].distance_scale = between(0.5f, 2);
  }
  views[1].distance_view = seed % 3 ? SIGHTLINE_OWN_VIEW : 0;
  cull_into(plain, culler, without, seen);
  cull_into(world, culler, views, got);
  size_t kept = 0;
  for (size_t i = 0; i < count; ++i) {
    for (int v = 0; v < 2; ++v) {
      const double* eye = cameras[views[v].distance_view == 0 ? 0 : v].eye;
      const int could = seen[things[i].handle.index] >> v & 1,
                expected = could ? sees(world, &things[i], &views[v], eye) : 0;
      const int has = got[things[i].handle.index] >> v & 1;
      EXPECT(expected < 0 || has == expected);
      kept += (size_t)has;
    }
  }
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
  sightline_world_destroy(plain);
  return kept;
}

static void refuse_distances(void) {
  sightline_world* world = sightline_world_create();
  const sightline_box_view boxes =
      sightline_boxes_centre_half_float(things[0].centre, things[0].half, sizeof(thing), 2);
  const sightline_handles handles = sightline_handles_of(&things[0].handle, sizeof(thing), 2);
  sightline_distances distances = sightline_distances_of(&things[0].range, sizeof(thing), 2);
  sightline_distance_range range;
  EXPECT(sightline_world_insert(world, &boxes, &handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_world_distances(world, things[0].handle, &range) == SIGHTLINE_OK);
  EXPECT(range.min == 0 && isinf(range.max));
  things[0].range.min = things[0].range.max = 1;
  things[1].range.min = 2, things[1].range.max = 1;
  EXPECT_REFUSED(sightline_world_set_distances(world, &handles, &distances), SIGHTLINE_BAD_ARGUMENT, 1);
  distances.count = 1;
  EXPECT_REFUSED(sightline_world_set_distances(world, &handles, &distances), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_set_distances(world, NULL, &distances), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_distances(world, things[0].handle, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  sightline_world_destroy(world);
}

/* Each object's level by its size in pixels, of a thousand worlds. */
static void try_levels(uint32_t seed) {
  const size_t count = 1 + below(kMost - 1);
  sightline_world* world = sightline_world_create();
  sightline_culler* culler = sightline_culler_create();
  for (size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a)
      things[i].centre[a] = between(-100, 100), things[i].half[a] = between(0.5f, 3);
    things[i].layers = below(2);
  }
  const sightline_box_view boxes =
      sightline_boxes_centre_half_float(things[0].centre, things[0].half, sizeof(thing), count);
  const sightline_handles handles = sightline_handles_of(&things[0].handle, sizeof(thing), count);
  const sightline_column tables = sightline_column_of(&things[0].layers, sizeof(thing), count);
  const float sizes[3] = {between(20, 30), between(10, 15), between(2, 8)};
  uint32_t table = 0;
  EXPECT(sightline_world_insert(world, &boxes, &handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_world_add_levels(world, sizes, 3, &table) == SIGHTLINE_OK && table == 1);
  EXPECT(sightline_world_set_levels(world, &handles, &tables) == SIGHTLINE_OK);
  sightline_camera camera = sightline_camera_default();
  sightline_view view;
  for (int a = 0; a < 3; ++a) camera.eye[a] = (double)between(-60, 60);
  EXPECT(sightline_camera_view(&camera, 640, 480, &view) == SIGHTLINE_OK);
  const sightline_cull_view of = sightline_cull_view_of(&view);
  static uint8_t levels[kRoom], fades[kRoom];
  sightline_cull_output output = sightline_cull_output_of(ids, NULL, kRoom);
  output.levels = levels, output.fades = fades;
  sightline_cull_options options = sightline_cull_options_default();
  options.levels.fade = seed % 2 ? 0.5f : 0;
  sightline_cull_result result;
  EXPECT(sightline_cull(culler, world, &of, 1, &options, &output, &result) == SIGHTLINE_OK);
  for (size_t i = 0; i < result.count; ++i) {
    const sightline_handle handle = sightline_world_handle(world, ids[i]);
    sightline_box box;
    double distance = 0, radius = 0;
    int expected = 0, unsure = 0;
    EXPECT(sightline_world_box(world, handle, &box) == SIGHTLINE_OK);
    for (int a = 0; a < 3; ++a) {
      distance += pow(0.5 * (box.min[a] + box.max[a]) - camera.eye[a], 2);
      radius += pow(0.5 * (box.max[a] - box.min[a]), 2);
    }
    EXPECT(sightline_world_levels(world, handle, &table) == SIGHTLINE_OK);
    const double size = 480 * (double)view.eye_to_clip[5] * sqrt(radius / distance);
    for (int k = 0; k < 3 && table == 1 && distance > radius; ++k) {
      expected += size < (double)sizes[k];
      unsure += fabs(size - (double)sizes[k]) < 1e-3 * size;
    }
    EXPECT(unsure || levels[i] == expected);
    EXPECT(options.levels.fade > 0 || fades[i] == 0);
  }
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
}

static void refuse_levels(void) {
  sightline_world* world = sightline_world_create();
  const float sizes[2] = {1, 2};
  uint32_t name;
  EXPECT_REFUSED(sightline_world_add_levels(world, sizes, 2, &name), SIGHTLINE_BAD_ARGUMENT, 1);
  EXPECT_REFUSED(sightline_world_add_levels(world, sizes, 0, &name), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_add_levels(world, NULL, 2, &name), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_set_levels(world, NULL, NULL), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  sightline_world_destroy(world);
}

void test_columns(void) {
  size_t kept = 0;
  for (uint32_t seed = 0; seed < 1000; ++seed) kept += try_world(seed);
  EXPECT(kept > 1000);
  refuse_distances();
  for (uint32_t seed = 0; seed < 1000; ++seed) try_levels(seed);
  refuse_levels();
}
