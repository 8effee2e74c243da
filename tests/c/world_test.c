/* Worlds: the caller's own structs in, their handles out, and what is refused. */
#include "expect.h"

#include <math.h>

enum { kCount = 100 };

typedef struct thing {
  char name[3];
  float half[3], position[3];
  double exact_half[3], exact_position[3];
  sightline_handle handle;
  uint32_t layer, number;
} thing;

static void make_things(thing* things) {
  for (uint32_t i = 0; i < kCount; ++i) {
    thing* t = &things[i];
    memset(t, 0, sizeof *t);
    for (int axis = 0; axis < 3; ++axis) {
      t->half[axis] = 0.5f, t->exact_half[axis] = 0.5;
      t->exact_position[axis] = axis == 2 ? -5.0 - 2.0 * i : 0;
      t->position[axis] = (float)t->exact_position[axis];
    }
    t->layer = 1u << (i % 2), t->number = 1000 + i;
  }
}

/* Whatever form the boxes are given in, the same stand there afterwards. */
static void insert_every_form(void) {
  static thing things[kCount];
  static sightline_box boxes[kCount];
  static float columns[6][kCount];
  make_things(things);
  row_of_boxes(boxes, kCount);
  for (int i = 0; i < kCount; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      columns[axis][i] = (float)boxes[i].min[axis], columns[3 + axis][i] = (float)boxes[i].max[axis];
    }
  }
  sightline_box_view forms[6];
  forms[0] = sightline_boxes_of(boxes, kCount);
  forms[1] = sightline_boxes_centre_half_float(things->position, things->half, sizeof *things, kCount);
  forms[2] =
      sightline_boxes_centre_half_double(things->exact_position, things->exact_half, sizeof *things, kCount);
  forms[3] =
      sightline_boxes_arrays(columns[0], columns[1], columns[2], columns[3], columns[4], columns[5], kCount);
  forms[4] = sightline_boxes_min_max_double(boxes->min, boxes->max, sizeof *boxes, kCount);
  forms[5] = forms[1], forms[5].origin[1] = 1e6;
  const sightline_handles handles = sightline_handles_of(&things->handle, sizeof *things, kCount);
  for (int f = 0; f < 6; ++f) {
    sightline_world* world = sightline_world_create();
    EXPECT(sightline_world_insert(world, &forms[f], &handles, NULL) == SIGHTLINE_OK);
    EXPECT(sightline_world_size(world) == kCount && sightline_world_id_limit(world) == kCount);
    for (int i = 0; i < kCount; ++i) {
      sightline_box box;
      EXPECT(sightline_world_box(world, things[i].handle, &box) == SIGHTLINE_OK);
      const double up = f == 5 ? 1e6 : 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double moved = axis == 1 ? up : 0;
        EXPECT(fabs(box.min[axis] - moved - boxes[i].min[axis]) < 1e-3);
        EXPECT(fabs(box.max[axis] - moved - boxes[i].max[axis]) < 1e-3);
        EXPECT(box.min[axis] <= boxes[i].min[axis] + moved && box.max[axis] >= boxes[i].max[axis] + moved);
      }
    }
    sightline_world_destroy(world);
  }
}

static void columns_and_handles(void) {
  static thing things[kCount];
  make_things(things);
  sightline_world* world = sightline_world_create();
  const sightline_box_view boxes =
      sightline_boxes_centre_half_float(things->position, things->half, sizeof *things, kCount);
  sightline_handles handles = sightline_handles_of(&things->handle, sizeof *things, kCount);
  sightline_object_columns columns = sightline_object_columns_default();
  columns.layers = sightline_column_of(&things->layer, sizeof *things, kCount);
  columns.values = sightline_column_of(&things->number, sizeof *things, kCount);
  EXPECT(sightline_world_insert(world, &boxes, &handles, &columns) == SIGHTLINE_OK);
  uint32_t layers = 0, value = 0;
  for (uint32_t i = 0; i < kCount; ++i) {
    const sightline_handle h = things[i].handle, found = sightline_world_handle(world, h.index);
    EXPECT(sightline_world_contains(world, h) == 1);
    EXPECT(found.index == h.index && found.generation == h.generation);
    EXPECT(sightline_world_layers(world, h, &layers) == SIGHTLINE_OK && layers == 1u << (i % 2));
    EXPECT(sightline_world_value(world, h, &value) == SIGHTLINE_OK && value == 1000 + i);
  }
  things[3].layer = 8, things[3].number = 7;
  EXPECT(sightline_world_set_layers(world, &handles, &columns.layers) == SIGHTLINE_OK);
  EXPECT(sightline_world_set_values(world, &handles, &columns.values) == SIGHTLINE_OK);
  EXPECT(sightline_world_layers(world, things[3].handle, &layers) == SIGHTLINE_OK && layers == 8);
  EXPECT(sightline_world_value(world, things[3].handle, &value) == SIGHTLINE_OK && value == 7);

  const sightline_handle third = things[3].handle;
  EXPECT(sightline_world_remove(world, &handles) == SIGHTLINE_OK);
  EXPECT(sightline_world_size(world) == 0 && !sightline_world_contains(world, third));
  EXPECT(sightline_world_handle(world, third.index).index == SIGHTLINE_NO_OBJECT);
  EXPECT_REFUSED(sightline_world_layers(world, third, &layers), SIGHTLINE_STALE_HANDLE, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_value(world, third, &value), SIGHTLINE_STALE_HANDLE, SIGHTLINE_NO_INDEX);
  sightline_world_destroy(world);
}

