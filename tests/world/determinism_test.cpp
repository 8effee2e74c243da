// The same bits for any number of threads, any SIMD width, either depth direction, and anywhere.
#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <cmath>
#include <limits>

#include <sightline/world.hpp>

#include "support/cull.hpp"
#include "support/run_threads.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;

std::uint64_t hash_of(std::uint64_t h, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) h = (h ^ byte) * 0x100000001b3u;
  return h;
}

// Multiples of 1/256 m, so that shifting by 10⁷ m is exact in a double.
double coarse(float x) {
  return std::floor(static_cast<double>(x) * 256) / 256;
}

struct Setting {
  std::uint32_t threads = 1;
  Depth depth = Depth::standard;
  double shift = 0;
  float far_plane = 3000, near_plane = 0.1f;
};

// Inserts, moves, removes and culls; the hash of all that was written.
std::uint64_t hash_of_run(const Setting& run) {
  Random random(11);
  const auto box = [&] {
    const Vec3 at = random.inside({{-2500, -100, -2500}, {2500, 100, 2500}});
    const double x = coarse(at.x) + run.shift, y = coarse(at.y), z = coarse(at.z) - run.shift;
    const double w = coarse(random.between(0.1f, 9)), h = coarse(random.between(0.1f, 9));
    return WorldBox{{x - w, y - h, z - w}, {x + w, y + h, z + w}};
  };
  World world;
  std::vector<WorldBox> boxes(20000);
  std::vector<Handle> handles(boxes.size());
  for (WorldBox& b : boxes) b = box();
  EXPECT_TRUE(world.insert(boxes, handles));
  std::vector<WorldBox> movers(boxes.end() - 2000, boxes.end());
  const CullOptions options{.jobs = {test::run_threads, nullptr, run.threads}};
  Culler culler;
  std::uint64_t h = 0xcbf29ce484222325u;
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<Handle> some(handles.begin() + frame * 500, handles.begin() + frame * 500 + 1000);
    for (std::size_t i = 0; i < some.size(); ++i) boxes[i] = box();
    EXPECT_TRUE(world.move(some, std::span(boxes).first(some.size())));
    // Others move a little, frame after frame.
    for (std::size_t i = 0; i < movers.size(); ++i) {
      const double by = coarse(random.between(-1, 1));
      movers[i].min.x += by, movers[i].max.x += by;
    }
    EXPECT_TRUE(world.move(std::span(handles).last(movers.size()), movers));
    std::vector<WorldView> views;
    for (int v = 0; v < 1 + frame % 3; ++v) {
      Camera camera;
      camera.eye = {static_cast<float>(coarse(random.between(-900, 900))), 2,
                    static_cast<float>(coarse(random.between(-900, 900)))};
      camera.forward = random.direction();
      camera.forward.y *= 0.2f;
      camera.far_plane = run.far_plane, camera.near_plane = run.near_plane;
      camera.depth = run.depth;
      views.push_back({*make_view(camera, 1280, 720), {run.shift, 0, -run.shift}});
    }
    std::vector<ObjectId> visible(cull_capacity(world, options));
    std::vector<std::uint8_t> masks(visible.size());
    const CullResult result = test::cull(culler, world, test::cull_views(views), visible,
                                         frame % 2 ? std::span(masks) : std::span<std::uint8_t>(), options);
    EXPECT_GT(result.count, 100u);
    h = hash_of(h, {reinterpret_cast<const std::uint8_t*>(visible.data()), result.count * sizeof(ObjectId)});
    if (frame % 2) h = hash_of(h, {masks.data(), result.count});
  }
  return h;
}

TEST(Determinism, SameBitsForThreadsTargetsDepthAndPlace) {
  const std::uint64_t expected = hash_of_run({});
  for (const std::uint32_t threads : {2u, 3u, 8u, 64u}) {
    EXPECT_EQ(hash_of_run({.threads = threads}), expected) << threads << " threads";
  }
  EXPECT_EQ(hash_of_run({.shift = 1e7}), expected);
  EXPECT_EQ(hash_of_run({.threads = 2, .shift = -1e7}), expected);
  // A float matrix rounds a far plane of 3,000 m by metres, and standard depth's by more than reversed
  // depth's; without one both matrices say the same frustum.
  const float none = std::numeric_limits<float>::infinity();
  const std::uint64_t endless = hash_of_run({.far_plane = none});
  EXPECT_NE(endless, expected);
  EXPECT_EQ(hash_of_run({.depth = Depth::reversed, .far_plane = none}), endless);
  EXPECT_EQ(hash_of_run({.depth = Depth::reversed, .shift = 1e7, .far_plane = none}), endless);
  // With far = near · (2^k + 1) both matrices hold a finite far plane without rounding.
  const Setting exact{.far_plane = 2050, .near_plane = 2};
  Setting reversed = exact;
  reversed.depth = Depth::reversed;
  EXPECT_EQ(hash_of_run(reversed), hash_of_run(exact));
  reversed.shift = 1e7, reversed.threads = 8;
  EXPECT_EQ(hash_of_run(reversed), hash_of_run(exact));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_EQ(hash_of_run({}), expected) << hwy::TargetName(target);
    EXPECT_EQ(hash_of_run({.threads = 2}), expected) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Where rounding does tell the matrices apart, it does so at the far plane alone.
TEST(Determinism, StandardAndReversedDepthDifferAtMostAboutAFarPlaneThatMatricesRound) {
  Random random(12);
  World world;
  std::vector<WorldBox> boxes(20000);
  std::vector<Handle> handles(boxes.size());
  for (WorldBox& b : boxes) {
    const Vec3 at = random.inside({{-4000, -100, -4000}, {4000, 100, 4000}});
    b = {{at.x - 2.0, at.y - 2.0, at.z - 2.0}, {at.x + 2.0, at.y + 2.0, at.z + 2.0}};
  }
  ASSERT_TRUE(world.insert(boxes, handles));
  std::size_t seen = 0;
  for (int round = 0; round < 50; ++round) {
    Camera camera{.eye = random.inside({{-900, 1, -900}, {900, 9, 900}}), .forward = random.direction()};
    camera.forward.y *= 0.1f;
    camera.far_plane = 3000;
    std::array<std::vector<std::uint8_t>, 2> in{std::vector<std::uint8_t>(world.id_limit()),
                                                std::vector<std::uint8_t>(world.id_limit())};
    for (const Depth depth : {Depth::standard, Depth::reversed}) {
      camera.depth = depth;
      const WorldView view{*make_view(camera, 1280, 720), {}};
      std::vector<ObjectId> visible(cull_capacity(world));
      visible.resize(test::cull(world, view, visible).count);
      for (const ObjectId id : visible) in[depth == Depth::reversed][id] = 1;
    }
    const Vec3 forward = view_direction(*make_view(camera, 1280, 720));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const ObjectId id = handles[i].index;
      seen += in[0][id];
      if (in[0][id] == in[1][id]) continue;
      const WorldPoint& p = boxes[i].min;
      const double depth = (p.x + 2 - camera.eye.x) * forward.x + (p.y + 2 - camera.eye.y) * forward.y +
                           (p.z + 2 - camera.eye.z) * forward.z;
      ASSERT_NEAR(depth, 3000, 10);
    }
  }
  EXPECT_GT(seen, 10000u);
}

}  // namespace
}  // namespace sightline
