/* Visible sets: written, read, asked, refused. */
#include "expect.h"

#include <math.h>

typedef struct file {
  unsigned char bytes[4096];
  size_t size;
} file;

static void keep_bytes(void* user, const void* bytes, size_t size) {
  file* to = user;
  EXPECT(size <= sizeof to->bytes && to->size == 0);
  memcpy(to->bytes, bytes, size);
  to->size = size;
}

static const uint8_t kOpen[4] = {1, 1, 0, 1};
static const uint64_t kFirst[5] = {0, 2, 5, 5, 5};
static const uint32_t kVisible[5] = {1, 8, 0, 1, 9};

static sightline_pvs_cells four_cells(void) {
  sightline_pvs_cells cells = sightline_pvs_cells_default();
  cells.bounds[3] = 4, cells.bounds[4] = cells.bounds[5] = 1;
  cells.counts[0] = 4, cells.counts[1] = cells.counts[2] = 1;
  cells.cells = 4, cells.objects = 10, cells.scene = 77;
  cells.open = kOpen, cells.first = kFirst, cells.visible = kVisible, cells.visible_count = 5;
  return cells;
}

static void ask(const sightline_pvs* pvs) {
  const float second[3] = {1.5f, 0.5f, 0.5f}, closed[3] = {2.5f, 0.5f, 0.5f}, nowhere[3] = {NAN, 0, 0};
  EXPECT(sightline_pvs_cell_at(pvs, second) == 1);
  EXPECT(sightline_pvs_cell_at(pvs, closed) == SIGHTLINE_NO_CELL);
  EXPECT(sightline_pvs_cell_at(pvs, nowhere) == SIGHTLINE_NO_CELL);
  EXPECT(sightline_pvs_cell_at(pvs, NULL) == SIGHTLINE_NO_CELL);
  EXPECT(sightline_pvs_cell_at(NULL, second) == SIGHTLINE_NO_CELL);
  const uint32_t* objects = NULL;
  size_t count = 9;
  float bounds[6];
  EXPECT(sightline_pvs_seen_from(pvs, 1, &objects, &count) == SIGHTLINE_OK);
  EXPECT(count == 3 && objects[0] == 0 && objects[1] == 1 && objects[2] == 9);
  EXPECT(sightline_pvs_seen_from(pvs, 3, &objects, &count) == SIGHTLINE_OK && count == 0);
  EXPECT(sightline_pvs_cell_bounds(pvs, 2, bounds) == SIGHTLINE_OK);
  EXPECT(bounds[0] == 2 && bounds[3] == 3 && bounds[1] == 0 && bounds[5] == 1);
  sightline_pvs_cells cells = sightline_pvs_cells_default();
  EXPECT(sightline_pvs_contents(pvs, &cells) == SIGHTLINE_OK);
  EXPECT(cells.cells == 4 && cells.counts[0] == 4 && cells.objects == 10 && cells.scene == 77);
  EXPECT(cells.bounds[3] == 4 && cells.open[2] == 0 && cells.first[4] == 5 && cells.visible_count == 5);
  EXPECT(memcmp(cells.visible, kVisible, sizeof kVisible) == 0);

  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  const size_t none = SIGHTLINE_NO_INDEX;
  EXPECT_REFUSED(sightline_pvs_seen_from(pvs, 4, &objects, &count), bad, none);
  EXPECT_REFUSED(sightline_pvs_seen_from(NULL, 0, &objects, &count), bad, none);
  EXPECT_REFUSED(sightline_pvs_seen_from(pvs, 0, NULL, &count), bad, none);
  EXPECT_REFUSED(sightline_pvs_seen_from(pvs, 0, &objects, NULL), bad, none);
  EXPECT_REFUSED(sightline_pvs_cell_bounds(pvs, SIGHTLINE_NO_CELL, bounds), bad, none);
  EXPECT_REFUSED(sightline_pvs_cell_bounds(NULL, 0, bounds), bad, none);
  EXPECT_REFUSED(sightline_pvs_cell_bounds(pvs, 0, NULL), bad, none);
  EXPECT_REFUSED(sightline_pvs_contents(pvs, NULL), bad, none);
  EXPECT_REFUSED(sightline_pvs_contents(NULL, &cells), bad, none);
  cells.struct_size = 8;
  EXPECT_REFUSED(sightline_pvs_contents(pvs, &cells), bad, none);
}

