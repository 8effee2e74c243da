/* What the tests of the C API share. */
#ifndef SIGHTLINE_TESTS_C_EXPECT_H
#define SIGHTLINE_TESTS_C_EXPECT_H

#include <sightline/sightline.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(condition)                                                                          \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      fprintf(stderr, "%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, sightline_last_error()); \
      exit(1);                                                                                     \
    }                                                                                              \
  } while (0)

/* The call is refused so, and says why and which element. */
#define EXPECT_REFUSED(call, code, which)      \
  do {                                         \
    EXPECT((call) == (code));                  \
    expect_failure((code), (which), __LINE__); \
  } while (0)

/* What no memory holds, and no sum of sizes survives. */
#define TOO_MUCH ((size_t)-1)

void expect_failure(sightline_status code, size_t index, int line);
/* At the origin, along -z; 64 x 48 pixels. */
sightline_view view_ahead(void);
/* Culls for view_ahead() into `room` ids. */
sightline_status cull_ahead(sightline_culler* culler, const sightline_world* world,
                            const sightline_cull_options* options, uint32_t* ids, size_t room,
                            sightline_cull_result* result);
/* `count` boxes of 1 m, one behind another, from 5 m ahead on. */
void row_of_boxes(sightline_box* boxes, int count);

void test_status(void);
void test_views(void);
void test_world(void);
void test_cull(void);
void test_columns(void);
void test_shadows(void);
void test_instances(void);
void test_snapshots(void);
void test_ranges(void);
void test_inspect(void);
void test_automatic(void);
void test_occlusion(void);
void test_frustum(void);
void test_rays(void);
void test_pvs(void);

#endif
