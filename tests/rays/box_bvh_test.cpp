#include <sightline/rays.hpp>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/random_views.hpp"
#include "support/run_threads.hpp"

namespace sightline {
namespace {

using scene::Random;

std::vector<Box> random_boxes(Random& random, std::size_t count) {
  std::vector<Box> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(test::random_box(random, test::kAround));
  return out;
}

// What testing every box says: the nearest, of equally near ones the lowest.
std::pair<ObjectId, float> nearest(const std::vector<Box>& boxes, const Ray& ray) {
  std::pair<ObjectId, float> out{kNoObject, -1};
  for (ObjectId i = 0; i < boxes.size(); ++i) {
    const float at = intersect(ray, boxes[i]);
    if (at >= 0 && (out.first == kNoObject || at < out.second)) out = {i, at};
  }
  return out;
}

TEST(BoxBvh, MeetsWhatTestingEveryBoxMeets) {
  Random random(1);
  std::vector<Box> boxes = random_boxes(random, 400);
  BoxBvh bvh;
  ASSERT_TRUE(bvh.build(boxes));
  for (int round = 0; round < 2; ++round) {
    std::vector<Ray> rays;
    for (int i = 0; i < 3000; ++i) rays.push_back({random.inside(test::kAround), random.direction()});
    rays[7].direction = {0, 0, 0}, rays[8].origin.x = std::nanf(""), rays[9].max_distance = -1;
    std::vector<ObjectId> objects(rays.size()), again(rays.size());
    std::vector<float> distances(rays.size());
    ASSERT_TRUE(bvh.cast(rays, objects, distances));
    ASSERT_TRUE(bvh.cast(rays, again, {}, {test::run_threads, nullptr, 4}));
    EXPECT_EQ(objects, again);
    int hits = 0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const bool sound = r < 7 || r > 9;
      const auto expected = sound ? nearest(boxes, rays[r]) : std::pair<ObjectId, float>{kNoObject, -1};
      ASSERT_EQ(objects[r], expected.first) << r;
      ASSERT_EQ(distances[r], expected.second) << r;
      hits += expected.first != kNoObject;
    }
    EXPECT_GT(hits, 1000);
    boxes = random_boxes(random, 400);
    ASSERT_TRUE(bvh.refit(boxes));
  }
}

// Neighbours go down the tree together: from one point and from near ones, into one octant and over its
// borders, along axes, so that rays part from their packet at once, later and never.
TEST(BoxBvh, MeetsTheSameWithNeighboursTogetherForEverySimdTarget) {
  Random random(5);
  const std::vector<Box> boxes = random_boxes(random, 600);
  std::vector<Ray> rays;
  for (int bundle = 0; bundle < 250; ++bundle) {
    const Vec3 from = random.inside(test::kAround), way = bundle % 5 ? random.direction() : Vec3{0, 0, 1};
    const float spread = bundle % 3 ? 0.02f : 0.4f, apart = bundle % 2 ? 2.0f : 0.0f;
    const auto about = [&](float at, float most) { return at + random.between(-1, 1) * most; };
    for (int i = 0; i < 16; ++i) {
      rays.push_back({{about(from.x, apart), about(from.y, apart), about(from.z, apart)},
                      {about(way.x, spread), about(way.y, spread), about(way.z, spread)}});
      if (i == bundle % 17) rays.back().direction.x = 0;
      if (i == bundle % 19) rays.back().max_distance = 50;
      if (i == bundle % 64) rays.back().origin.y = std::nanf("");
    }
  }
  rays.resize(rays.size() - 3);  // the last packet is not full
  std::vector<std::pair<ObjectId, float>> expected;
  for (const Ray& ray : rays)
    expected.push_back(std::isnan(ray.origin.y) ? std::pair{kNoObject, -1.0f} : nearest(boxes, ray));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    BoxBvh bvh;
    ASSERT_TRUE(bvh.build(boxes));
    std::vector<ObjectId> objects(rays.size());
    std::vector<float> distances(rays.size());
    ASSERT_TRUE(bvh.cast(rays, objects, distances));
    std::size_t hits = 0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
      ASSERT_EQ(objects[r], expected[r].first) << hwy::TargetName(target) << ", ray " << r;
      ASSERT_EQ(distances[r], expected[r].second) << hwy::TargetName(target) << ", ray " << r;
      hits += objects[r] != kNoObject;
    }
    EXPECT_GT(hits, rays.size() / 4);
    EXPECT_LT(hits, rays.size());
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(BoxBvh, FindsASetThatAViewSees) {
  Random random(2);
  std::vector<Box> boxes;
  for (int i = 0; i < 300; ++i) {
    const Vec3 at = random.inside({{-100, -60, -300}, {100, 60, 200}});
    boxes.push_back({{at.x - 3, at.y - 3, at.z - 3}, {at.x + 3, at.y + 3, at.z + 3}});
  }
  BoxBvh bvh;
  ASSERT_TRUE(bvh.build(boxes));
  const WorldView view{*make_view(Camera{.eye = {0, 0, 290}}, 320, 200), {}};
  std::vector<ObjectId> visible(300), few(300);
  const auto seen = bvh.visible_set(view, 160, 100, visible), less = bvh.visible_set(view, 8, 5, few);
  ASSERT_TRUE(seen && less);
  EXPECT_TRUE(std::is_sorted(visible.begin(), visible.begin() + static_cast<std::ptrdiff_t>(*seen)));
  EXPECT_GT(*seen, *less);
  EXPECT_LT(*seen, 300u);
  EXPECT_GT(*less, 3u);
}

TEST(BoxBvh, TakesNoOriginOutOfReach) {
  BoxBvh bvh;
  const std::vector<Box> boxes{{{-1, -1, -1}, {1, 1, 1}}};
  ASSERT_TRUE(bvh.build(boxes));
  for (const double bad : {double{NAN}, double{INFINITY}, -double{INFINITY}, 1e15, -1e300, 1.001e11}) {
    for (const WorldPoint& origin : {WorldPoint{bad, 0, 0}, WorldPoint{0, bad, 0}, WorldPoint{0, 0, bad}})
      EXPECT_EQ(bvh.build(boxes, origin).code(), StatusCode::bad_argument) << bad;
  }
  std::array<ObjectId, 1> met{};
  ASSERT_TRUE(bvh.cast(std::array{Ray{{0, 0, 9}, {0, 0, -1}}}, met));
  EXPECT_EQ(met[0], 0u) << "it is as it was";
  const WorldPoint far{-kWorldReach, 0, kWorldReach};
  ASSERT_TRUE(bvh.build(std::array{WorldBox{far, far}}, far));
  ASSERT_TRUE(bvh.cast(std::array{Ray{{0, 0, 9}, {0, 0, -1}}}, met));
  EXPECT_EQ(met[0], 0u) << "at the border of what is in reach";
}

TEST(BoxBvh, RefusesWhatIsWrongAndStaysAsItWas) {
  Random random(3);
  std::vector<Box> boxes = random_boxes(random, 20);
  BoxBvh bvh;
  ASSERT_TRUE(bvh.build(boxes));
  const Ray ray{{0, 0, 400}, {0, 0, -1}};
  const std::array rays{ray, ray};
  std::array<ObjectId, 2> before{}, after{};
  ASSERT_TRUE(bvh.cast(rays, before));
  EXPECT_EQ(bvh.refit(std::span(boxes).first(19)).code(), StatusCode::bad_argument);
  boxes[11].min.y = std::nanf("");
  EXPECT_EQ(bvh.refit(boxes).index(), 11u);
  EXPECT_EQ(bvh.build(boxes).code(), StatusCode::bad_box);
  const float* none = nullptr;
  EXPECT_EQ(bvh.build(BoxView::min_max(none, 24, 5)).code(), StatusCode::bad_argument);
  EXPECT_EQ(bvh.size(), 20u);
  EXPECT_EQ(bvh.cast(rays, std::span(after).first(1)).code(), StatusCode::buffer_too_small);
  std::array<float, 1> distance;
  EXPECT_EQ(bvh.cast(rays, after, distance).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(bvh.cast(rays, after, {}, {test::run_threads, nullptr, 100}).code(), StatusCode::bad_argument);
  ASSERT_TRUE(bvh.cast(rays, after));
  EXPECT_EQ(before, after);
  const WorldView view{*make_view(Camera{}, 64, 64), {}}, elsewhere{view.view, {1, 0, 0}};
  std::vector<ObjectId> visible(20);
  EXPECT_EQ(bvh.visible_set(view, 0, 5, visible).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(bvh.visible_set(view, 100000, 100000, visible).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(bvh.visible_set(elsewhere, 5, 5, visible).error().code(), StatusCode::bad_view);
  EXPECT_EQ(bvh.visible_set(view, 5, 5, std::span(visible).first(9)).error().code(),
            StatusCode::buffer_too_small);
}

}  // namespace
}  // namespace sightline
