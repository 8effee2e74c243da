/* Occlusion: drawing and asking in every way, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kPixels = 64 * 48 };

/* A wall 5 m ahead that fills the image, two triangles and in C order. */
static const float kWall[4][3] = {{-9, -9, -5}, {9, -9, -5}, {9, 9, -5}, {-9, 9, -5}};
static const uint32_t kIndices[6] = {0, 1, 2, 0, 2, 3};
/* Two triangles, before the wall and behind it. */
static const float kNear[9] = {-1, -1, -3, 1, -1, -3, 0, 1, -3};
static const float kFar[9] = {-1, -1, -7, 1, -1, -7, 0, 1, -7};

static sightline_occluder_mesh* wall(void) {
  sightline_occluder_mesh* mesh = NULL;
  EXPECT(sightline_occluder_mesh_create(kWall[0], 4, kIndices, 6, NULL, 0, &mesh) == SIGHTLINE_OK);
  EXPECT(sightline_occluder_mesh_triangles(mesh) == 2);
  return mesh;
}

/* The wall is an occluder of its own; nothing can be made of a mesh of none. */
static void make_occluders(void) {
  sightline_occluder* occluder = NULL;
  sightline_occluder_parts parts = sightline_occluder_parts_default();
  EXPECT(sightline_occluder_create(kWall[0], 4, kIndices, 6, NULL, 0, 64, 8, &occluder) == SIGHTLINE_OK);
  EXPECT(sightline_occluder_contents(occluder, &parts) == SIGHTLINE_OK);
  EXPECT(parts.yield == SIGHTLINE_OCCLUDES_WHOLE && parts.index_count == 6 && parts.position_count == 4);
  EXPECT(parts.solid_triangles == 0 && parts.box_count == 0 && parts.sides[1] == SIGHTLINE_BOTH_SIDES);
  EXPECT(parts.positions[3 * parts.indices[0] + 2] == -5);
  parts.struct_size = 3;
  EXPECT(sightline_occluder_contents(occluder, &parts) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_occluder_contents(NULL, &parts) == SIGHTLINE_BAD_ARGUMENT);
  sightline_occluder_destroy(occluder);
  sightline_occluder_destroy(NULL);

  EXPECT(sightline_occluder_create(NULL, 0, NULL, 0, NULL, 0, 64, 8, &occluder) == SIGHTLINE_OK);
  parts = sightline_occluder_parts_default();
  EXPECT(sightline_occluder_contents(occluder, &parts) == SIGHTLINE_OK);
  EXPECT(parts.yield == SIGHTLINE_OCCLUDES_EMPTY && parts.index_count == 0);
  sightline_occluder_destroy(occluder);

  EXPECT(sightline_occluder_create(kWall[0], 4, kIndices, 6, NULL, 0, 64, 8, NULL) == SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_occluder_create(NULL, 4, kIndices, 6, NULL, 0, 64, 8, &occluder) ==
         SIGHTLINE_BAD_ARGUMENT);
  EXPECT(sightline_occluder_create(kWall[0], 3, kIndices, 6, NULL, 0, 64, 8, &occluder) ==
         SIGHTLINE_BAD_MESH);
  EXPECT(sightline_occluder_create(kWall[0], 4, kIndices, 6, NULL, 0, 5000, 8, &occluder) ==
         SIGHTLINE_BAD_ARGUMENT);
}

