#include <sightline/rays.hpp>

#include <gtest/gtest.h>

#include "support/random_views.hpp"

namespace sightline {
namespace {

constexpr Box kUnit{{0, 0, 0}, {1, 1, 1}};

TEST(Ray, MeetsABoxAtItsNearFace) {
  EXPECT_FLOAT_EQ(intersect({{-2, 0.5f, 0.5f}, {1, 0, 0}}, kUnit), 2);
  EXPECT_FLOAT_EQ(intersect({{-2, 0.5f, 0.5f}, {4, 0, 0}}, kUnit), 0.5f);
  EXPECT_FLOAT_EQ(intersect({{3, 0.5f, 0.5f}, {-1, 0, 0}}, kUnit), 2);
}

TEST(Ray, StartsInsideAtZero) {
  EXPECT_EQ(intersect({{0.5f, 0.5f, 0.5f}, {0, 1, 0}}, kUnit), 0);
}

TEST(Ray, MissesWhatIsBehindOrBesideOrTooFar) {
  EXPECT_EQ(intersect({{-2, 0.5f, 0.5f}, {-1, 0, 0}}, kUnit), -1);
  EXPECT_EQ(intersect({{-2, 1.5f, 0.5f}, {1, 0, 0}}, kUnit), -1);
  EXPECT_EQ(intersect({{-2, 0.5f, 0.5f}, {1, 0, 0}, 1.5f}, kUnit), -1);
}

TEST(Ray, AlongAFaceHitsIt) {
  EXPECT_FLOAT_EQ(intersect({{-2, 1, 0.5f}, {1, 0, 0}}, kUnit), 2);
  EXPECT_FLOAT_EQ(intersect({{-2, 0, 0}, {1, 0, 0}}, kUnit), 2);
  EXPECT_FLOAT_EQ(intersect({{0, -3, 1}, {0, 1, 0}}, kUnit), 3);
}

TEST(Ray, MeetsFlatBoxesAndPoints) {
  EXPECT_FLOAT_EQ(intersect({{0, 0, -5}, {0, 0, 1}}, {{-1, -1, 0}, {1, 1, 0}}), 5);
  EXPECT_FLOAT_EQ(intersect({{0, 0, -5}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 0}}), 5);
}

TEST(Ray, HitsEveryBoxItIsAimedAt) {
  scene::Random random(9);
  const Box around{{-50, -50, -50}, {50, 50, 50}};
  for (int i = 0; i < 20000; ++i) {
    Box box = test::random_box(random, around);
    for (float* high : {&box.max.x, &box.max.y, &box.max.z}) *high += 0.01f;
    const Vec3 from = random.inside(around);
    const Vec3 at{0.5f * (box.min.x + box.max.x), 0.5f * (box.min.y + box.max.y),
                  0.5f * (box.min.z + box.max.z)};
    const float t = intersect({from, {at.x - from.x, at.y - from.y, at.z - from.z}}, box);
    ASSERT_GE(t, 0);
    ASSERT_LE(t, 1);
  }
}

}  // namespace
}  // namespace sightline
