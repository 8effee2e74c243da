// The views of shadow maps: what they hold, and that cascades stand still.
#include <sightline/shadows.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random_views.hpp"
#include "support/shadow_points.hpp"

namespace sightline {
namespace {

using namespace test;
using scene::Random;

TEST(Cascades, HoldTheirPartOfWhatTheCameraSees) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    Camera camera = test::random_camera(random, kPlace);
    if (std::isinf(camera.far_plane)) camera.far_plane = 500;
    const WorldView view{*make_view(camera, 640, 360), {1e6, 0, 0}};
    const Light sun{.direction = random.direction(), .reach = random.between(0, 500)};
    std::array<Cascade, 4> cascades;
    ASSERT_TRUE(split_cascades(sun, view, {.logarithmic = random.unit(), .pixels = 512}, cascades));
    EXPECT_LE(cascades[0].depths.near_plane, camera.near_plane + 1e-3f);
    EXPECT_GE(cascades[3].depths.far_plane, 0.999f * camera.far_plane);
    for (std::size_t i = 1; i < 4; ++i) {
      ASSERT_EQ(cascades[i].depths.near_plane, cascades[i - 1].depths.far_plane);
      ASSERT_LT(cascades[i].depths.near_plane, cascades[i].depths.far_plane);
    }
    for (int i = 0; i < 200; ++i) {
      const Vec3 at = random.inside(kPlace);
      const WorldPoint p{1e6 + at.x, at.y, at.z};
      if (!is_seen(view, p)) continue;
      const double depth = depth_along(view, p);
      for (const Cascade& cascade : cascades) {
        if (depth < cascade.depths.near_plane || depth > cascade.depths.far_plane) continue;
        ASSERT_TRUE(is_seen(cascade.view, p)) << "seed " << seed;
        const glm::dvec3 there =
            0.999 * static_cast<double>(sun.reach) * glm::normalize(to_double(sun.direction));
        ASSERT_TRUE(is_seen(cascade.view, {p.x - there.x, p.y - there.y, p.z - there.z})) << "seed " << seed;
      }
    }
  }
}

TEST(Cascades, MoveByWholeTexelsWhereverTheCameraGoes) {
  Random random(7);
  for (int sun_at = 0; sun_at < 20; ++sun_at) {
    const Light sun{.direction = random.direction()};
    const WorldPoint mark{3.7, 1.1, -2.9};
    std::array<glm::dvec2, 3> first{};
    bool begun = false;
    for (int step = 0; step < 40; ++step) {
      Camera camera;
      camera.eye = {0.037f * static_cast<float>(step), 1.7f, 0.01f * static_cast<float>(step)};
      camera.forward = random.direction(), camera.far_plane = 60;
      if (std::fabs(camera.forward.y) > 0.99f) continue;
      // A floating origin changes nothing.
      const WorldPoint origin{step % 2 * 64.0, 0, 0};
      camera.eye.x -= static_cast<float>(origin.x);
      const WorldView view{*make_view(camera, 640, 360), origin};
      std::array<Cascade, 3> cascades;
      ASSERT_TRUE(split_cascades(sun, view, {.depths = {0.1f, 60}}, cascades));
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec4 clip = to_double(cascades[i].view.view.eye_to_clip) *
                                to_double(cascades[i].view.view.world_to_eye) *
                                glm::dvec4(about(mark, origin), 1);
        const glm::dvec2 texel = 0.5 * 2048 * glm::dvec2(clip.x + 1, clip.y + 1);
        if (!begun) first[i] = texel;
        for (int axis = 0; axis < 2; ++axis) {
          const double moved = texel[axis] - first[i][axis];
          ASSERT_NEAR(moved, std::round(moved), 0.02) << "cascade " << i << " step " << step;
        }
      }
      begun = true;
    }
  }
}