/* Seen from its front the wall hides what is behind it, from behind only where both sides are drawn. */
static void draw_sides(sightline_occlusion* occlusion, const sightline_view* view) {
  const uint32_t turned[6] = {2, 1, 0, 3, 2, 0};
  const uint8_t front = SIGHTLINE_FRONT_SIDE, both[2] = {SIGHTLINE_BOTH_SIDES, SIGHTLINE_BOTH_SIDES};
  for (int way = 0; way < 3; ++way) {
    sightline_occluder_mesh* mesh = NULL;
    int seen = 9;
    EXPECT(sightline_occluder_mesh_create(kWall[0], 4, way ? turned : kIndices, 6, way < 2 ? &front : both,
                                          way < 2 ? 1 : 2, &mesh) == SIGHTLINE_OK);
    EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
    EXPECT(sightline_occlusion_draw_mesh(occlusion, mesh, NULL) == SIGHTLINE_OK);
    EXPECT(sightline_occlusion_may_see_triangles(occlusion, kFar, 3, &seen) == SIGHTLINE_OK);
    EXPECT(seen == (way == 1));
    sightline_occluder_mesh_destroy(mesh);
  }
}

static void draw_and_ask(sightline_occlusion* occlusion, const sightline_view* view) {
  uint8_t visible[2] = {9, 9};
  int seen = 9;
  const float spheres[2][4] = {{0, 0, -3, 0.5f}, {0, 0, -7, 0.5f}};
  sightline_box boxes[2];
  row_of_boxes(boxes, 2);
  boxes[1].min[2] = -7.5, boxes[1].max[2] = -6.5;
  boxes[0].min[2] = -3.5, boxes[0].max[2] = -2.5;
  const sightline_box_view box_view = sightline_boxes_of(boxes, 2);
  const sightline_sphere_view sphere_view = sightline_spheres_of(spheres[0], &spheres[0][3], 16, 2);
  sightline_occluder_mesh* mesh = wall();
  const float aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1000, 0, 0, 1};
  for (int moved = 0; moved < 2; ++moved) {
    const uint8_t behind = (uint8_t)moved;
    EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
    EXPECT(sightline_occlusion_draw_mesh(occlusion, mesh, moved ? aside : NULL) == SIGHTLINE_OK);
    EXPECT(sightline_occlusion_may_see_boxes(occlusion, &box_view, visible, 2) == SIGHTLINE_OK);
    EXPECT(visible[0] == 1 && visible[1] == behind);
    EXPECT(sightline_occlusion_may_see_spheres(occlusion, &sphere_view, visible, 2) == SIGHTLINE_OK);
    EXPECT(visible[0] == 1 && visible[1] == behind);
    EXPECT(sightline_occlusion_may_see_triangles(occlusion, kNear, 3, &seen) == SIGHTLINE_OK && seen == 1);
    EXPECT(sightline_occlusion_may_see_triangles(occlusion, kFar, 3, &seen) == SIGHTLINE_OK);
    EXPECT(seen == behind);
  }
  sightline_occluder_mesh_destroy(mesh);

  /* Solid boxes and spheres hide what is behind them, too. */
  const sightline_box_view one = sightline_boxes_of(boxes, 1);
  const sightline_sphere_view hidden = sightline_spheres_of(spheres[1], &spheres[1][3], 16, 1);
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_draw_boxes(occlusion, &one) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &hidden, visible, 1) == SIGHTLINE_OK);
  EXPECT(visible[0] == 0);
  for (uint32_t coverage = SIGHTLINE_COVERAGE_CENTRES; coverage <= SIGHTLINE_COVERAGE_AREA; ++coverage) {
    for (uint32_t scale = 1; scale <= 4; scale *= 2) {
      EXPECT(sightline_occlusion_begin_with(occlusion, view, coverage, scale) == SIGHTLINE_OK);
      EXPECT(sightline_occlusion_draw_boxes(occlusion, &one) == SIGHTLINE_OK);
      EXPECT(sightline_occlusion_may_see_spheres(occlusion, &hidden, visible, 1) == SIGHTLINE_OK);
      EXPECT(visible[0] == 0);
    }
  }
  const float ball[4][1] = {{0}, {0}, {-3}, {1}};
  const sightline_sphere_view arrays = sightline_spheres_arrays(ball[0], ball[1], ball[2], ball[3], 1);
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_draw_spheres(occlusion, &arrays) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &hidden, visible, 1) == SIGHTLINE_OK);
  EXPECT(visible[0] == 0);

  /* The same where the numbers of a sphere do not lie side by side: a solid one, and one behind it. */
  const float apart[2][6] = {{0, 90, 0, 90, -3, 1}, {0, 90, 0, 90, -7, 0.5f}};
  sightline_sphere_view spread[2];
  for (int i = 0; i < 2; ++i) {
    spread[i] = sightline_spheres_of(apart[i], &apart[i][5], sizeof apart[i], 1);
    spread[i].data[1] = &apart[i][2], spread[i].data[2] = &apart[i][4];
  }
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &spread[1], visible, 1) == SIGHTLINE_OK);
  EXPECT(visible[0] == 1);
  EXPECT(sightline_occlusion_draw_spheres(occlusion, &spread[0]) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &hidden, visible, 1) == SIGHTLINE_OK);
  EXPECT(visible[0] == 0);
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &spread[1], visible, 1) == SIGHTLINE_OK);
  EXPECT(visible[0] == 0);
}

