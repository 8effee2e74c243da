/* What a cull did, as numbers and shapes, and what is refused. */
#include "expect.h"

enum { kBoxes = 40 };

void test_inspect(void) {
  sightline_world* world = sightline_world_create();
  sightline_culler* culler = sightline_culler_create();
  sightline_inspector* inspector = sightline_inspector_create();
  sightline_box boxes[kBoxes];
  sightline_handle handles[kBoxes];
  uint32_t layers[kBoxes], ids[kBoxes + 200];
  uint8_t pixels[64 * 48];
  double corners[24];
  row_of_boxes(boxes, kBoxes);
  for (uint32_t i = 0; i < kBoxes; ++i) layers[i] = i % 4 == 0 ? 1 : 2;
  sightline_object_columns columns = sightline_object_columns_default();
  columns.layers = sightline_column_of(layers, sizeof *layers, kBoxes);
  const sightline_box_view all = sightline_boxes_of(boxes, kBoxes);
  const sightline_handles given = sightline_handles_of(handles, sizeof *handles, kBoxes);
  EXPECT(sightline_world_insert(world, &all, &given, &columns) == SIGHTLINE_OK);

  const sightline_view ahead = view_ahead();
  sightline_cull_view view = sightline_cull_view_of(&ahead);
  sightline_inspection looked;
  view.layers = 2;
  EXPECT(sightline_inspect(inspector, world, &view, 1, culler, &looked) == SIGHTLINE_OK);
  EXPECT(looked.view_count == 1 && looked.box_count >= 2);
  const sightline_view_stats* s = looked.views;
  sightline_cull_result result;
  const sightline_cull_output output = sightline_cull_output_of(ids, NULL, sizeof ids / sizeof *ids);
  EXPECT(sightline_cull(culler, world, &view, 1, NULL, &output, &result) == SIGHTLINE_OK);
  EXPECT(s->sectors == 1 && s->sectors_in_view == 1 && s->groups >= 1);
  EXPECT(s->visible == result.count && s->visible > 0 && s->by_layers == kBoxes / 4);
  EXPECT(s->objects == s->outside + s->by_layers + s->visible && s->objects == kBoxes);
  EXPECT(s->objects_tested == result.tested);
  size_t sectors = 0, chunks = 0;
  for (size_t i = 0; i < looked.box_count; ++i) {
    const sightline_debug_box* box = &looked.boxes[i];
    sectors += box->kind == SIGHTLINE_DEBUG_SECTOR, chunks += box->kind == SIGHTLINE_DEBUG_CHUNK;
    EXPECT(box->box.min[2] <= boxes[kBoxes - 1].min[2] || box->kind == SIGHTLINE_DEBUG_CHUNK);
    EXPECT(box->objects > 0);
  }
  EXPECT(sectors == s->sectors && chunks == s->chunks);

  EXPECT(sightline_view_corners(&ahead, 100, corners) == SIGHTLINE_OK);
  EXPECT(corners[0] < 0 && corners[3] > 0 && corners[12] < -50 && corners[14] < -99.9 &&
         corners[14] > -100.1);
  EXPECT_REFUSED(sightline_view_corners(&ahead, 0, corners), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_view_corners(NULL, 1, corners), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);

  sightline_occlusion* occlusion = sightline_occlusion_create();
  EXPECT_REFUSED(sightline_occlusion_depth_image(occlusion, pixels, sizeof pixels), SIGHTLINE_STALE_BUFFER,
                 SIGHTLINE_NO_INDEX);
  EXPECT(sightline_occlusion_begin(occlusion, &ahead) == SIGHTLINE_OK);
  const sightline_box_view first = sightline_boxes_of(boxes, 1);
  EXPECT(sightline_occlusion_draw_boxes(occlusion, &first) == SIGHTLINE_OK);
  EXPECT(sightline_occlusion_depth_image(occlusion, pixels, sizeof pixels) == SIGHTLINE_OK);
  EXPECT(pixels[0] == 0 && pixels[24 * 64 + 32] == 255);
  EXPECT_REFUSED(sightline_occlusion_depth_image(occlusion, pixels, 5), SIGHTLINE_BUFFER_TOO_SMALL,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_culler_depth_image(culler, 0, pixels, sizeof pixels), SIGHTLINE_STALE_BUFFER,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_culler_depth_image(NULL, 0, pixels, sizeof pixels), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_inspect(inspector, NULL, &view, 1, NULL, &looked), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_inspect(inspector, world, &view, TOO_MUCH, NULL, &looked), SIGHTLINE_BAD_ARGUMENT,
                 TOO_MUCH);
  sightline_occlusion_destroy(occlusion);
  sightline_inspector_destroy(inspector);
  sightline_culler_destroy(culler);
  sightline_world_destroy(world);
}
