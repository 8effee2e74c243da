/* The C API in C: layouts, a frame, and every kind of refusal. */
#include <sightline/sightline.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Callers in other languages write these layouts down. */
_Static_assert(sizeof(sightline_box) == 48, "box");
_Static_assert(sizeof(sightline_handle) == 8, "handle");
_Static_assert(sizeof(sightline_view) == 160, "view");
_Static_assert(offsetof(sightline_view, origin) == 136, "view origin");
#if UINTPTR_MAX > 0xffffffffu
_Static_assert(sizeof(sightline_cull_options) == 32, "options");
#endif
_Static_assert(sizeof(sightline_cull_result) == 32, "result");

#define EXPECT(condition)                                                                          \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      fprintf(stderr, "%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, sightline_last_error()); \
      exit(1);                                                                                     \
    }                                                                                              \
  } while (0)

enum { kCount = 1000 };

static void run_here(void* user, uint32_t count, void (*job)(void*, uint32_t), void* data) {
  *(int*)user += (int)count;
  for (uint32_t i = 0; i < count; ++i) job(data, i);
}

int main(void) {
  EXPECT(strcmp(sightline_version(), "0.1.0") == 0);
  EXPECT(strcmp(sightline_last_error(), "") == 0);

  sightline_world* world = sightline_world_create();
  static sightline_box boxes[kCount];
  static sightline_handle handles[kCount];
  for (int i = 0; i < kCount; ++i) {
    /* A row that leads away from the eye, ten million metres from the origin. */
    const double z = -5.0 - 2.0 * i;
    boxes[i] = (sightline_box){{1e7 - 0.5, -0.5, z - 0.5}, {1e7 + 0.5, 0.5, z + 0.5}};
  }
  EXPECT(sightline_world_insert(world, boxes, kCount, handles) == SIGHTLINE_OK);
  EXPECT(sightline_world_size(world) == kCount);
  EXPECT(sightline_world_id_limit(world) == kCount);
  EXPECT(sightline_world_contains(world, handles[7]));
  sightline_box box;
  EXPECT(sightline_world_box(world, handles[7], &box) == SIGHTLINE_OK);
  EXPECT(box.min[0] == boxes[7].min[0] && box.max[2] == boxes[7].max[2]);

  const double eye[3] = {1e7, 0, 0};
  const float ahead[3] = {0, 0, -1}, back[3] = {0, 0, 1}, up[3] = {0, 1, 0};
  sightline_view views[2];
  EXPECT(sightline_view_perspective(eye, ahead, up, 1.0f, 0.1f, 1280, 720, &views[0]) == SIGHTLINE_OK);
  EXPECT(sightline_view_perspective(eye, back, up, 1.0f, 0.1f, 1280, 720, &views[1]) == SIGHTLINE_OK);

  sightline_culler* culler = sightline_culler_create();
  int jobs = 0;
  sightline_cull_options options = {0};
  options.threads = 4, options.run_jobs = run_here, options.user = &jobs;
  const size_t capacity = sightline_cull_capacity(world, &options);
  uint32_t* ids = malloc(capacity * sizeof *ids);
  uint8_t* masks = malloc(capacity);
  sightline_cull_result result;
  EXPECT(sightline_cull(culler, world, views, 2, &options, ids, masks, capacity, &result) == SIGHTLINE_OK);
  EXPECT(result.count == kCount && jobs > 0);
  for (size_t i = 0; i < result.count; ++i) EXPECT(masks[i] == 1);
  EXPECT(sightline_cull(culler, world, &views[1], 1, NULL, ids, NULL, capacity, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 0);

  /* The first box hides the rest. */
  sightline_occlusion* occlusion = sightline_occlusion_create();
  EXPECT(sightline_occlusion_draw_boxes(occlusion, boxes, 1) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_occlusion_begin(occlusion, &views[0]) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_draw_boxes(occlusion, boxes, 1) == SIGHTLINE_OK);
  const sightline_occlusion* one[1] = {occlusion};
  options.occlusion = one;
  EXPECT(sightline_cull(culler, world, views, 1, &options, ids, NULL, capacity, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 1 && ids[0] == handles[0].index && result.culled_occlusion == kCount - 1);

  /* The same by a mesh. */
  const float positions[12] = {-9, -9, -4, 9, -9, -4, 9, 9, -4, -9, 9, -4};
  const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  sightline_occluder_mesh* mesh = sightline_occluder_mesh_create(positions, 4, indices, 6);
  EXPECT(mesh != NULL);
  EXPECT(sightline_occlusion_begin(occlusion, &views[0]) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_draw_mesh(occlusion, mesh, identity) == SIGHTLINE_OK);
  EXPECT(sightline_cull(culler, world, views, 1, &options, ids, NULL, capacity, &result) == SIGHTLINE_OK);
  EXPECT(result.count == 0);

  /* Refusals. */
  EXPECT(sightline_cull(culler, world, views, 1, NULL, ids, NULL, 10, &result) == SIGHTLINE_BUFFER_TOO_SMALL);
  EXPECT(strstr(sightline_last_error(), "room for") != NULL);
  EXPECT(sightline_cull(culler, world, views, 0, NULL, ids, NULL, capacity, &result) ==
         SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_cull(culler, world, views, 9, NULL, ids, NULL, capacity, &result) ==
         SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_cull(NULL, world, views, 1, NULL, ids, NULL, capacity, &result) == SIGHTLINE_BAD_ARGUMENT);
  views[1].eye_to_clip[0] = NAN;
  EXPECT(sightline_cull(culler, world, views, 2, NULL, ids, NULL, capacity, &result) == SIGHTLINE_BAD_VIEW);
  EXPECT(sightline_view_perspective(eye, up, up, 1.0f, 0.1f, 1280, 720, &views[0]) == SIGHTLINE_BAD_VIEW);
  EXPECT(sightline_world_insert(NULL, boxes, 1, handles) == SIGHTLINE_BAD_ARGUMENT);
  sightline_box bad = {{1, 1, 1}, {0, 0, 0}};
  EXPECT(sightline_world_insert(world, &bad, 1, handles) == SIGHTLINE_BAD_BOX);
  EXPECT(sightline_world_move(world, handles, &bad, 1) == SIGHTLINE_BAD_BOX);
  EXPECT(sightline_world_remove(world, handles, kCount) == SIGHTLINE_OK);
  EXPECT(sightline_world_remove(world, handles, 1) == SIGHTLINE_STALE_HANDLE);
  EXPECT(sightline_world_move(world, handles, boxes, 1) == SIGHTLINE_STALE_HANDLE);
  EXPECT(sightline_world_box(world, handles[0], &box) == SIGHTLINE_STALE_HANDLE);
  EXPECT(!sightline_world_contains(world, handles[0]));
  EXPECT(sightline_world_size(world) == 0);

  sightline_occluder_mesh_destroy(mesh);
  sightline_occlusion_destroy(occlusion);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
  sightline_world_destroy(NULL);
  free(ids);
  free(masks);
  puts("the C API holds");
  return 0;
}
