#include "methods/raster_occlusion/inner_shell.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "culling/depth_tiles.hpp"
#include "scene/shapes.hpp"

namespace sightline::methods {
namespace {

TEST(InnerShell, StandsInForAClosedConvexMeshAndLiesInsideIt) {
  const scene::Shape ball = scene::sphere(3);
  const OccluderMesh shell = simple_occluder(ball.positions, ball.indices);
  EXPECT_EQ(shell.triangles(), 80u);
  for (const Vec3& p : shell.topology().positions) {
    EXPECT_LT(p.x * p.x + p.y * p.y + p.z * p.z, 1.0f);
    EXPECT_GT(p.x * p.x + p.y * p.y + p.z * p.z, 0.9f);
  }
}

TEST(InnerShell, LeavesOpenAndHollowMeshesAsTheyAre) {
  scene::Shape open = scene::sphere(2);
  open.indices.resize(open.indices.size() - 3);
  EXPECT_EQ(simple_occluder(open.positions, open.indices).triangles(), 319u);
  scene::Shape dented = scene::sphere(2);
  dented.positions[7] = {0, 0, 0};
  EXPECT_EQ(simple_occluder(dented.positions, dented.indices).triangles(), 320u);
}

}  // namespace
}  // namespace sightline::methods
