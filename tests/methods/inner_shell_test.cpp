#include "workbench/methods/raster_occlusion/inner_shell.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "workbench/scene/shapes.hpp"

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

TEST(InnerBall, FillsWhatIsRoundAndLiesInsideIt) {
  scene::Shape round = scene::sphere(2);
  for (Vec3& p : round.positions) p = {3 + 2 * p.x, 2 * p.y, 2 * p.z - 1};
  const std::optional<Sphere> ball = inner_ball(round.positions, round.indices);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->centre.x, 3, 1e-4);
  EXPECT_GT(ball->radius, 1.8f);
  // No triangle's plane cuts it.
  for (std::size_t i = 0; i < round.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      return geometry::to_double(round.positions[round.indices[i + k]]);
    };
    const glm::dvec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    EXPECT_GE(std::fabs(glm::dot(normal, corner(0) - geometry::to_double(ball->centre))), ball->radius);
  }
}

TEST(InnerBall, IsNotFoundInWhatIsOpenDentedOrLong) {
  scene::Shape open = scene::sphere(2), dented = open, stretched = open;
  open.indices.resize(open.indices.size() - 3);
  dented.positions[7] = {0, 0, 0};
  for (Vec3& p : stretched.positions) p.y *= 1.5f;
  for (const scene::Shape& shape : {open, dented, stretched}) {
    EXPECT_FALSE(inner_ball(shape.positions, shape.indices));
  }
}

}  // namespace
}  // namespace sightline::methods