/* What each function of a world says to NULL. */
static void refuse_null(sightline_world* world, const sightline_box_view* boxes,
                        const sightline_handles* handles) {
  const sightline_column column = sightline_column_of(NULL, 4, 0);
  sightline_box box;
  uint32_t number;
  const sightline_handle handle = {0, 0};
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  EXPECT_REFUSED(sightline_world_insert(NULL, boxes, handles, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_insert(world, NULL, handles, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_insert(world, boxes, NULL, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_move(NULL, handles, boxes), bad, none);
  EXPECT_REFUSED(sightline_world_move(world, NULL, boxes), bad, none);
  EXPECT_REFUSED(sightline_world_move(world, handles, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_remove(NULL, handles), bad, none);
  EXPECT_REFUSED(sightline_world_remove(world, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_set_layers(NULL, handles, &column), bad, none);
  EXPECT_REFUSED(sightline_world_set_layers(world, NULL, &column), bad, none);
  EXPECT_REFUSED(sightline_world_set_layers(world, handles, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_set_values(NULL, handles, &column), bad, none);
  EXPECT_REFUSED(sightline_world_set_values(world, NULL, &column), bad, none);
  EXPECT_REFUSED(sightline_world_set_values(world, handles, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_box(NULL, handle, &box), bad, none);
  EXPECT_REFUSED(sightline_world_box(world, handle, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_layers(NULL, handle, &number), bad, none);
  EXPECT_REFUSED(sightline_world_layers(world, handle, NULL), bad, none);
  EXPECT_REFUSED(sightline_world_value(NULL, handle, &number), bad, none);
  EXPECT_REFUSED(sightline_world_value(world, handle, NULL), bad, none);
  EXPECT(sightline_world_size(NULL) == 0 && sightline_world_id_limit(NULL) == 0);
  EXPECT(sightline_world_contains(NULL, handle) == 0);
  EXPECT(sightline_world_handle(NULL, 0).index == SIGHTLINE_NO_OBJECT);
  sightline_world_destroy(NULL);
}

static void refuse_insert(sightline_world* world, sightline_box_view boxes, sightline_handles handles,
                          sightline_status code, size_t index) {
  const size_t before = sightline_world_size(world);
  EXPECT_REFUSED(sightline_world_insert(world, &boxes, &handles, NULL), code, index);
  EXPECT(sightline_world_size(world) == before);
}

/* Pointers, strides, counts, forms and sizes of structs that do not go together. */
static void refuse_views(sightline_world* world, sightline_box* boxes, sightline_handle* out) {
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  const sightline_handles to = sightline_handles_of(out, sizeof *out, 4);
  const sightline_box_view good = sightline_boxes_of(boxes, 4);
  refuse_insert(world, good, sightline_handles_of(out, sizeof *out, 3), bad, none);
  refuse_insert(world, good, sightline_handles_of(NULL, sizeof *out, 4), bad, none);
  refuse_insert(world, good, sightline_handles_of(out, sizeof *out - 1, 4), bad, none);
  refuse_insert(world, good, sightline_handles_of(out, TOO_MUCH, 4), bad, none);
  refuse_insert(world, sightline_boxes_of(NULL, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_min_max_double(boxes->min, NULL, sizeof *boxes, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_min_max_double(boxes->min, boxes->max, 23, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_min_max_double(boxes->min, boxes->max, 0, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_min_max_double(boxes->min, boxes->max, TOO_MUCH, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_of(boxes, TOO_MUCH), sightline_handles_of(out, 8, TOO_MUCH), bad,
                none);
  refuse_insert(world, sightline_boxes_of_form(5, boxes, boxes, sizeof *boxes, 4), to, bad, none);
  refuse_insert(world, sightline_boxes_arrays(NULL, NULL, NULL, NULL, NULL, NULL, 4), to, bad, none);
  sightline_box_view view = good;
  view.struct_size = 0, refuse_insert(world, view, to, bad, none);
  view.struct_size = (uint32_t)sizeof view + 1, refuse_insert(world, view, to, bad, none);

  sightline_object_columns columns = sightline_object_columns_default();
  const uint32_t numbers[4] = {1, 2, 3, 4};
  columns.layers = sightline_column_of(numbers, 4, 3);
  EXPECT_REFUSED(sightline_world_insert(world, &good, &to, &columns), bad, none);
  columns.layers = sightline_column_of(numbers, 3, 4);
  EXPECT_REFUSED(sightline_world_insert(world, &good, &to, &columns), bad, none);
  columns = sightline_object_columns_default(), columns.values = sightline_column_of(NULL, 4, 4);
  EXPECT_REFUSED(sightline_world_insert(world, &good, &to, &columns), bad, none);
  columns = sightline_object_columns_default(), columns.reserved = 1;
  EXPECT_REFUSED(sightline_world_insert(world, &good, &to, &columns), bad, none);
  columns = sightline_object_columns_default(), columns.struct_size = 4;
  EXPECT_REFUSED(sightline_world_insert(world, &good, &to, &columns), bad, none);
  EXPECT(sightline_world_size(world) == 0);
}

static void refuse_contents(sightline_world* world, sightline_box* boxes, sightline_handle* out) {
  const sightline_handles handles = sightline_handles_of(out, sizeof *out, 4);
  const sightline_box_view view = sightline_boxes_of(boxes, 4);
  const sightline_box whole = boxes[2];
  const double harm[4] = {NAN, INFINITY, 1e12, 100};
  for (int i = 0; i < 4; ++i) {
    boxes[2].min[i % 3] = harm[i];
    refuse_insert(world, view, handles, SIGHTLINE_BAD_BOX, 2);
    boxes[2] = whole;
  }
  EXPECT(sightline_world_insert(world, &view, &handles, NULL) == SIGHTLINE_OK);
  boxes[2].max[1] = -100;
  EXPECT_REFUSED(sightline_world_move(world, &handles, &view), SIGHTLINE_BAD_BOX, 2);
  boxes[2] = whole;

  const float centre[3] = {0, 0, 0}, negative[3] = {1, -1, 1};
  refuse_insert(world, sightline_boxes_centre_half_float(centre, negative, 12, 1),
                sightline_handles_of(out, 8, 1), SIGHTLINE_BAD_BOX, 0);

  const sightline_handle right = out[1];
  ++out[1].generation;
  const uint32_t numbers[4] = {1, 2, 3, 4};
  const sightline_column column = sightline_column_of(numbers, 4, 4);
  EXPECT_REFUSED(sightline_world_move(world, &handles, &view), SIGHTLINE_STALE_HANDLE, 1);
  EXPECT_REFUSED(sightline_world_remove(world, &handles), SIGHTLINE_STALE_HANDLE, 1);
  EXPECT_REFUSED(sightline_world_set_layers(world, &handles, &column), SIGHTLINE_STALE_HANDLE, 1);
  EXPECT_REFUSED(sightline_world_set_values(world, &handles, &column), SIGHTLINE_STALE_HANDLE, 1);
  out[1] = out[0];
  EXPECT_REFUSED(sightline_world_remove(world, &handles), SIGHTLINE_STALE_HANDLE, 1);
  out[1] = right;
  const sightline_handles huge = sightline_handles_of(out, sizeof *out, TOO_MUCH);
  EXPECT_REFUSED(sightline_world_remove(world, &huge), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(sightline_world_remove(world, &handles) == SIGHTLINE_OK);
  EXPECT(sightline_world_size(world) == 0);
}

void test_world(void) {
  insert_every_form();
  columns_and_handles();
  sightline_box boxes[4];
  sightline_handle out[4];
  row_of_boxes(boxes, 4);
  sightline_world* world = sightline_world_create();
  const sightline_box_view view = sightline_boxes_of(boxes, 4);
  const sightline_handles handles = sightline_handles_of(out, sizeof *out, 4);
  refuse_null(world, &view, &handles);
  refuse_views(world, boxes, out);
  refuse_contents(world, boxes, out);

  /* Nothing at all is no mistake. */
  const sightline_box_view no_boxes = sightline_boxes_of(NULL, 0);
  const sightline_handles no_handles = sightline_handles_of(NULL, 0, 0);
  EXPECT(sightline_world_insert(world, &no_boxes, &no_handles, NULL) == SIGHTLINE_OK);
  EXPECT(sightline_world_move(world, &no_handles, &no_boxes) == SIGHTLINE_OK);
  EXPECT(sightline_world_remove(world, &no_handles) == SIGHTLINE_OK);
  sightline_world_destroy(world);
}
