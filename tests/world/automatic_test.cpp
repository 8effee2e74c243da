// Occlusion in one call: what is left out is hidden, and it is never slower in counted work.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>

#include <sightline/rays.hpp>
#include <sightline/shadows.hpp>
#include <sightline/world.hpp>

#include "support/solid_boxes.hpp"
#include "support/streets_and_rooms.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using namespace test;

// What the promise says of frames: each, every 64 in a row, and all.
class Promise {
public:
  void frame(const CullResult& result) {
    cost_ += result.cost, frustum_ += result.frustum_cost;
    EXPECT_LE(cost_, 1.02 * frustum_);
    EXPECT_LE(result.cost, 1.05 * result.frustum_cost);
    last_.emplace_back(result.cost, result.frustum_cost);
    if (last_.size() > 64) last_.pop_front();
    double cost = 0, frustum = 0;
    for (const auto& [c, f] : last_) cost += c, frustum += f;
    EXPECT_LE(cost, 1.05 * frustum);
  }
  [[nodiscard]] double ratio() const { return cost_ / frustum_; }

private:
  std::deque<std::pair<double, double>> last_;
  double cost_ = 0, frustum_ = 0;
};

// Things that hide nothing from one another.
std::vector<Box> field(std::uint32_t seed, int things) {
  Random random(seed);
  std::vector<Box> out;
  for (int i = 0; i < things; ++i)
    out.push_back(box_at({random.between(-400, 400), 0, random.between(-400, 400)}, {0.2f, 0.05f, 0.2f}));
  return out;
}

// What the costs say of a cull by frustum.
double counted(const CullResult& result, std::uint64_t drawn, const CullCosts& costs) {
  return static_cast<double>(result.nodes_visited) * double{costs.node} +
         static_cast<double>(result.tested) * double{costs.test} +
         static_cast<double>(drawn) * double{costs.object};
}

TEST(AutomaticOcclusion, IsNeverSlowerInCountedWorkWhateverTheSceneDoes) {
  SolidBoxes streets(town(1, 16));
  SolidBoxes open(field(2, 5000));
  Random random(3);
  for (const float object : {0.5f, 20.0f, 300.0f, 5000.0f}) {
    const CullOptions options = automatic(object);
    for (int kind = 0; kind < 5; ++kind) {
      Culler culler, plain;
      Promise promise;
      std::size_t dropped = 0;
      for (int frame = 0; frame < 300; ++frame) {
        const float t = static_cast<float>(frame);
        // A walk through the streets; an open field; both in turns of many lengths; a view that jumps; one
        // that looks at the sky half of the time.
        const bool in_field = kind == 1 || (kind == 2 && (frame / (1 + frame / 40)) % 2 == 1);
        Vec3 eye{20, 1.7f, 600 - t}, forward = heading(0.01f * t);
        if (kind == 3) eye = {random.between(0, 600), 2, random.between(0, 600)}, forward = heading(t);
        if (kind == 4 && frame % 2 == 1) forward = {0, 1, 0.01f};
        const SolidBoxes& scene = in_field ? open : streets;
        const CullView view{.view = {looking(in_field ? Vec3{0, 30, 0} : eye, forward), {}}};
        const Culled seen = cull_with(culler, scene.world, {&view, 1}, options);
        const Culled frustum = cull_with(plain, scene.world, {&view, 1}, {});
        ASSERT_EQ(seen.result.frustum_cost, counted(frustum.result, frustum.result.count, options.costs));
        ASSERT_LE(seen.result.count, frustum.result.count);
        ASSERT_GE(seen.result.cost, static_cast<double>(seen.result.count) * double{object});
        ASSERT_EQ(seen.result.culled_occlusion, frustum.result.count - seen.result.count);
        promise.frame(seen.result);
        dropped += frustum.result.count - seen.result.count;
        if (HasFailure()) return;
      }
      if (kind == 0 && object >= 300) {
        EXPECT_LT(promise.ratio(), 0.5);
      }
      if (kind == 1) {
        EXPECT_LT(dropped, 300u);
      }
    }
  }
}

