/* Versions, refusals, cameras. */
#include "expect.h"

#include <math.h>

void test_status(void) {
  char version[32];
  snprintf(version, sizeof version, "%d.%d.%d", SIGHTLINE_VERSION_MAJOR, SIGHTLINE_VERSION_MINOR,
           SIGHTLINE_VERSION_PATCH);
  EXPECT(strcmp(sightline_version(), version) == 0);

  sightline_error failure;
  sightline_last_failure(&failure);
  EXPECT(failure.status == SIGHTLINE_OK && failure.index == SIGHTLINE_NO_INDEX);
  EXPECT(strcmp(failure.message, "") == 0 && strcmp(sightline_last_error(), "") == 0);
  sightline_last_failure(NULL);

  /* A success leaves the last refusal as it is. */
  EXPECT_REFUSED(sightline_view_check(NULL), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  const sightline_view view = view_ahead();
  EXPECT(sightline_view_check(&view) == SIGHTLINE_OK);
  expect_failure(SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX, __LINE__);
}

static void refuse_camera(const sightline_camera* camera, uint32_t width, sightline_status code) {
  sightline_view view;
  memset(&view, 7, sizeof view);
  EXPECT_REFUSED(sightline_camera_view(camera, width, 48, &view), code, SIGHTLINE_NO_INDEX);
  for (size_t i = 0; i < sizeof view; ++i) EXPECT(((const unsigned char*)&view)[i] == 7);
}

static void refuse_cameras(void) {
  sightline_camera c = sightline_camera_default();
  refuse_camera(NULL, 64, SIGHTLINE_BAD_ARGUMENT);
  EXPECT_REFUSED(sightline_camera_view(&c, 64, 48, NULL), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  refuse_camera(&c, 0, SIGHTLINE_BAD_VIEW);
  refuse_camera(&c, 16385, SIGHTLINE_BAD_VIEW);
  c.vertical_fov = 4, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.eye[1] = NAN, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.eye[2] = 1e12, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.origin[0] = INFINITY, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.up[1] = 0, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.far_plane = 0, refuse_camera(&c, 64, SIGHTLINE_BAD_VIEW);
  c = sightline_camera_default(), c.reversed_depth = 2, refuse_camera(&c, 64, SIGHTLINE_BAD_ARGUMENT);
  c = sightline_camera_default(), --c.struct_size, refuse_camera(&c, 64, SIGHTLINE_BAD_ARGUMENT);
  c = sightline_camera_default(), ++c.struct_size, refuse_camera(&c, 64, SIGHTLINE_BAD_ARGUMENT);
  c.struct_size = 0, refuse_camera(&c, 64, SIGHTLINE_BAD_ARGUMENT);
  c.struct_size = 0xffffffffu, refuse_camera(&c, 64, SIGHTLINE_BAD_ARGUMENT);
}

void test_views(void) {
  refuse_cameras();

  /* Far out the matrices are about the origin, and as precise as near it. */
  sightline_camera c = sightline_camera_default();
  sightline_view near_view, far_view;
  c.eye[0] = 0.25, c.far_plane = INFINITY, c.reversed_depth = 1, c.shift[0] = 0.5f;
  EXPECT(sightline_camera_view(&c, 64, 48, &near_view) == SIGHTLINE_OK);
  c.eye[0] += 1e7, c.origin[0] = 1e7;
  EXPECT(sightline_camera_view(&c, 64, 48, &far_view) == SIGHTLINE_OK);
  EXPECT(memcmp(near_view.world_to_eye, far_view.world_to_eye, sizeof near_view.world_to_eye) == 0);
  EXPECT(far_view.origin[0] == 1e7 && far_view.width == 64 && far_view.height == 48);

  EXPECT(sightline_view_check(&far_view) == SIGHTLINE_OK);
  far_view.origin[2] = NAN;
  EXPECT_REFUSED(sightline_view_check(&far_view), SIGHTLINE_BAD_VIEW, SIGHTLINE_NO_INDEX);
  near_view.eye_to_clip[0] = 0;
  EXPECT_REFUSED(sightline_view_check(&near_view), SIGHTLINE_BAD_VIEW, SIGHTLINE_NO_INDEX);

  c = sightline_camera_default();
  c.orthographic_height = 20;
  EXPECT(sightline_camera_view(&c, 64, 48, &near_view) == SIGHTLINE_OK);
  EXPECT(near_view.eye_to_clip[11] == 0 && near_view.eye_to_clip[15] == 1);
}
