/* The C API in C: what it does, and every kind of refusal. */
#include "expect.h"

#include <ctype.h>

/* What C does not have: a call by a name of C++, a type or a constant of its. */
static int names_cpp(const char* s) {
  if (strstr(s, "()") || strstr(s, "::")) return 1;
  for (; s[0] && s[1] && s[2]; ++s)
    if (islower((unsigned char)s[0]) && isupper((unsigned char)s[1]) && islower((unsigned char)s[2]))
      return 1;
  return 0;
}

void expect_failure(sightline_status code, size_t index, int line) {
  sightline_error failure;
  sightline_last_failure(&failure);
  if (failure.status == code && failure.index == index && failure.message == sightline_last_error() &&
      failure.index == sightline_last_error_index() && strlen(failure.message) > 10 &&
      !names_cpp(failure.message))
    return;
  fprintf(stderr, "line %d: refused with status %d, index %zu, \"%s\"; expected status %d, index %zu\n", line,
          (int)failure.status, failure.index, failure.message, (int)code, index);
  exit(1);
}

sightline_view view_ahead(void) {
  sightline_camera camera = sightline_camera_default();
  sightline_view view;
  camera.vertical_fov = 1;
  EXPECT(sightline_camera_view(&camera, 64, 48, &view) == SIGHTLINE_OK);
  return view;
}

sightline_status cull_ahead(sightline_culler* culler, const sightline_world* world,
                            const sightline_cull_options* options, uint32_t* ids, size_t room,
                            sightline_cull_result* result) {
  const sightline_view ahead = view_ahead();
  const sightline_cull_view view = sightline_cull_view_of(&ahead);
  const sightline_cull_output output = sightline_cull_output_of(ids, NULL, room);
  return sightline_cull(culler, world, &view, 1, options, &output, result);
}

void row_of_boxes(sightline_box* boxes, int count) {
  for (int i = 0; i < count; ++i) {
    const double z = -5.0 - 2.0 * i;
    const sightline_box box = {{-0.5, -0.5, z - 0.5}, {0.5, 0.5, z + 0.5}};
    boxes[i] = box;
  }
}

int main(void) {
  test_status();
  test_views();
  test_world();
  test_cull();
  test_columns();
  test_shadows();
  test_instances();
  test_snapshots();
  test_ranges();
  test_inspect();
  test_automatic();
  test_occlusion();
  test_frustum();
  test_rays();
  test_pvs();
  puts("the C API holds");
  return 0;
}