TEST(AutomaticOcclusion, BeginsNoTryThatItCannotAfford) {
  SolidBoxes streets(town(1, 8));
  Culler culler;
  const CullView view{.view = {looking({20, 1.7f, 300}, {0, 0, -1}, 1280, 720), {}}};
  for (int frame = 0; frame < 40; ++frame) {
    const Culled seen = cull_with(culler, streets.world, {&view, 1}, automatic(1));
    EXPECT_EQ(seen.result.cost, seen.result.frustum_cost);
    EXPECT_EQ(seen.result.culled_occlusion, 0u);
  }
}

// Blocks and streets, from block `begin` to block `end` along x.
std::vector<Box> blocks(int begin, int end) {
  std::vector<Box> out;
  for (int x = begin; x < end; ++x)
    for (int z = -30; z < 30; ++z)
      out.push_back({{50.0f * static_cast<float>(x), 0, 50.0f * static_cast<float>(z)},
                     {50.0f * static_cast<float>(x) + 30, 20, 50.0f * static_cast<float>(z) + 30}});
  return out;
}

// A street of blocks at an image so large that to empty a buffer as fine takes more than a first try may.
TEST(AutomaticOcclusion, BeginsCoarselyWhereItCannotAffordMore) {
  SolidBoxes streets(blocks(-20, 40));
  for (const std::uint32_t width : {320u, 1280u, 3840u}) {
    const CullView view{
        .view = {*make_view({.eye = {45, 1.7f, -10}, .forward = {1, 0, 0.1f}}, width, width * 9 / 16), {}}};
    Culler culler, plain;
    const std::size_t in_view = cull_with(plain, streets.world, {&view, 1}, {}).result.count;
    Promise promise;
    CullResult last;
    for (int frame = 0; frame < 40; ++frame) {
      last = cull_with(culler, streets.world, {&view, 1}, kAutomatic).result;
      promise.frame(last);
    }
    EXPECT_GT(in_view, 400u);
    EXPECT_LT(last.count, in_view / 4) << width;
  }
}

// The camera's view and a sun's cascades in one call, as engines have them. Of the cascades next to nothing
// can be hidden: what they may spend must not be missing where it pays.
TEST(AutomaticOcclusion, SpendsOnTheViewsThatItPaysFor) {
  SolidBoxes streets(blocks(-30, 30));
  const WorldView camera{
      *make_view({.eye = {45, 1.7f, -10}, .forward = {1, 0, 0.1f}, .far_plane = 1500}, 1920, 1080), {}};
  std::array<Cascade, 3> cascades;
  const Light sun{.direction = {1, -1.5f, 0.4f}, .reach = 100};
  ASSERT_TRUE(split_cascades(sun, camera, {.depths = {-INFINITY, 400}}, cascades));
  std::array<ShadowCasters, 3> casters;
  std::vector<CullView> views{{.view = camera}};
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(casters[i].begin(cascades[i].view, camera, cascades[i].depths));
    views.push_back({.view = cascades[i].view, .distance_view = 0, .casters = &casters[i]});
  }
  const auto of_camera = [](const Culled& culled) {
    return std::ranges::count_if(culled.masks, [](std::uint8_t mask) { return (mask & 1) != 0; });
  };
  Culler culler, plain;
  const auto in_view = of_camera(cull_with(plain, streets.world, views, {}, true));
  Promise promise;
  Culled last;
  for (int frame = 0; frame < 100; ++frame) {
    last = cull_with(culler, streets.world, views, kAutomatic, true);
    promise.frame(last.result);
  }
  EXPECT_GT(in_view, 700);
  EXPECT_LT(of_camera(last), in_view / 8);
  EXPECT_LT(promise.ratio(), 0.4);
}

