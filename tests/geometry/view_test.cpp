#include <sightline/view.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

glm::dvec3 project(const View& view, const Vec3& point) {
  const glm::dvec4 clip =
      geometry::to_double(world_to_clip(view)) * glm::dvec4(geometry::to_double(point), 1);
  return glm::dvec3(clip) / clip.w;
}

TEST(View, LooksAlongForwardWithUpUp) {
  const Result<View> view = make_view({.eye = {1, 2, 3}, .forward = {1, 0, 0}}, 200, 100);
  ASSERT_TRUE(view);
  const glm::dvec3 ahead = project(*view, {11, 2, 3}), above = project(*view, {11, 3, 3}),
                   right = project(*view, {11, 2, 4});
  EXPECT_NEAR(ahead.x, 0, 1e-6);
  EXPECT_NEAR(ahead.y, 0, 1e-6);
  EXPECT_GT(above.y, 0.01);
  EXPECT_GT(right.x, 0.01);
  EXPECT_EQ(eye_position(*view), (Vec3{1, 2, 3}));
  EXPECT_NEAR(view_direction(*view).x, 1, 1e-6);
}

TEST(View, DepthRunsFromNearToFar) {
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    for (const float orthographic : {0.0f, 10.0f}) {
      Camera camera{.near_plane = 0.5f, .far_plane = 100, .depth = depth};
      camera.orthographic_height = orthographic;
      const Result<View> view = make_view(camera, 64, 64);
      ASSERT_TRUE(view);
      const bool standard = depth == Depth::standard;
      EXPECT_NEAR(project(*view, {0, 0, -0.5f}).z, standard ? 0 : 1, 1e-6);
      EXPECT_NEAR(project(*view, {0, 0, -100}).z, standard ? 1 : 0, 1e-6);
      EXPECT_EQ(is_orthographic(*view), orthographic > 0);
    }
  }
}

TEST(View, InfiniteFarReachesEverything) {
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    const Result<View> view = make_view({.near_plane = 0.5f, .far_plane = kInfinity, .depth = depth}, 64, 64);
    ASSERT_TRUE(view);
    const double z = project(*view, {0, 0, -1e8f}).z;
    EXPECT_GE(z, 0);
    EXPECT_LE(z, 1);
  }
}

TEST(View, RefusesWhatNoCameraCanBe) {
  const auto refused = [](const Camera& camera) { return !make_view(camera, 64, 64); };
  EXPECT_TRUE(refused({.eye = {kNaN, 0, 0}}));
  EXPECT_TRUE(refused({.forward = {0, 0, 0}}));
  EXPECT_TRUE(refused({.forward = {0, kInfinity, 0}}));
  EXPECT_TRUE(refused({.forward = {0, 2, 0}}));  // along up
  EXPECT_TRUE(refused({.vertical_fov = 0}));
  EXPECT_TRUE(refused({.vertical_fov = std::numbers::pi_v<float>}));
  EXPECT_TRUE(refused({.vertical_fov = kNaN}));
  EXPECT_TRUE(refused({.near_plane = 0}));
  EXPECT_TRUE(refused({.near_plane = 10, .far_plane = 10}));
  EXPECT_TRUE(refused({.orthographic_height = -1}));
  EXPECT_TRUE(refused({.orthographic_height = 5, .far_plane = kInfinity}));
  EXPECT_TRUE(refused({.shift_x = kNaN}));
  EXPECT_FALSE(make_view({}, 0, 64));
  EXPECT_FALSE(make_view({}, 64, 20000));
  EXPECT_EQ(make_view({.forward = {0, 2, 0}}, 64, 64).error().code(), StatusCode::bad_view);
}

TEST(View, RefusesMatricesThatCannotBeCulledWith) {
  const View good = *make_view({}, 64, 64);
  EXPECT_TRUE(check(good));
  View view = good;
  view.eye_to_clip.m[3] = kNaN;
  EXPECT_FALSE(check(view));
  view = good;
  view.eye_to_clip = {};
  for (float& x : view.eye_to_clip.m) x = 1;
  ASSERT_FALSE(check(view));
  EXPECT_NE(std::string(check(view).message()).find("singular"), std::string::npos);
  view = good;
  view.world_to_eye.m[0] = view.world_to_eye.m[1] = view.world_to_eye.m[2] = 0;
  EXPECT_FALSE(check(view));
  view = good;
  view.world_to_eye.m[3] = 1;
  EXPECT_FALSE(check(view));
  view = good;
  view.width = 0;
  EXPECT_FALSE(check(view));
}

// A wide image that is shifted is as sound as one that is not, in whatever unit.
TEST(View, AcceptsLargeImagesBesideTheirMiddle) {
  for (const float height : {1e-3f, 1.0f, 4e4f, 1e8f}) {
    for (const Depth depth : {Depth::standard, Depth::reversed}) {
      const Camera camera{.orthographic_height = height,
                          .near_plane = 1,
                          .far_plane = 20000,
                          .shift_x = 1,
                          .shift_y = -0.5f,
                          .depth = depth};
      EXPECT_TRUE(make_view(camera, 64, 64)) << height;
    }
  }
}

// However far the eye is from the origin along every axis, its axes are sound.
TEST(View, IsSoundFarFromItsOrigin) {
  for (const float far : {1e4f, 1e5f, 1e7f, 1e10f}) {
    const Result<View> view = make_view({.eye = {far, -far, far}, .forward = {1, 2, -3}}, 64, 64);
    ASSERT_TRUE(view) << far << ": " << view.error().message();
  }
  EXPECT_EQ(make_view({.eye = {1e12f, 0, 0}}, 64, 64).error().code(), StatusCode::bad_view);
}

TEST(View, AcceptsAnyRandomCamera) {
  scene::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(check(test::random_view(random, {{-100, -100, -100}, {100, 100, 100}})));
  }
}

}  // namespace
}  // namespace sightline
