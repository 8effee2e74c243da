/* Worlds as bytes: saved, loaded, brought in by sectors, refused. */
#include "expect.h"

typedef struct file {
  unsigned char bytes[65536];
  size_t size;
} file;

static int keep_bytes(void* user, const void* bytes, size_t size) {
  file* to = user;
  if (size > sizeof to->bytes - to->size) return 0;
  memcpy(to->bytes + to->size, bytes, size);
  to->size += size;
  return 1;
}
static int take_none(void* user, const void* bytes, size_t size) {
  (void)user, (void)bytes, (void)size;
  return 0;
}

enum { kBoxes = 200 };
static file saved;

static void save_a_row(sightline_handle* handles) {
  sightline_box boxes[kBoxes];
  sightline_world* world = sightline_world_create();
  row_of_boxes(boxes, kBoxes);
  /* The last ones stand two sectors behind. */
  for (int i = kBoxes / 2; i < kBoxes; ++i) boxes[i].min[2] += 7000, boxes[i].max[2] += 7000;
  const sightline_box_view view = sightline_boxes_of(boxes, kBoxes);
  const sightline_handles out = sightline_handles_of(handles, sizeof *handles, kBoxes);
  EXPECT(sightline_world_insert(world, &view, &out, NULL) == SIGHTLINE_OK);
  saved.size = 0;
  EXPECT(sightline_world_save(world, keep_bytes, &saved) == SIGHTLINE_OK);
  EXPECT_REFUSED(sightline_world_save(world, take_none, NULL), SIGHTLINE_TOO_MANY, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_save(world, NULL, NULL), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_save(NULL, keep_bytes, &saved), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  sightline_world_destroy(world);
}

static size_t count_ahead(const sightline_world* world) {
  uint32_t ids[512];
  sightline_cull_result result;
  sightline_culler* culler = sightline_culler_create();
  EXPECT(cull_ahead(culler, world, NULL, ids, 512, &result) == SIGHTLINE_OK);
  sightline_culler_destroy(culler);
  return result.count;
}

static void load_all(const sightline_handle* handles) {
  sightline_world* world = NULL;
  EXPECT(sightline_world_load(saved.bytes, saved.size, &world) == SIGHTLINE_OK);
  EXPECT(sightline_world_size(world) == kBoxes);
  for (int i = 0; i < kBoxes; ++i) EXPECT(sightline_world_contains(world, handles[i]));
  EXPECT(count_ahead(world) == kBoxes / 2);
  sightline_world_destroy(world);
  EXPECT_REFUSED(sightline_world_load(saved.bytes, 7, &world), SIGHTLINE_BAD_FILE, 7);
  EXPECT_REFUSED(sightline_world_load(NULL, 7, &world), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_load(saved.bytes, TOO_MUCH, &world), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_load(saved.bytes, saved.size, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
}

static void bring_in(const sightline_handle* handles) {
  sightline_world* world = sightline_world_create();
  sightline_world_stream* stream = NULL;
  sightline_stream_report report;
  sightline_stream_sector sector;
  const sightline_handle* passed = NULL;
  size_t count = 9;
  sightline_stream_options options = sightline_stream_options_default();
  const sightline_view ahead = view_ahead();
  const sightline_cull_view view = sightline_cull_view_of(&ahead);
  EXPECT(sightline_world_stream_open(saved.bytes, saved.size, world, &stream) == SIGHTLINE_OK);
  EXPECT(sightline_world_stream_size(stream) == 2);
  EXPECT(sightline_world_stream_sector(stream, 0, &sector) == SIGHTLINE_OK);
  EXPECT(sector.objects == kBoxes / 2 && sector.state == SIGHTLINE_SECTOR_OUT && !sector.error);
  EXPECT(sector.first_byte == 16 && sector.memory > 28 * sector.objects && sector.bounds.max[2] == -4.5);
  EXPECT(count_ahead(world) == 0 && sightline_world_stream_stands_out(stream, handles[0]));
  EXPECT(sightline_world_stream_came(stream, &passed, &count) == SIGHTLINE_OK && count == 0);
  options.ahead = 0;
  EXPECT(sightline_world_stream_update(stream, &view, 1, &options, &report) == SIGHTLINE_OK);
  EXPECT(report.coming == 1 && report.missing == 1 && report.in == 0 && report.memory == sector.memory);
  EXPECT(sightline_world_stream_work(stream) && !sightline_world_stream_work(stream));
  EXPECT(sightline_world_stream_update(stream, &view, 1, &options, &report) == SIGHTLINE_OK);
  EXPECT(report.coming == 0 && report.missing == 0 && report.in == 1 && report.damaged == 0);
  EXPECT(sightline_world_stream_came(stream, &passed, &count) == SIGHTLINE_OK && count == kBoxes / 2);
  for (size_t i = 0; i < count; ++i) EXPECT(sightline_world_contains(world, passed[i]));
  EXPECT(sightline_world_stream_went(stream, &passed, &count) == SIGHTLINE_OK && count == 0);
  EXPECT(count_ahead(world) == kBoxes / 2 && sightline_world_contains(world, handles[0]));
  EXPECT(sightline_world_stream_stands_out(stream, handles[kBoxes - 1]));
  EXPECT_REFUSED(sightline_world_save(world, keep_bytes, &saved), SIGHTLINE_BAD_ARGUMENT, SIGHTLINE_NO_INDEX);
  EXPECT(sightline_world_stream_bring_in(stream, &view, 1, NULL, NULL) == SIGHTLINE_OK);
  options.budget = 1;
  EXPECT(sightline_world_stream_update(stream, &view, 1, &options, &report) == SIGHTLINE_OK);
  EXPECT(report.in == 0 && report.missing == 1 && report.memory == 0);
  EXPECT(sightline_world_stream_went(stream, &passed, &count) == SIGHTLINE_OK && count == kBoxes / 2);
  for (size_t i = 0; i < count; ++i) EXPECT(sightline_world_stream_stands_out(stream, passed[i]));
  EXPECT_REFUSED(sightline_world_stream_went(NULL, &passed, &count), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_came(stream, NULL, &count), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_came(stream, &passed, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_update(stream, &view, 9, NULL, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_update(NULL, &view, 1, NULL, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  options.struct_size = 3;
  EXPECT_REFUSED(sightline_world_stream_update(stream, &view, 1, &options, NULL), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_sector(stream, 2, &sector), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  EXPECT_REFUSED(sightline_world_stream_open(saved.bytes, saved.size, world, &stream), SIGHTLINE_BAD_ARGUMENT,
                 SIGHTLINE_NO_INDEX);
  sightline_world_stream_destroy(stream);
  sightline_world_destroy(world);
}

static void name_what_is_damaged(void) {
  sightline_world* world = sightline_world_create();
  sightline_world_stream* stream = NULL;
  sightline_stream_report report;
  sightline_stream_sector sector;
  const sightline_view ahead = view_ahead();
  const sightline_cull_view view = sightline_cull_view_of(&ahead);
  saved.bytes[1000] ^= 1;
  EXPECT(sightline_world_stream_open(saved.bytes, saved.size, world, &stream) == SIGHTLINE_OK);
  EXPECT(sightline_world_stream_bring_in(stream, &view, 1, NULL, &report) == SIGHTLINE_OK);
  EXPECT(report.damaged == 1 && report.missing == 0 && count_ahead(world) == 0);
  EXPECT(sightline_world_stream_sector(stream, 0, &sector) == SIGHTLINE_OK);
  EXPECT(sector.state == SIGHTLINE_SECTOR_DAMAGED && strlen(sector.error) > 20);
  sightline_world_stream_destroy(stream);
  sightline_world_destroy(world);
  EXPECT_REFUSED(sightline_world_load(saved.bytes, saved.size, &world), SIGHTLINE_BAD_FILE, 16);
  sightline_world_stream_destroy(NULL);
  EXPECT(sightline_world_stream_size(NULL) == 0 && !sightline_world_stream_work(NULL));
}

void test_snapshots(void) {
  sightline_handle handles[kBoxes];
  save_a_row(handles);
  load_all(handles);
  bring_in(handles);
  name_what_is_damaged();
}