// Two eyes with large images: a buffer so fine that few occluders can be afforded in it hides less than a
// coarse one with many.
TEST(AutomaticOcclusion, LeavesMoreForOccludersThanForEmptyingTheirBuffer) {
  SolidBoxes streets(blocks(-30, 30));
  std::vector<CullView> eyes;
  for (const float z : {-10.03f, -9.97f}) {
    const Camera camera{.eye = {45, 1.7f, z}, .forward = {1, 0, 0.1f}, .far_plane = 1500};
    eyes.push_back({.view = {*make_view(camera, 2064, 2208), {}}});
  }
  Culler culler;
  Promise promise;
  for (int frame = 0; frame < 60; ++frame)
    promise.frame(cull_with(culler, streets.world, eyes, automatic(5000), true).result);
  EXPECT_LT(promise.ratio(), 0.2);
}

// A chunk that the view crosses has many objects that the frustum leaves out already: to ask for them, too,
// would cost more than this frame may be spent on.
TEST(AutomaticOcclusion, AsksForNoneThatTheFrustumLeavesOut) {
  SolidBoxes row([] {
    std::vector<Box> boxes;
    for (int i = 0; i < 960; ++i)
      boxes.push_back(box_at({0.4f * static_cast<float>(i - 480), 0, -100}, {0.1f, 0.5f, 0.1f}));
    boxes.push_back(box_at({-5, 0, -50}, {7, 10, 0.5f}));  // before three quarters of the view
    return boxes;
  }());
  const CullView view{.view = {*make_view({.eye = {0, 0, 0}, .vertical_fov = 0.2f}, 64, 64), {}}};
  Culler culler, plain;
  const std::size_t in_view = cull_with(plain, row.world, {&view, 1}, {}).result.count;
  Promise promise;
  CullResult last;
  for (int frame = 0; frame < 8; ++frame) {
    last = cull_with(culler, row.world, {&view, 1}, automatic(850)).result;
    promise.frame(last);
  }
  EXPECT_GT(in_view, 40u);
  EXPECT_LT(last.count, in_view / 2);
}

// Who is seen at a pixel centre of a world of solid boxes: what a ray meets first. Rays that begin inside a
// box meet it there, as the near plane cuts it.
std::vector<std::uint8_t> truly_seen(const std::vector<Box>& boxes, const View& view) {
  BoxBvh bvh;
  EXPECT_TRUE(bvh.build(BoxView(boxes)));
  std::vector<ObjectId> ids(boxes.size());
  // An uneven number of rays a pixel: one goes through its centre.
  const auto count = bvh.visible_set({view, {}}, view.width, view.height, ids);
  EXPECT_TRUE(count);
  std::vector<std::uint8_t> seen(boxes.size(), 0);
  for (std::size_t i = 0; i < *count; ++i) seen[ids[i]] = 1;
  return seen;
}

TEST(AutomaticOcclusion, LosesNothingThatARayThroughAPixelMeets) {
  Random random(11);
  std::size_t kept = 0, in_view = 0, lost = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    std::vector<Box> boxes = town(seed, 10);
    for (int i = 0; i < 600; ++i)
      boxes.push_back(box_at({random.between(-50, 400), random.between(0, 40), random.between(-50, 400)},
                             {random.between(0.1f, 4), random.between(0.1f, 4), random.between(0.1f, 4)}));
    const SolidBoxes scene(std::move(boxes));
    Culler culler, plain;
    for (int frame = 0; frame < 60; ++frame) {
      const Vec3 eye{random.between(-20, 380), random.between(0.3f, 30), random.between(-20, 380)};
      const auto inside = [&](const Box& b) {
        const float reach = 0.2f;
        return eye.x > b.min.x - reach && eye.x < b.max.x + reach && eye.y > b.min.y - reach &&
               eye.y < b.max.y + reach && eye.z > b.min.z - reach && eye.z < b.max.z + reach;
      };
      if (std::any_of(scene.boxes.begin(), scene.boxes.end(), inside)) continue;
      const CullView view{.view = {looking(eye, random.direction(), 96, 64), {}}};
      // Twice the same: the second time with what was learned.
      for (int again = 0; again < 2; ++again) {
        const Culled seen = cull_with(culler, scene.world, {&view, 1}, automatic(20000));
        const std::vector<std::uint8_t> truth = truly_seen(scene.boxes, view.view.view);
        std::vector<std::uint8_t> left(scene.boxes.size(), 0);
        for (const ObjectId id : seen.ids) left[id] = 1;
        for (std::size_t i = 0; i < truth.size(); ++i) lost += truth[i] && !left[i];
        kept += seen.result.count;
        in_view += cull_with(plain, scene.world, {&view, 1}, {}).result.count;
      }
    }
  }
  EXPECT_EQ(lost, 0u);
  EXPECT_LT(3 * kept, 2 * in_view);
}