// A light's eye stands as far off as what the camera sees reaches.
TEST(ShadowViews, HoldWhatFarSightedAndFarOffCamerasSee) {
  Random random(11);
  for (const float far : {2e3f, 1.5e4f, 1e5f}) {
    for (const float away : {0.0f, 3e4f}) {
      for (int i = 0; i < 40; ++i) {
        Camera camera{.eye = {away + random.between(-200, 200), 2, away}, .far_plane = far};
        camera.forward = {random.between(-1, 1), random.between(-0.5f, 0.5f), random.between(-1, 1)};
        const WorldView view{*make_view(camera, 1920, 1080), {}};
        const Light sun{.direction = {random.between(-1, 1), -1, random.between(-1, 1)}};
        const Result<WorldView> shadow = shadow_view(sun, view, {}, 2048);
        ASSERT_TRUE(shadow) << far << ", " << away << ": " << shadow.error().message();
        const Vec3& f = camera.forward;
        const float along = 0.9f * far / std::hypot(f.x, f.y, f.z);
        EXPECT_TRUE(is_seen(*shadow, {camera.eye.x + along * camera.forward.x, 2 + along * camera.forward.y,
                                      camera.eye.z + along * camera.forward.z}));
        std::array<Cascade, 4> cascades;
        ASSERT_TRUE(split_cascades(sun, view, {}, cascades));
      }
    }
  }
}

TEST(ShadowViews, OfAPointLightAreTheFacesOfACube) {
  const Light lamp{.kind = LightKind::point, .position = {2e6, 5, 7}, .range = 30};
  Random random(3);
  std::array<WorldView, 6> faces;
  for (std::uint32_t face = 0; face < kPointFaces; ++face)
    faces[face] = *shadow_view(lamp, {}, {}, 256, face);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random.direction();
    const WorldPoint p{lamp.position.x + 20 * d.x, lamp.position.y + 20 * d.y, lamp.position.z + 20 * d.z};
    const auto axis = std::fabs(d.x) > std::fabs(d.y)   ? std::fabs(d.x) > std::fabs(d.z) ? 0u : 2u
                      : std::fabs(d.y) > std::fabs(d.z) ? 1u
                                                        : 2u;
    const float along = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
    for (std::uint32_t face = 0; face < kPointFaces; ++face)
      ASSERT_EQ(is_seen(faces[face], p), face == 2 * axis + (along < 0));
  }
}

StatusCode code_of(const Light& light, const WorldView& camera = {*make_view({}, 64, 64), {}},
                   const DepthRange& depths = {}, std::uint32_t pixels = 256, std::uint32_t face = 0) {
  return shadow_view(light, camera, depths, pixels, face).error().code();
}

TEST(ShadowViews, AreRefusedWhereNothingCanBeLit) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity(),
                  kNaN = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(code_of({}), StatusCode::ok);
  const std::array wrong{Light{.direction = {0, 0, 0}},
                         Light{.direction = {kInfinite, 0, 0}},
                         Light{.reach = -1},
                         Light{.reach = kNaN},
                         Light{.kind = LightKind::spot, .cone = 0},
                         Light{.kind = LightKind::spot, .cone = 3.2f},
                         Light{.kind = LightKind::point, .range = 0},
                         Light{.kind = LightKind::point, .range = kInfinite},
                         Light{.kind = LightKind::point, .near_plane = 0},
                         Light{.kind = static_cast<LightKind>(3)}};
  for (const Light& light : wrong) EXPECT_EQ(code_of(light), StatusCode::bad_argument);
  const WorldView endless{*make_view({.far_plane = kInfinite}, 64, 64), {}},
      sound{*make_view({}, 64, 64), {}};
  EXPECT_EQ(code_of({}, endless), StatusCode::bad_argument);
  EXPECT_EQ(code_of({}, endless, {1, 50}), StatusCode::ok);
  EXPECT_EQ(code_of({}, sound, {5, 5}), StatusCode::bad_argument);
  EXPECT_EQ(code_of({}, sound, {5000, 9000}), StatusCode::bad_argument);
  EXPECT_EQ(code_of({}, {View{{}, {}, 0, 0}, {}}), StatusCode::bad_view);
  EXPECT_EQ(code_of({}, sound, {}, 8), StatusCode::bad_view);
  EXPECT_EQ(code_of({}, sound, {}, 256, 1), StatusCode::bad_argument);
  EXPECT_EQ(code_of({.kind = LightKind::point}, sound, {}, 256, 6), StatusCode::bad_argument);
  EXPECT_EQ(code_of({.kind = LightKind::point, .position = {1e12, 0, 0}}), StatusCode::bad_view);
  std::array<Cascade, 2> two;
  EXPECT_EQ(split_cascades({.kind = LightKind::spot}, sound, {}, two).code(), StatusCode::bad_argument);
  EXPECT_EQ(split_cascades({}, sound, {.logarithmic = 2}, two).code(), StatusCode::bad_argument);
  EXPECT_EQ(split_cascades({}, sound, {}, {}).code(), StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