static void ask_for_objects(sightline_occlusion* occlusion, const sightline_view* view) {
  float corners[2][9];
  const uint32_t counts[3] = {1, 0, 1};
  uint32_t objects[4] = {2, 1, 7, 0};
  size_t kept = 0;
  memcpy(corners[0], kNear, sizeof kNear), memcpy(corners[1], kFar, sizeof kFar);
  sightline_occludees* occludees = sightline_occludees_create();
  EXPECT(sightline_occludees_assign(occludees, corners[0], 6, counts, 3) == SIGHTLINE_OK);
  EXPECT(sightline_occludees_objects(occludees) == 3 && sightline_occludees_triangles(occludees, 2) == 1);
  EXPECT(sightline_occludees_triangles(occludees, 3) == 0);
  sightline_occluder_mesh* mesh = wall();
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_draw_mesh(occlusion, mesh, NULL) == SIGHTLINE_OK);
  sightline_occluder_mesh_destroy(mesh);
  EXPECT(sightline_occlusion_keep_seen(occlusion, occludees, objects, 4, &kept) == SIGHTLINE_OK);
  EXPECT(kept == 2 && objects[0] == 7 && objects[1] == 0);
  EXPECT(sightline_occludees_set(occludees, 2, kNear, 3) == SIGHTLINE_OK);
  objects[0] = 2;
  EXPECT(sightline_occlusion_keep_seen(occlusion, occludees, objects, 1, &kept) == SIGHTLINE_OK);
  EXPECT(kept == 1);

  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  EXPECT_REFUSED(sightline_occludees_assign(occludees, corners[0], 5, counts, 3), SIGHTLINE_BAD_MESH, none);
  EXPECT_REFUSED(sightline_occludees_assign(occludees, NULL, 6, counts, 3), bad, none);
  EXPECT_REFUSED(sightline_occludees_assign(occludees, corners[0], 6, NULL, 3), bad, none);
  EXPECT_REFUSED(sightline_occludees_assign(occludees, corners[0], TOO_MUCH, counts, 3), bad, none);
  EXPECT_REFUSED(sightline_occludees_assign(occludees, corners[0], 6, counts, TOO_MUCH), bad, none);
  EXPECT_REFUSED(sightline_occludees_assign(NULL, corners[0], 6, counts, 3), bad, none);
  EXPECT_REFUSED(sightline_occludees_set(occludees, 2, kNear, 2), SIGHTLINE_BAD_MESH, none);
  EXPECT_REFUSED(sightline_occludees_set(occludees, 2, NULL, 3), bad, none);
  EXPECT_REFUSED(sightline_occludees_set(NULL, 2, kNear, 3), bad, none);
  EXPECT(sightline_occludees_set(occludees, 3, kNear, 3) == bad);
  EXPECT_REFUSED(sightline_occlusion_keep_seen(NULL, occludees, objects, 1, &kept), bad, none);
  EXPECT_REFUSED(sightline_occlusion_keep_seen(occlusion, NULL, objects, 1, &kept), bad, none);
  EXPECT_REFUSED(sightline_occlusion_keep_seen(occlusion, occludees, NULL, 1, &kept), bad, none);
  EXPECT_REFUSED(sightline_occlusion_keep_seen(occlusion, occludees, objects, TOO_MUCH, &kept), bad, none);
  EXPECT_REFUSED(sightline_occlusion_keep_seen(occlusion, occludees, objects, 1, NULL), bad, none);
  EXPECT(sightline_occludees_objects(NULL) == 0 && sightline_occludees_triangles(NULL, 0) == 0);
  sightline_occludees_destroy(occludees);
  sightline_occludees_destroy(NULL);
}

