#include "library/rays/ray_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline::rays {
namespace {

using geometry::to_double;

// A point on the ray projects where the ray was aimed, and the ray starts and ends on the near and far plane.
TEST(RayGrid, RaysProjectToTheirGridPoints) {
  scene::Random random(41);
  const Box around{{-100, -100, -100}, {100, 100, 100}};
  std::size_t endless = 0;
  for (int round = 0; round < 300; ++round) {
    const View view = test::random_view(random, around);
    const glm::dmat4 project = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
    RayGrid grid;
    grid.make(view, 7, 5);
    ASSERT_EQ(grid.size(), 35u);
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
      const Ray& ray = grid.rays[i];
      const double x = 2 * (i % 7 + 0.5) / 7 - 1, y = 1 - 2 * (i / 7 + 0.5) / 5;
      const bool bounded = ray.max_distance < 1e30f;
      endless += !bounded;
      const double length = bounded ? ray.max_distance : 1000;
      for (const double t : {0.0, 0.5, 1.0}) {
        const glm::dvec3 at = to_double(ray.origin) + t * length * to_double(ray.direction);
        const glm::dvec4 clip = project * glm::dvec4(at, 1);
        if (t > 0) {
          EXPECT_NEAR(clip.x / clip.w, x, 2e-3);
          EXPECT_NEAR(clip.y / clip.w, y, 2e-3);
        }
        const double depth = clip.z / clip.w;
        const bool reversed = to_double(view.eye_to_clip)[2][2] >= 0;
        const double forwards = reversed ? 1 - depth : depth;
        if (t == 0) EXPECT_NEAR(forwards, 0, 5e-3);
        if (t == 1 && bounded) EXPECT_NEAR(forwards, 1, 5e-3);
      }
    }
  }
  EXPECT_GT(endless, 100u);
}

TEST(RayGrid, RowsRunFromTheTop) {
  RayGrid grid;
  grid.make(*make_view({}, 100, 100), 3, 3);
  EXPECT_GT(grid.rays[1].direction.y, 0);
  EXPECT_LT(grid.rays[7].direction.y, 0);
  EXPECT_LT(grid.rays[3].direction.x, 0);
  EXPECT_NEAR(grid.rays[4].direction.z, -1, 1e-6);
  EXPECT_EQ(grid.prepared[4].inverse.x, 0);  // straight ahead: parallel to x and y
}

}  // namespace
}  // namespace sightline::rays
