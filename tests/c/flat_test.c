/* Frusta, projections, rays and visible sets: what they answer, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kCount = 100, kRoom = kCount + SIGHTLINE_CULL_PADDING };

static const float kExtent[6] = {-300, -300, -300, 300, 300, 300};
static sightline_box boxes[kCount];

static void cull_flat(const sightline_frustum* frustum) {
  const float spheres[2][4] = {{0, 0, -5, 1}, {0, 0, 5, 1}};
  uint32_t visible[kRoom];
  size_t count = 0;
  row_of_boxes(boxes, kCount);
  boxes[0].min[2] = 5, boxes[0].max[2] = 6;
  const sightline_box_view view = sightline_boxes_of(boxes, kCount);
  EXPECT(sightline_cull_boxes(frustum, &view, visible, kRoom, &count) == SIGHTLINE_OK);
  EXPECT(count == kCount - 1 && visible[0] == 1 && visible[98] == 99);
  const sightline_sphere_view two = sightline_spheres_of(spheres[0], &spheres[0][3], 16, 2);
  EXPECT(sightline_cull_spheres(frustum, &two, visible, kRoom, &count) == SIGHTLINE_OK);
  EXPECT(count == 1 && visible[0] == 0);

  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT, small = SIGHTLINE_BUFFER_TOO_SMALL;
  const size_t none = SIGHTLINE_NO_INDEX;
  EXPECT_REFUSED(sightline_cull_boxes(frustum, &view, visible, kRoom - 1, &count), small, none);
  EXPECT_REFUSED(sightline_cull_boxes(frustum, &view, visible, TOO_MUCH, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_boxes(frustum, &view, NULL, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_boxes(frustum, &view, visible, kRoom, NULL), bad, none);
  EXPECT_REFUSED(sightline_cull_boxes(frustum, NULL, visible, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_boxes(NULL, &view, visible, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, &two, visible, 65, &count), small, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, &two, visible, TOO_MUCH, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, &two, NULL, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, &two, visible, kRoom, NULL), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, NULL, visible, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(NULL, &two, visible, kRoom, &count), bad, none);
  const sightline_box_view wrong = sightline_boxes_of(NULL, 3);
  const sightline_sphere_view holes = sightline_spheres_of(spheres[0], NULL, 16, 2);
  EXPECT_REFUSED(sightline_cull_boxes(frustum, &wrong, visible, kRoom, &count), bad, none);
  EXPECT_REFUSED(sightline_cull_spheres(frustum, &holes, visible, kRoom, &count), bad, none);
}

/* Numbers of a sphere that do not lie side by side are each read where they lie. */
static void cull_spread_spheres(const sightline_frustum* frustum) {
  const struct {
    float x, before_y, y, before_z, z, radius;
  } spheres[2] = {{0, 90, 0, 90, 5, 1}, {0, 90, 0, 90, -5, 1}};
  uint32_t visible[kRoom];
  size_t count = 0;
  sightline_sphere_view view = sightline_spheres_of(&spheres[0].x, &spheres[0].radius, sizeof *spheres, 2);
  view.data[1] = &spheres[0].y, view.data[2] = &spheres[0].z;
  EXPECT(sightline_cull_spheres(frustum, &view, visible, kRoom, &count) == SIGHTLINE_OK);
  EXPECT(count == 1 && visible[0] == 1);

  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  sightline_sphere_view wrong[5];
  for (int i = 0; i < 5; ++i) wrong[i] = view;
  for (int i = 0; i < 3; ++i) wrong[i].data[i] = NULL;
  wrong[3].stride = 3, wrong[4].count = TOO_MUCH;
  for (int i = 0; i < 5; ++i)
    EXPECT_REFUSED(sightline_cull_spheres(frustum, &wrong[i], visible, kRoom, &count), bad,
                   SIGHTLINE_NO_INDEX);
}

