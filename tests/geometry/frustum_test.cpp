#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

#include <gtest/gtest.h>

#include <array>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline {
namespace {

using geometry::to_double;

// The largest overshoot of a box behind any clip plane, in double precision straight from the matrices:
// negative where the box is certainly outside. Scaled to metres.
double clip_clearance(const View& view, const Box& box) {
  const glm::dmat4 rows = glm::transpose(to_double(view.eye_to_clip) * to_double(view.world_to_eye));
  const std::array planes{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                          rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
  double worst = 1e30;
  for (const glm::dvec4& plane : planes) {
    const double length = glm::length(glm::dvec3(plane));
    if (length < 1e-12) continue;
    double best = -1e30;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z, 1};
      best = std::max(best, glm::dot(plane, p) / length);
    }
    worst = std::min(worst, best);
  }
  return worst;
}

TEST(Frustum, AgreesWithBruteForceInDoublePrecision) {
  scene::Random random(1);
  int outside = 0, kept = 0;
  for (int v = 0; v < 500; ++v) {
    const View view = test::random_view(random, test::kAround);
    const Frustum frustum = make_frustum(view, {{-900, -900, -900}, {900, 900, 900}});
    for (int b = 0; b < 200; ++b) {
      const Box box = test::random_box(random, test::kAround);
      const double clearance = clip_clearance(view, box);
      const bool overlap = overlaps(frustum, box);
      if (clearance >= 0) ASSERT_TRUE(overlap) << "lost a box by " << clearance << " m";
      if (overlap) ASSERT_GT(clearance, -2e-3) << "kept a box that is clearly outside";
      ++(overlap ? kept : outside);
    }
  }
  EXPECT_GT(outside, 10000);
  EXPECT_GT(kept, 5000);
}

TEST(Frustum, NeverLosesAPointInsideTheClipVolume) {
  scene::Random random(2);
  int inside = 0;
  for (int v = 0; v < 2000; ++v) {
    const View view = test::random_view(random, test::kAround);
    const Frustum frustum = make_frustum(view, test::kAround);
    const glm::dmat4 clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = random.inside(test::kAround);
      const glm::dvec4 c = clip * glm::dvec4(to_double(p), 1);
      const bool in = std::fabs(c.x) <= c.w && std::fabs(c.y) <= c.w && c.z >= 0 && c.z <= c.w;
      if (!in) continue;
      ++inside;
      ASSERT_TRUE(overlaps(frustum, Box{p, p}));
      ASSERT_TRUE(overlaps(frustum, Sphere{p, 0}));
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(Frustum, InsideMeansEveryCornerIsInside) {
  scene::Random random(3);
  int inside = 0;
  for (int v = 0; v < 500; ++v) {
    const View view = test::random_view(random, test::kAround);
    const Frustum frustum = make_frustum(view, test::kAround);
    for (int b = 0; b < 200; ++b) {
      const Box box = test::random_box(random, test::kAround);
      if (classify(frustum, box) != Overlap::inside) continue;
      ++inside;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                     corner & 4 ? box.max.z : box.min.z};
        for (const Plane& plane : frustum.planes) ASSERT_GE(signed_distance(plane, p.x, p.y, p.z), 0);
      }
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Frustum, KnowsItsFrontFromItsBack) {
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    for (const float orthographic : {0.0f, 20.0f}) {
      Camera camera{.near_plane = 1, .far_plane = 50, .depth = depth};
      camera.orthographic_height = orthographic;
      const Frustum frustum = make_frustum(*make_view(camera, 100, 100), {{-60, -60, -60}, {60, 60, 60}});
      EXPECT_NEAR(frustum.planes[Frustum::front].distance, -1, 1e-3);
      EXPECT_NEAR(frustum.planes[Frustum::back].distance, 50, 1e-2);
    }
  }
}

TEST(Frustum, AnInfiniteFarPlaneNeverRejects) {
  Camera camera{.far_plane = std::numeric_limits<float>::infinity()};
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    camera.depth = depth;
    const Box far_box{{-1, -1, -1e7f}, {1, 1, -1e7f}};
    EXPECT_TRUE(overlaps(make_frustum(*make_view(camera, 100, 100), far_box), far_box));
  }
}

// Planes are rounded for an extent: what reaches beyond it is never called outside.
TEST(Frustum, KeepsWhatReachesBeyondTheExtent) {
  const Frustum frustum = make_frustum(*make_view(Camera{}, 64, 64), {{-100, -100, -100}, {100, 100, 100}});
  const Box behind{{-1, -1, 50}, {1, 1, 60}};
  EXPECT_EQ(classify(frustum, behind), Overlap::outside);
  EXPECT_FALSE(overlaps(frustum, Sphere{{0, 0, 50}, 1}));
  for (const float far : {101.0f, 1e30f, INFINITY}) {
    Box beyond = behind;
    beyond.max.z = far;
    EXPECT_EQ(classify(frustum, beyond), Overlap::crossing) << far;
    EXPECT_TRUE(overlaps(frustum, Sphere{{0, 0, far}, 1})) << far;
  }
  const Projector projector = make_projector(*make_view(Camera{}, 64, 64), {{-9, -9, -9}, {9, 9, 9}});
  EXPECT_LT(projected_rect(projector, {{-1, -1, -9}, {1, 1, -8}}).max_x, 64);
  EXPECT_EQ(projected_rect(projector, {{-1, -1, -10}, {1, 1, -8}}).max_x, INFINITY);
}

}  // namespace
}  // namespace sightline
