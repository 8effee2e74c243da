/* The C API: cc main.c $(pkg-config --cflags --libs sightline) -o culled */
#include <sightline/sightline.h>

#include <stdio.h>
#include <stdlib.h>

int main(void) {
  enum { kCount = 1000 };
  static sightline_box boxes[kCount];
  static sightline_handle handles[kCount];
  for (int i = 0; i < kCount; ++i) {
    const double x = i % 100 * 4.0 - 200, z = i / 100 * -4.0 - 5;
    boxes[i] = (sightline_box){{x - 1, 0, z - 1}, {x + 1, 2, z + 1}};
  }
  sightline_world* world = sightline_world_create();
  sightline_culler* culler = sightline_culler_create();
  const double eye[3] = {0, 1.7, 0};
  const float ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  sightline_view view;
  if (sightline_world_insert(world, boxes, kCount, handles) != SIGHTLINE_OK ||
      sightline_view_perspective(eye, ahead, up, 1.0f, 0.1f, 1280, 720, &view) != SIGHTLINE_OK) {
    fprintf(stderr, "%s\n", sightline_last_error());
    return 2;
  }
  const size_t capacity = sightline_cull_capacity(world, NULL);
  uint32_t* ids = malloc(capacity * sizeof *ids);
  sightline_cull_result result;
  if (sightline_cull(culler, world, &view, 1, NULL, ids, NULL, capacity, &result) != SIGHTLINE_OK) {
    fprintf(stderr, "%s\n", sightline_last_error());
    return 2;
  }
  printf("draw %zu of %zu boxes\n", result.count, sightline_world_size(world));
  free(ids);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
  return 0;
}