/* Whatever is made of a view, or of an extent, refuses what is none. */
static void refuse_views(const sightline_view* view) {
  sightline_frustum frustum;
  sightline_projector* projector = NULL;
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  const float harm[3] = {NAN, INFINITY, 301};
  sightline_view wrong = *view;
  wrong.height = 0;
  EXPECT_REFUSED(sightline_frustum_make(&wrong, &frustum), SIGHTLINE_BAD_VIEW, none);
  EXPECT_REFUSED(sightline_projector_create(&wrong, kExtent, &projector), SIGHTLINE_BAD_VIEW, none);
  for (int i = 0; i < 3; ++i) {
    float extent[6];
    memcpy(extent, kExtent, sizeof extent);
    extent[i] = harm[i];
    EXPECT_REFUSED(sightline_projector_create(view, extent, &projector), SIGHTLINE_BAD_BOX, none);
  }
  EXPECT_REFUSED(sightline_frustum_make(NULL, &frustum), bad, none);
  EXPECT_REFUSED(sightline_frustum_make(view, NULL), bad, none);
  EXPECT_REFUSED(sightline_projector_create(NULL, kExtent, &projector), bad, none);
  EXPECT_REFUSED(sightline_projector_create(view, NULL, &projector), bad, none);
  EXPECT_REFUSED(sightline_projector_create(view, kExtent, NULL), bad, none);
  EXPECT(projector == NULL);
}

void test_frustum(void) {
  const sightline_view view = view_ahead();
  sightline_frustum frustum;
  EXPECT(sightline_frustum_make(&view, &frustum) == SIGHTLINE_OK);
  cull_flat(&frustum);
  cull_spread_spheres(&frustum);
  refuse_views(&view);

  const float inside[6] = {-1, -1, -11, 1, 1, -10}, behind[6] = {-1, -1, 10, 1, 1, 11},
              across[6] = {-100, -1, -11, 100, 1, -10};
  const float ball[4] = {0, 0, -10, 1}, gone[4] = {0, 0, 10, 1};
  EXPECT(sightline_frustum_classify(&frustum, inside) == SIGHTLINE_INSIDE);
  EXPECT(sightline_frustum_classify(&frustum, across) == SIGHTLINE_CROSSING);
  EXPECT(sightline_frustum_classify(&frustum, behind) == SIGHTLINE_OUTSIDE);
  EXPECT(sightline_frustum_overlaps_sphere(&frustum, ball) == 1);
  EXPECT(sightline_frustum_overlaps_sphere(&frustum, gone) == 0);
  EXPECT(sightline_frustum_classify(NULL, inside) == SIGHTLINE_CROSSING);
  EXPECT(sightline_frustum_classify(&frustum, NULL) == SIGHTLINE_CROSSING);
  EXPECT(sightline_frustum_overlaps_sphere(NULL, ball) == 1);
  EXPECT(sightline_frustum_overlaps_sphere(&frustum, NULL) == 1);

  sightline_projector* projector = NULL;
  float rect[4] = {9, 9, 9, 9};
  EXPECT(sightline_projector_create(&view, kExtent, &projector) == SIGHTLINE_OK);
  EXPECT(sightline_projector_rect(projector, inside, rect) == 1);
  EXPECT(rect[0] > 25 && rect[2] < 39 && rect[1] > 17 && rect[3] < 31);
  EXPECT(sightline_projector_rect(NULL, inside, rect) == 1);
  EXPECT(sightline_projector_rect(projector, NULL, rect) == 1);
  EXPECT(sightline_projector_rect(projector, inside, NULL) == 1);
  const float area = sightline_projector_area(projector, ball);
  EXPECT(area > 10 && area < 100 && sightline_projector_area_bound(projector, ball) >= area);
  EXPECT(isinf(sightline_projector_area(NULL, ball)) && isinf(sightline_projector_area(projector, NULL)));
  EXPECT(isinf(sightline_projector_area_bound(NULL, ball)));
  EXPECT(isinf(sightline_projector_area_bound(projector, NULL)));
  sightline_projector_destroy(projector);
  sightline_projector_destroy(NULL);
}

static void run_backwards(void* user, uint32_t count, void (*job)(void*, uint32_t), void* data) {
  *(uint32_t*)user += count;
  while (count > 0) job(data, --count);
}

