#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

#include <gtest/gtest.h>

#include <array>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline {
namespace {

using geometry::to_double;

bool has_reversed_depth(const View& view) {
  const auto& m = view.eye_to_clip.m;
  return double{m[10]} * m[15] - double{m[14]} * m[11] > 0;
}

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
    const Frustum frustum = make_frustum(view);
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
    const Frustum frustum = make_frustum(view);
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
    const Frustum frustum = make_frustum(view);
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
      const Frustum frustum = make_frustum(*make_view(camera, 100, 100));
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
    EXPECT_TRUE(overlaps(make_frustum(*make_view(camera, 100, 100)), far_box));
  }
}

// A point that the clip volume holds, next to its border as often as not: in world space, rounded.
Vec3 point_in_view(scene::Random& random, const View& view) {
  const auto across = [&] {
    return double{random.below(2) == 0 ? random.between(-1, 1) : random.below(2) == 0 ? -1 : 1};
  };
  const double x = across(), y = across();
  const double z = random.below(8) == 0 ? 0.0 : std::pow(double{random.unit()}, 0.02);
  const glm::dvec4 p = glm::inverse(to_double(view.eye_to_clip) * to_double(view.world_to_eye)) *
                       glm::dvec4(x, y, has_reversed_depth(view) ? 1 - z : z, 1);
  return geometry::to_vec3(glm::dvec3(p) / p.w);
}

// Whatever the box or sphere about it and however far the eye: sizes and distances of all magnitudes.
TEST(Frustum, LosesNothingThatHoldsAVisiblePoint) {
  scene::Random random(5);
  int seen = 0, dropped = 0;
  for (int v = 0; v < 3000; ++v) {
    const float far = std::exp(random.between(-3, 14));
    const View view = test::random_view(random, {{far - 300, -300, -far - 300}, {far + 300, 300, 300 - far}});
    const Frustum frustum = make_frustum(view);
    for (int i = 0; i < 40; ++i) {
      const Vec3 p = point_in_view(random, view);
      if (!geometry::is_finite(p)) continue;
      const float size = random.below(3) == 0 ? 0 : std::exp(random.between(-10, 60));
      Vec3 towards = random.direction();
      if (random.below(2) == 0) {  // straight out of the frustum, so that a sphere only touches it
        const Vec3& n = frustum.planes[random.below(4)].normal;
        towards = {-n.x, -n.y, -n.z};
      }
      const Vec3 centre{p.x + size * towards.x, p.y + size * towards.y, p.z + size * towards.z};
      const double away = glm::length(to_double(centre) - to_double(p));
      const Sphere sphere{centre, std::nextafter(static_cast<float>(away), INFINITY)};
      const Box box{{std::fmin(p.x, centre.x), std::fmin(p.y, centre.y), std::fmin(p.z, centre.z)},
                    {std::fmax(p.x, centre.x), std::fmax(p.y, centre.y), std::fmax(p.z, centre.z)}};
      dropped += overlaps(frustum, {centre, centre}) ? 0 : 1;
      if (clip_clearance(view, {p, p}) < 0) continue;
      ++seen;
      ASSERT_TRUE(overlaps(frustum, box)) << "view " << v << ", size " << size;
      ASSERT_TRUE(overlaps(frustum, sphere)) << "view " << v << ", size " << size;
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_GT(dropped, 20000);
}

TEST(Projection, CoversTheWholePlaneBeyondItsExtent) {
  const Projector projector = make_projector(*make_view(Camera{}, 64, 64), {{-9, -9, -9}, {9, 9, 9}});
  EXPECT_LT(projected_rect(projector, {{-1, -1, -9}, {1, 1, -8}}).max_x, 64);
  EXPECT_EQ(projected_rect(projector, {{-1, -1, -10}, {1, 1, -8}}).max_x, INFINITY);
}

}  // namespace
}  // namespace sightline