static void read_pixels(sightline_occlusion* occlusion, const sightline_view* view) {
  static float pixels[kPixels];
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_read_nearness(occlusion, pixels, kPixels) == SIGHTLINE_OK);
  EXPECT(isinf(pixels[0]) && pixels[0] < 0);
  sightline_occluder_mesh* mesh = wall();
  EXPECT(sightline_occlusion_draw_mesh(occlusion, mesh, NULL) == SIGHTLINE_OK);
  sightline_occluder_mesh_destroy(mesh);
  EXPECT(sightline_occlusion_read_nearness(occlusion, pixels, kPixels) == SIGHTLINE_OK);
  for (int i = 0; i < kPixels; ++i) EXPECT(fabsf(pixels[i] - 0.2f) < 1e-3f);

  const size_t none = SIGHTLINE_NO_INDEX;
  EXPECT_REFUSED(sightline_occlusion_read_nearness(occlusion, pixels, kPixels - 1),
                 SIGHTLINE_BUFFER_TOO_SMALL, none);
  EXPECT_REFUSED(sightline_occlusion_read_nearness(occlusion, pixels, TOO_MUCH), SIGHTLINE_BAD_ARGUMENT,
                 none);
  EXPECT_REFUSED(sightline_occlusion_read_nearness(occlusion, NULL, kPixels), SIGHTLINE_BAD_ARGUMENT, none);
  EXPECT_REFUSED(sightline_occlusion_read_nearness(NULL, pixels, kPixels), SIGHTLINE_BAD_ARGUMENT, none);
}

static void before_begin(const sightline_view* view) {
  sightline_occlusion* occlusion = sightline_occlusion_create();
  const sightline_status stale = SIGHTLINE_STALE_BUFFER;
  const size_t none = SIGHTLINE_NO_INDEX;
  const float sphere[4] = {0, 0, -7, 0.5f};
  float pixel;
  uint8_t visible = 9;
  int seen = 9;
  sightline_box box;
  row_of_boxes(&box, 1);
  const sightline_box_view boxes = sightline_boxes_of(&box, 1);
  const sightline_sphere_view spheres = sightline_spheres_of(sphere, &sphere[3], 16, 1);
  sightline_occluder_mesh* mesh = wall();
  sightline_view begun;
  EXPECT_REFUSED(sightline_occlusion_view(occlusion, &begun), stale, none);
  EXPECT_REFUSED(sightline_occlusion_draw_boxes(occlusion, &boxes), stale, none);
  EXPECT_REFUSED(sightline_occlusion_draw_spheres(occlusion, &spheres), stale, none);
  EXPECT_REFUSED(sightline_occlusion_draw_mesh(occlusion, mesh, NULL), stale, none);
  EXPECT_REFUSED(sightline_occlusion_read_nearness(occlusion, &pixel, 1), stale, none);
  EXPECT(sightline_occlusion_may_see_boxes(occlusion, &boxes, &visible, 1) == SIGHTLINE_OK && visible == 1);
  visible = 9;
  EXPECT(sightline_occlusion_may_see_spheres(occlusion, &spheres, &visible, 1) == SIGHTLINE_OK);
  EXPECT(visible == 1);
  EXPECT(sightline_occlusion_may_see_triangles(occlusion, kFar, 3, &seen) == SIGHTLINE_OK && seen == 1);

  sightline_view wrong = *view;
  wrong.width = 8193;
  EXPECT_REFUSED(sightline_occlusion_begin(occlusion, &wrong), SIGHTLINE_BAD_VIEW, none);
  wrong = *view, wrong.world_to_eye[3] = 1;
  EXPECT_REFUSED(sightline_occlusion_begin(occlusion, &wrong), SIGHTLINE_BAD_VIEW, none);
  EXPECT_REFUSED(sightline_occlusion_view(occlusion, &begun), stale, none);
  EXPECT(sightline_occlusion_begin(occlusion, view) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_view(occlusion, &begun) == SIGHTLINE_OK);
  EXPECT(memcmp(&begun, view, sizeof begun) == 0);
  sightline_occluder_mesh_destroy(mesh);
  sightline_occlusion_destroy(occlusion);
}

