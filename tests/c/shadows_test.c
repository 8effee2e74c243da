/* Who throws shadows in a thousand random worlds, held against segments from lit points to the light. */
#include "expect.h"

#include <math.h>

enum { kMost = 120, kRoom = kMost + 64 };

static sightline_box boxes[kMost];
static sightline_handle handles[kMost];
static uint32_t ids[kRoom], state = 7;
static uint8_t all[kMost], left[kMost];

static double between(double low, double high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * (double)(state >> 8) / 16777216.0;
}

static void cull_into(const sightline_world* world, const sightline_cull_view* view, uint8_t* seen) {
  sightline_culler* culler = sightline_culler_create();
  const sightline_cull_output output = sightline_cull_output_of(ids, NULL, kRoom);
  sightline_cull_result result;
  EXPECT(sightline_cull(culler, world, view, 1, NULL, &output, &result) == SIGHTLINE_OK);
  memset(seen, 0, kMost);
  for (size_t i = 0; i < result.count; ++i) seen[ids[i]] = 1;
  sightline_culler_destroy(culler);
}

/* Whether the segment from `from` along `by` meets the box. */
static int meets(const sightline_box* box, const double* from, const double* by) {
  double first = 0, last = 1;
  for (int a = 0; a < 3; ++a) {
    const double s = (box->min[a] - from[a]) / by[a], t = (box->max[a] - from[a]) / by[a];
    first = fmax(first, fmin(s, t)), last = fmin(last, fmax(s, t));
  }
  return first <= last;
}

/* x, y and z of clip space over w. */
static int in_view(const sightline_view* view, const double* p) {
  double eye[3], clip[4];
  for (int r = 0; r < 3; ++r) {
    eye[r] = (double)view->world_to_eye[12 + r];
    for (int c = 0; c < 3; ++c) eye[r] += (double)view->world_to_eye[4 * c + r] * (p[c] - view->origin[c]);
  }
  for (int r = 0; r < 4; ++r) {
    clip[r] = (double)view->eye_to_clip[12 + r];
    for (int c = 0; c < 3; ++c) clip[r] += (double)view->eye_to_clip[4 * c + r] * eye[c];
  }
  return fabs(clip[0]) <= clip[3] && fabs(clip[1]) <= clip[3] && clip[2] >= 0 && clip[2] <= clip[3];
}

static size_t try_world(uint32_t seed) {
  sightline_world* world = sightline_world_create();
  sightline_shadow_casters* casters = sightline_shadow_casters_create();
  for (int i = 0; i < kMost; ++i) {
    for (int a = 0; a < 3; ++a)
      boxes[i].min[a] = between(-60, 60), boxes[i].max[a] = boxes[i].min[a] + between(0, 12);
  }
  const sightline_box_view view_of_boxes = sightline_boxes_of(boxes, kMost);
  const sightline_handles all_handles = sightline_handles_of(handles, sizeof *handles, kMost);
  EXPECT(sightline_world_insert(world, &view_of_boxes, &all_handles, NULL) == SIGHTLINE_OK);
  sightline_camera eye = sightline_camera_default();
  sightline_view camera, shadow;
  for (int a = 0; a < 3; ++a) eye.eye[a] = between(-20, 20), eye.forward[a] = (float)between(-1, 1);
  eye.forward[2] = -1, eye.far_plane = 80;
  EXPECT(sightline_camera_view(&eye, 64, 48, &camera) == SIGHTLINE_OK);
  sightline_light light = sightline_light_default();
  light.kind = seed % 3;
  for (int a = 0; a < 3; ++a)
    light.direction[a] = (float)between(-1, 1), light.position[a] = between(-40, 40);
  const uint32_t face = light.kind == SIGHTLINE_LIGHT_POINT ? seed % 6 : 0;
  EXPECT(sightline_shadow_view(&light, &camera, NULL, 512, face, &shadow) == SIGHTLINE_OK);
  EXPECT(sightline_shadow_casters_begin(casters, &shadow, &camera, NULL, 1, 0) == SIGHTLINE_OK);
  sightline_cull_view view = sightline_cull_view_of(&shadow);
  cull_into(world, &view, all);
  view.casters = casters;
  cull_into(world, &view, left);
  size_t casting = 0;
  for (int i = 0; i < 150; ++i) {
    double p[3], by[3];
    for (int a = 0; a < 3; ++a) {
      p[a] = between(-60, 60);
      by[a] = light.kind == SIGHTLINE_LIGHT_DIRECTIONAL ? -300.0 * (double)light.direction[a]
                                                        : light.position[a] - p[a];
    }
    if (!in_view(&camera, p) || !in_view(&shadow, p)) continue;
    for (uint32_t o = 0; o < kMost; ++o) {
      const uint32_t id = handles[o].index;
      if (!all[id] || !meets(&boxes[o], p, by)) continue;
      EXPECT(left[id]);
      ++casting;
    }
  }
  for (uint32_t i = 0; i < kMost; ++i) EXPECT(left[i] <= all[i]);
  /* Nothing is lit: nothing casts. */
  EXPECT(sightline_shadow_casters_receive(casters, world, NULL, 0, NULL) == SIGHTLINE_OK);
  cull_into(world, &view, left);
  for (uint32_t i = 0; i < kMost && light.kind == SIGHTLINE_LIGHT_DIRECTIONAL; ++i) EXPECT(!left[i]);
  sightline_shadow_casters_destroy(casters);
  sightline_world_destroy(world);
  return casting;
}

static void refuse_shadows(void) {
  const sightline_view camera = view_ahead();
  sightline_light light = sightline_light_default();
  sightline_depth_range none = {5, 5};
  sightline_cascade cascades[3];
  sightline_view shadow;
  int casts = 0;
  sightline_shadow_casters* casters = sightline_shadow_casters_create();
  const sightline_box box = {{0, 0, 0}, {1, 1, 1}};
  EXPECT(sightline_split_cascades(&light, &camera, NULL, 0.5f, 512, cascades, 3) == SIGHTLINE_OK);
  EXPECT(cascades[0].depths.far_plane == cascades[1].depths.near_plane);
  EXPECT_REFUSED(sightline_split_cascades(&light, &camera, NULL, 0.5f, 512, cascades, 0),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_split_cascades(&light, &camera, NULL, 0.5f, 512, cascades, 17),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_split_cascades(&light, &camera, NULL, 0.5f, 512, NULL, TOO_MUCH),
                 SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_shadow_view(&light, &camera, &none, 512, 0, &shadow), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_shadow_view(&light, NULL, NULL, 512, 0, &shadow), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  light.kind = 3;
  EXPECT_REFUSED(sightline_shadow_view(&light, &camera, NULL, 512, 0, &shadow), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_shadow_casters_begin(casters, &camera, NULL, NULL, 1, 0), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_shadow_casters_receive(casters, NULL, NULL, 0, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_shadow_casters_may_cast(casters, &box, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_shadow_casters_may_cast(casters, &box, &casts) == SIGHTLINE_OK && casts == 1);
  sightline_shadow_casters_destroy(casters);
  sightline_shadow_casters_destroy(NULL);
}

void test_shadows(void) {
  size_t casting = 0;
  for (uint32_t seed = 0; seed < 1000; ++seed) casting += try_world(seed);
  EXPECT(casting > 1000);
  refuse_shadows();
}
