#include <sightline/projection.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline {
namespace {

using geometry::to_double;

struct Pixel {
  double x, y, w;
};

Pixel pixel_of(const View& view, const Vec3& point) {
  const glm::dvec4 c =
      to_double(view.eye_to_clip) * to_double(view.world_to_eye) * glm::dvec4(to_double(point), 1);
  return {(c.x / c.w + 1) * 0.5 * view.width, (1 - c.y / c.w) * 0.5 * view.height, c.w};
}

TEST(Projection, ARectHoldsThePixelsOfEveryPointOfItsBox) {
  scene::Random random(1);
  int finite = 0;
  for (int v = 0; v < 1000; ++v) {
    const View view = test::random_view(random, test::kAround);
    const Projector projector = make_projector(view, {{-600, -600, -600}, {600, 600, 600}});
    for (int b = 0; b < 20; ++b) {
      const Box box = test::random_box(random, test::kAround);
      const Rect rect = projected_rect(projector, box);
      if (std::isinf(rect.min_x)) continue;
      ++finite;
      for (int i = 0; i < 10; ++i) {
        const Pixel p = pixel_of(view, random.inside(box));
        ASSERT_GT(p.w, 0);
        ASSERT_GE(p.x, rect.min_x);
        ASSERT_LE(p.x, rect.max_x);
        ASSERT_GE(p.y, rect.min_y);
        ASSERT_LE(p.y, rect.max_y);
      }
    }
  }
  EXPECT_GT(finite, 3000);
}

TEST(Projection, ABoxAcrossTheEyePlaneHasNoRect) {
  const Projector projector = make_projector(*make_view({}, 100, 100), test::kAround);
  EXPECT_TRUE(std::isinf(projected_rect(projector, {{-1, -1, -1}, {1, 1, 1}}).min_x));
  EXPECT_FALSE(std::isinf(projected_rect(projector, {{-1, -1, -9}, {1, 1, -8}}).min_x));
}

TEST(Projection, ARectHoldsASampleWhereAPixelCentreLies) {
  Projector projector;
  projector.width = 10, projector.height = 10;
  EXPECT_TRUE(covers_sample(projector, {3.4f, 3.4f, 3.6f, 3.6f}));
  EXPECT_FALSE(covers_sample(projector, {3.6f, 3.4f, 4.4f, 3.6f}));
  EXPECT_FALSE(covers_sample(projector, {3.4f, 3.6f, 3.6f, 4.4f}));
  EXPECT_TRUE(covers_sample(projector, {-5, -5, 20, 20}));
  EXPECT_FALSE(covers_sample(projector, {-5, -5, 0.4f, 20}));
  EXPECT_FALSE(covers_sample(projector, {9.6f, 0, 20, 20}));
  EXPECT_TRUE(covers_sample(projector, {9.4f, 0, 20, 20}));
}

// Counts samples in a supersampled image of the sphere.
double sampled_area(const View& view, const Sphere& sphere) {
  const glm::dmat4 inverse = glm::inverse(to_double(view.eye_to_clip) * to_double(view.world_to_eye));
  const glm::dvec3 eye = to_double(eye_position(view)), centre = to_double(sphere.centre);
  constexpr int kPerPixel = 4;
  int hits = 0;
  for (std::uint32_t y = 0; y < view.height * kPerPixel; ++y) {
    for (std::uint32_t x = 0; x < view.width * kPerPixel; ++x) {
      const glm::dvec4 clip{(x + 0.5) / kPerPixel / view.width * 2 - 1,
                            1 - (y + 0.5) / kPerPixel / view.height * 2, 0.5, 1};
      const glm::dvec4 world = inverse * clip;
      const glm::dvec3 direction = glm::normalize(glm::dvec3(world) / world.w - eye);
      const glm::dvec3 offset = centre - eye;
      const double along = glm::dot(offset, direction);
      hits += along > 0 && glm::dot(offset, offset) - along * along <= double{sphere.radius} * sphere.radius;
    }
  }
  return hits / double{kPerPixel * kPerPixel};
}

TEST(Projection, TheAreaBoundIsTheAreaOfTheEllipse) {
  scene::Random random(5);
  for (int i = 0; i < 12; ++i) {
    const View view = *make_view({.vertical_fov = 1.4f}, 120, 90);
    const Sphere sphere{{random.between(-4, 4), random.between(-3, 3), random.between(-14, -9)},
                        random.between(0.5f, 2)};
    const Projector projector = make_projector(view, test::kAround);
    const double area = sampled_area(view, sphere);
    const float bound = projected_area_bound(projector, sphere);
    if (area == 0) continue;
    EXPECT_LE(area, bound * 1.02) << i;
    // Equal where the sphere is wholly on the image.
    const Pixel p = pixel_of(view, sphere.centre);
    const double reach = 2 * std::sqrt(bound / std::numbers::pi);
    if (p.x > reach && p.x < 120 - reach && p.y > reach && p.y < 90 - reach)
      EXPECT_NEAR(area, bound, 0.03 * bound) << i;
    EXPECT_LE(projected_area(projector, sphere), bound * 1.0001f);
  }
}

TEST(Projection, TheEyeInsideASphereSeesNothingElse) {
  const Projector projector = make_projector(*make_view({}, 100, 100), test::kAround);
  EXPECT_TRUE(std::isinf(projected_area(projector, {{0, 0, 1}, 2})));
  EXPECT_TRUE(std::isinf(projected_area_bound(projector, {{0, 0, 1}, 2})));
}

TEST(Projection, AnOrthographicSphereKeepsItsAreaAtAnyDistance) {
  Camera camera;
  camera.orthographic_height = 50;
  const Projector projector = make_projector(*make_view(camera, 100, 100), test::kAround);
  const float expected = std::numbers::pi_v<float> * 4 * 4;
  EXPECT_NEAR(projected_area(projector, {{0, 0, -10}, 2}), expected, 1e-2);
  EXPECT_NEAR(projected_area(projector, {{0, 0, -200}, 2}), expected, 1e-2);
}

}  // namespace
}  // namespace sightline