static void refuse_cells(void) {
  const uint64_t unordered[5] = {0, 9, 5, 5, 5};
  const uint32_t beyond[5] = {1, 8, 0, 1, 10};
  file out = {{0}, 0};
  sightline_pvs_cells wrong[10];
  for (int i = 0; i < 10; ++i) wrong[i] = four_cells();
  wrong[0].open = NULL, wrong[1].first = NULL, wrong[2].visible = NULL;
  wrong[3].visible_count = TOO_MUCH, wrong[4].visible_count = 4, wrong[5].counts[0] = 5;
  wrong[6].first = unordered, wrong[7].visible = beyond, wrong[8].struct_size = 3;
  wrong[9].cells = 0xffffffffu;
  for (int i = 0; i < 10; ++i) {
    const sightline_status code = i == 9 ? SIGHTLINE_TOO_MANY : SIGHTLINE_BAD_ARGUMENT;
    EXPECT(sightline_pvs_write(&wrong[i], keep_bytes, &out) == code);
  }
  /* Counts of one cell: no more than its flag is read. */
  sightline_pvs_cells one = four_cells();
  uint8_t flag = 1;
  one.counts[0] = 1, one.cells = 7, one.open = &flag;
  EXPECT_REFUSED(sightline_pvs_write(&one, keep_bytes, &out), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(strstr(sightline_last_error(), "counts[0]") != NULL);
  one.counts[0] = one.counts[1] = one.counts[2] = 0x10000u, one.cells = 0;
  EXPECT_REFUSED(sightline_pvs_write(&one, keep_bytes, &out), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  const sightline_pvs_cells right = four_cells();
  EXPECT_REFUSED(sightline_pvs_write(NULL, keep_bytes, &out), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_pvs_write(&right, NULL, &out), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(out.size == 0);
}

void test_pvs(void) {
  static file out;
  sightline_pvs* pvs = NULL;
  const sightline_pvs_cells cells = four_cells();
#ifdef SIGHTLINE_TESTS_PVS
  refuse_cells();
  EXPECT(sightline_pvs_write(&cells, keep_bytes, &out) == SIGHTLINE_OK);
  EXPECT(sightline_pvs_read(out.bytes, out.size, &pvs) == SIGHTLINE_OK);
  ask(pvs);
  sightline_pvs_destroy(pvs);
  pvs = NULL;
  out.bytes[out.size - 1] ^= 1;
#else
  (void)refuse_cells, (void)ask;
  EXPECT(sightline_pvs_write(&cells, keep_bytes, &out) == SIGHTLINE_BAD_FILE);
#endif
  EXPECT(sightline_pvs_read(out.bytes, out.size, &pvs) == SIGHTLINE_BAD_FILE);
  EXPECT(sightline_pvs_read(out.bytes, out.size / 2, &pvs) == SIGHTLINE_BAD_FILE);
  EXPECT(sightline_pvs_read(NULL, 0, &pvs) == SIGHTLINE_BAD_FILE);
  const sightline_status bad = SIGHTLINE_BAD_ARGUMENT;
  EXPECT_REFUSED(sightline_pvs_read(NULL, 9, &pvs), bad, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_pvs_read(out.bytes, TOO_MUCH, &pvs), bad, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_pvs_read(out.bytes, out.size, NULL), bad, SIGHTLINE_NO_INDEX);
  EXPECT(pvs == NULL);
  sightline_pvs_destroy(NULL);
}