static void refuse_meshes(sightline_occlusion* occlusion) {
  sightline_occluder_mesh* mesh = NULL;
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT, bad_mesh = SIGHTLINE_BAD_MESH;
  const size_t none = SIGHTLINE_NO_INDEX;
  float positions[4][3];
  uint32_t indices[6];
  uint8_t sides[3] = {SIGHTLINE_FRONT_SIDE, SIGHTLINE_BOTH_SIDES, 0};
  memcpy(positions, kWall, sizeof kWall), memcpy(indices, kIndices, sizeof kIndices);
  EXPECT_REFUSED(sightline_occluder_mesh_create(NULL, 4, indices, 6, NULL, 0, &mesh), bad, none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, NULL, 6, NULL, 0, &mesh), bad, none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, NULL, 0, NULL), bad, none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], TOO_MUCH, indices, 6, NULL, 0, &mesh), bad,
                 none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, TOO_MUCH, NULL, 0, &mesh), bad,
                 none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, NULL, 2, &mesh), bad, none);
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, sides, 3, &mesh), bad_mesh, 3);
  sides[1] = 2;
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, sides, 2, &mesh), bad, 1);
  EXPECT(sightline_occluder_mesh_create(positions[0], 4, indices, 5, NULL, 0, &mesh) == bad_mesh);
  indices[4] = 4;
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, NULL, 0, &mesh), bad_mesh, 4);
  indices[4] = 2, positions[3][1] = INFINITY;
  EXPECT_REFUSED(sightline_occluder_mesh_create(positions[0], 4, indices, 6, NULL, 0, &mesh), bad_mesh, 3);
  EXPECT(mesh == NULL && sightline_occluder_mesh_triangles(NULL) == 0);
  sightline_occluder_mesh_destroy(NULL);

  mesh = wall();
  float transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_REFUSED(sightline_occlusion_draw_mesh(occlusion, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_occlusion_draw_mesh(NULL, mesh, NULL), bad, none);
  transform[15] = 2;
  EXPECT_REFUSED(sightline_occlusion_draw_mesh(occlusion, mesh, transform), bad, none);
  transform[15] = 1, transform[12] = NAN;
  EXPECT_REFUSED(sightline_occlusion_draw_mesh(occlusion, mesh, transform), bad, none);
  sightline_occluder_mesh_destroy(mesh);
}

