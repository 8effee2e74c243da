/* An occluder of a mesh: a hill of 20,000 triangles, and the few that hide what it hides. */
#include <sightline/sightline.h>
#include <stdio.h>

enum { kSide = 100, kPoints = (kSide + 1) * (kSide + 1), kCorners = 6 * kSide * kSide };
static float points[kPoints][3];
static uint32_t corners[kCorners];

static int fail(void) {
  return fprintf(stderr, "%s\n", sightline_last_error()), 2;
}

int main(void) {
  uint32_t* out = corners;
  for (uint32_t z = 0; z <= kSide; ++z) {
    for (uint32_t x = 0; x <= kSide; ++x) {
      const float u = 2.0f * (float)x / kSide - 1, v = 2.0f * (float)z / kSide - 1;
      float* p = points[z * (kSide + 1) + x]; /* a flat top 20 m up, and slopes down to the ground */
      const float edge = (u < 0 ? -u : u) > (v < 0 ? -v : v) ? (u < 0 ? -u : u) : (v < 0 ? -v : v);
      p[0] = 100 * u, p[1] = edge < 0.5f ? 20 : 40 * (1 - edge), p[2] = 100 * v;
      if (x == kSide || z == kSide) continue;
      const uint32_t a = z * (kSide + 1) + x,
                     quad[6] = {a, a + kSide + 1, a + kSide + 2, a, a + kSide + 2, a + 1};
      for (int i = 0; i < 6; ++i) *out++ = quad[i];
    }
  }
  sightline_occluder* occluder; /* once, offline or when the mesh is loaded */
  if (sightline_occluder_create(points[0], kPoints, corners, kCorners, NULL, 0, 64, 8, &occluder))
    return fail();
  sightline_occluder_parts parts = sightline_occluder_parts_default();
  if (sightline_occluder_contents(occluder, &parts)) return fail();
  sightline_occluder_mesh* mesh; /* what sightline_occlusion_draw_mesh() draws each frame */
  if (sightline_occluder_mesh_create(parts.positions, parts.position_count, parts.indices, parts.index_count,
                                     parts.sides, parts.index_count / 3, &mesh))
    return fail();
  printf("%d triangles: %zu occlude\n", kCorners / 3, sightline_occluder_mesh_triangles(mesh));
  sightline_occluder_mesh_destroy(mesh);
  sightline_occluder_destroy(occluder);
  return 0;
}
