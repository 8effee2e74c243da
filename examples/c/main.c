/* A hundred thousand moving objects in your own structs, in C:
 * cc main.c $(pkg-config --cflags --libs sightline) -o my_structs */
#include <sightline/sightline.h>

#include <stdio.h>
#include <stdlib.h>

typedef struct thing {
  char name[12];
  float position[3], half[3], speed[3];
  sightline_handle handle;
} thing;

enum { kCount = 100000 };

static void check(sightline_status status) {
  if (status == SIGHTLINE_OK) return;
  fprintf(stderr, "%s\n", sightline_last_error());
  exit(2);
}

int main(void) {
  thing* things = calloc(kCount, sizeof *things);
  if (!things) return 2;
  for (int i = 0; i < kCount; ++i) {
    thing* t = &things[i];
    t->position[0] = 5.0f * (float)(i % 400) - 1000, t->position[1] = 1;
    t->position[2] = -5.0f * (float)(i / 400), t->speed[2] = i % 2 ? 2.0f : -2.0f;
    t->half[0] = t->half[1] = t->half[2] = 1;
  }
  /* Boxes are read, and handles written, where they lie. */
  const sightline_box_view boxes =
      sightline_boxes_centre_half_float(things->position, things->half, sizeof *things, kCount);
  const sightline_handles handles = sightline_handles_of(&things->handle, sizeof *things, kCount);
  sightline_world* world = sightline_world_create();
  check(sightline_world_insert(world, &boxes, &handles, NULL));

  sightline_camera camera = sightline_camera_default();
  camera.eye[1] = 2, camera.eye[2] = 10;
  sightline_view view;
  check(sightline_camera_view(&camera, 1280, 720, &view));
  const sightline_cull_view seen = sightline_cull_view_of(&view);

  sightline_culler* culler = sightline_culler_create();
  const size_t capacity = sightline_cull_capacity(world, NULL);
  uint32_t* ids = malloc(capacity * sizeof *ids);
  const sightline_cull_output output = sightline_cull_output_of(ids, NULL, capacity);
  for (int frame = 0; frame < 3; ++frame) {
    for (int i = 0; i < kCount; ++i) things[i].position[2] += things[i].speed[2] / 60;
    check(sightline_world_move(world, &handles, &boxes));
    sightline_cull_result result;
    check(sightline_cull(culler, world, &seen, 1, NULL, &output, &result));
    printf("frame %d: draw %zu of %zu things\n", frame, result.count, sightline_world_size(world));
  }
  free(ids), free(things);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
  return 0;
}