static void refuse_things(sightline_occlusion* occlusion, const sightline_view* view) {
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT, small = SIGHTLINE_BUFFER_TOO_SMALL;
  const size_t none = SIGHTLINE_NO_INDEX;
  const float four[16] = {0};
  uint8_t visible[4];
  int seen;
  const sightline_box_view boxes[4] = {sightline_boxes_of(NULL, 4),
                                       sightline_boxes_centre_half_float(four, four, 11, 4),
                                       sightline_boxes_of_form(9, four, four, 16, 4),
                                       sightline_boxes_centre_half_float(four, four, 12, TOO_MUCH)};
  sightline_sphere_view spheres[4] = {
      sightline_spheres_of(NULL, four, 16, 4), sightline_spheres_of(four, four, 11, 4),
      sightline_spheres_of(four, four, 16, TOO_MUCH), sightline_spheres_arrays(four, four, four, NULL, 4)};
  for (int i = 0; i < 4; ++i) {
    EXPECT_REFUSED(sightline_occlusion_draw_boxes(occlusion, &boxes[i]), bad, none);
    EXPECT_REFUSED(sightline_occlusion_may_see_boxes(occlusion, &boxes[i], visible, 4), bad, none);
    EXPECT_REFUSED(sightline_occlusion_draw_spheres(occlusion, &spheres[i]), bad, none);
    EXPECT_REFUSED(sightline_occlusion_may_see_spheres(occlusion, &spheres[i], visible, 4), bad, none);
  }
  spheres[0] = sightline_spheres_of(four, four, 12, 1), spheres[0].arrays = 2;
  EXPECT_REFUSED(sightline_occlusion_draw_spheres(occlusion, &spheres[0]), bad, none);
  spheres[0].arrays = 0, ++spheres[0].struct_size;
  EXPECT_REFUSED(sightline_occlusion_draw_spheres(occlusion, &spheres[0]), bad, none);

  const sightline_box_view right = sightline_boxes_centre_half_float(four, four, 12, 1);
  const sightline_sphere_view ball = sightline_spheres_of(four, four, 12, 1);
  EXPECT_REFUSED(sightline_occlusion_may_see_boxes(occlusion, &right, visible, 0), small, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_boxes(occlusion, &right, NULL, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_boxes(occlusion, NULL, visible, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_boxes(NULL, &right, visible, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_spheres(occlusion, &ball, visible, 0), small, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_spheres(occlusion, &ball, visible, TOO_MUCH), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_spheres(occlusion, NULL, visible, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_spheres(NULL, &ball, visible, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_triangles(occlusion, NULL, 3, &seen), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_triangles(occlusion, kFar, TOO_MUCH, &seen), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_triangles(occlusion, kFar, 3, NULL), bad, none);
  EXPECT_REFUSED(sightline_occlusion_may_see_triangles(NULL, kFar, 3, &seen), bad, none);
  EXPECT_REFUSED(sightline_occlusion_draw_boxes(NULL, &right), bad, none);
  EXPECT_REFUSED(sightline_occlusion_draw_boxes(occlusion, NULL), bad, none);
  EXPECT_REFUSED(sightline_occlusion_draw_spheres(NULL, &ball), bad, none);
  EXPECT_REFUSED(sightline_occlusion_draw_spheres(occlusion, NULL), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin(NULL, view), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin_with(NULL, view, SIGHTLINE_COVERAGE_AREA, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin_with(occlusion, NULL, SIGHTLINE_COVERAGE_AREA, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin_with(occlusion, view, 2, 1), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin_with(occlusion, view, SIGHTLINE_COVERAGE_AREA, 3), bad, none);
  EXPECT_REFUSED(sightline_occlusion_begin(occlusion, NULL), bad, none);
  EXPECT_REFUSED(sightline_occlusion_view(occlusion, NULL), bad, none);
}

void test_occlusion(void) {
  const sightline_view view = view_ahead();
  sightline_occlusion* occlusion = sightline_occlusion_create();
  before_begin(&view);
  draw_and_ask(occlusion, &view);
  make_occluders();
  draw_sides(occlusion, &view);
  ask_for_objects(occlusion, &view);
  read_pixels(occlusion, &view);
  refuse_meshes(occlusion);
  refuse_things(occlusion, &view);
  sightline_occlusion_destroy(occlusion);
  sightline_occlusion_destroy(NULL);
}