TEST(AutomaticOcclusion, KeepsItsPromiseForSeveralViewsWithMasksAndWithout) {
  const SolidBoxes scene(town(6, 12));
  for (const bool masks : {false, true}) {
    Culler culler, plain;
    Promise promise;
    const CullOptions options = automatic(2000);
    for (int frame = 0; frame < 120; ++frame) {
      const float t = static_cast<float>(frame);
      const std::array views{CullView{.view = {looking({20, 2, 450 - t}, heading(0.03f * t)), {}}},
                             CullView{.view = {looking({20, 2, 450 - t}, heading(0.03f * t + 1)), {}}}};
      const Culled seen = cull_with(culler, scene.world, views, options, masks);
      const Culled frustum = cull_with(plain, scene.world, views, {}, masks);
      std::uint64_t drawn = frustum.result.count;
      if (masks) drawn = 0;
      for (const std::uint8_t mask : frustum.masks) drawn += static_cast<std::uint64_t>(std::popcount(mask));
      ASSERT_EQ(seen.result.frustum_cost, counted(frustum.result, drawn, options.costs));
      promise.frame(seen.result);
      // Each view by itself, by a culler that has as much to spend, sees nothing that is not there.
      for (std::size_t i = 0; i < seen.ids.size() && masks; ++i) ASSERT_NE(seen.masks[i], 0);
    }
    EXPECT_LT(promise.ratio(), masks ? 0.7 : 0.8);
  }
}

TEST(AutomaticOcclusion, LearnsWhatAnObjectCosts) {
  const SolidBoxes scene(town(1, 16));
  Culler culler;
  Random random(9);
  CullResult last;
  for (int frame = 0; frame < 60; ++frame) {
    const CullView view{
        .view = {looking({20, 1.7f, random.between(0, 600)}, heading(random.between(0, 6))), {}}};
    last = cull_with(culler, scene.world, {&view, 1}, kAutomatic).result;
    // 2 ms whatever is drawn, and 30 µs an object.
    ASSERT_TRUE(culler.report_frame_time(2e6 + 30000.0 * static_cast<double>(last.count)));
  }
  const CullView view{.view = {looking({20, 1.7f, 600}, heading(0)), {}}};
  Culler plain;
  const Culled frustum = cull_with(plain, scene.world, {&view, 1}, {});
  last = cull_with(culler, scene.world, {&view, 1}, kAutomatic).result;
  EXPECT_NEAR(last.frustum_cost / counted(frustum.result, frustum.result.count, automatic(30000).costs), 1,
              1e-3);
  EXPECT_EQ(culler.report_frame_time(-1).code(), StatusCode::bad_argument);
  // Seconds and milliseconds of a frame are no nanoseconds.
  for (const double time : {double{NAN}, double{INFINITY}, 1e16, 1e45, 0.0, 0.016, 16.0})
    EXPECT_EQ(culler.report_frame_time(time).code(), StatusCode::bad_argument) << time;
}

}  // namespace
}  // namespace sightline