static void refuse_rays(sightline_bvh* bvh, const sightline_view* view, const sightline_ray* ray) {
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  const sightline_box_view all = sightline_boxes_of(boxes, kCount), few = sightline_boxes_of(boxes, 3);
  const sightline_box_view missing = sightline_boxes_of(NULL, kCount);
  uint32_t met, visible[kCount];
  size_t count;
  sightline_jobs jobs = {NULL, NULL, 65, 0};
  EXPECT_REFUSED(sightline_bvh_build(NULL, &all, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_build(bvh, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_build(bvh, &missing, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_refit(NULL, &all), bad, none);
  EXPECT_REFUSED(sightline_bvh_refit(bvh, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_refit(bvh, &missing), bad, none);
  EXPECT_REFUSED(sightline_bvh_refit(bvh, &few), bad, none);
  const sightline_box right = boxes[7];
  boxes[7].min[0] = NAN;
  EXPECT_REFUSED(sightline_bvh_build(bvh, &all, NULL), SIGHTLINE_BAD_BOX, 7);
  EXPECT_REFUSED(sightline_bvh_refit(bvh, &all), SIGHTLINE_BAD_BOX, 7);
  boxes[7] = right;
  EXPECT_REFUSED(sightline_bvh_cast(NULL, ray, 1, &met, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_cast(bvh, NULL, 1, &met, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_cast(bvh, ray, 1, NULL, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_cast(bvh, ray, TOO_MUCH, &met, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_cast(bvh, ray, 1, &met, NULL, &jobs), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(NULL, view, 4, 4, visible, kCount, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, NULL, 4, 4, visible, kCount, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4, 4, NULL, kCount, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4, 4, visible, kCount, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4, 4, visible, TOO_MUCH, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4, 4, visible, kCount, &jobs, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 0, 4, visible, kCount, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4097, 4096, visible, kCount, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, view, 4, 4, visible, kCount - 1, NULL, &count),
                 SIGHTLINE_BUFFER_TOO_SMALL, none);
  sightline_view wrong = *view;
  wrong.eye_to_clip[0] = 0;
  EXPECT_REFUSED(sightline_bvh_visible_set(bvh, &wrong, 4, 4, visible, kCount, NULL, &count),
                 SIGHTLINE_BAD_VIEW, none);
}

void test_rays(void) {
  const sightline_view view = view_ahead();
  const sightline_ray rays[3] = {
      {{0, 0, 0}, {0, 0, -2}, INFINITY}, {{0, 0, 0}, {0, 1, 0}, INFINITY}, {{NAN, 0, 0}, {0, 0, 0}, 1}};
  uint32_t met[3] = {7, 7, 7}, visible[kCount], jobs_run = 0;
  float far_along[3] = {7, 7, 7};
  size_t count = 0;
  const sightline_jobs jobs = {run_backwards, &jobs_run, 3, 0};
  row_of_boxes(boxes, kCount);
  const sightline_box_view all = sightline_boxes_of(boxes, kCount);
  sightline_bvh* bvh = sightline_bvh_create();
  EXPECT(sightline_bvh_cast(bvh, rays, 3, met, NULL, NULL) == SIGHTLINE_OK && met[0] == SIGHTLINE_NO_OBJECT);
  EXPECT(sightline_bvh_build(bvh, &all, NULL) == SIGHTLINE_OK && sightline_bvh_size(bvh) == kCount);
  EXPECT(sightline_bvh_cast(bvh, rays, 3, met, far_along, NULL) == SIGHTLINE_OK);
  EXPECT(met[0] == 0 && far_along[0] == 2.25f);
  EXPECT(met[1] == SIGHTLINE_NO_OBJECT && far_along[1] == -1);
  EXPECT(met[2] == SIGHTLINE_NO_OBJECT && far_along[2] == -1);
  EXPECT(sightline_bvh_visible_set(bvh, &view, 9, 9, visible, kCount, &jobs, &count) == SIGHTLINE_OK);
  EXPECT(count == 1 && visible[0] == 0);
  for (int axis = 0; axis < 3; ++axis) boxes[0].min[axis] += 50, boxes[0].max[axis] += 50;
  EXPECT(sightline_bvh_refit(bvh, &all) == SIGHTLINE_OK);
  EXPECT(sightline_bvh_cast(bvh, rays, 3, met, far_along, &jobs) == SIGHTLINE_OK);
  EXPECT(met[0] == 1 && far_along[0] == 3.25f);
  refuse_rays(bvh, &view, rays);
  const double far_out[3] = {1e7, 0, 0};
  for (int i = 0; i < kCount; ++i) boxes[i].min[0] += 1e7, boxes[i].max[0] += 1e7;
  EXPECT(sightline_bvh_build(bvh, &all, far_out) == SIGHTLINE_OK);
  EXPECT(sightline_bvh_cast(bvh, rays, 1, met, NULL, NULL) == SIGHTLINE_OK && met[0] == 1);
  EXPECT(sightline_bvh_size(NULL) == 0);
  sightline_bvh_destroy(bvh);
  sightline_bvh_destroy(NULL);
}
