// The invariant of paper B: every method gives the same hit for the same ray, to the id and to the bit.
#include "workbench/methods/ray_pvs/nearest_box.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include <sightline/workbench/io.hpp>
#include <sightline/workbench/worlds.hpp>

#include "library/rays/ray_grid.hpp"
#include "library/rays/wide_rays.hpp"
#include "support/nasty_boxes.hpp"
#include "support/run_threads.hpp"

namespace sightline::methods {
namespace {

struct Trees {
  rays::Bvh bvh;
  rays::WideBvh wide;

  explicit Trees(const Boxes& boxes) { bvh.build(boxes), wide.build(boxes); }
};

void expect_equal(const rays::RayHits& found, const rays::RayHits& expected, const char* method,
                  const std::string& where) {
  ASSERT_EQ(found.object.size(), expected.object.size()) << method;
  for (std::size_t r = 0; r < expected.object.size(); ++r) {
    ASSERT_EQ(found.object[r], expected.object[r]) << method << ", " << where << ", ray " << r;
    ASSERT_EQ(found.distance[r], expected.distance[r]) << method << ", " << where << ", ray " << r;
  }
  EXPECT_EQ(found.stats.rays, expected.stats.rays) << method;
  EXPECT_EQ(found.stats.hits, expected.stats.hits) << method;
}

// Returns the number of hits.
std::uint64_t compare_all(const Boxes& boxes, const Trees& trees, std::span<const PreparedRay> rays,
                          const std::string& where) {
  rays::RayHits expected, found;
  cast_at_all_boxes(boxes, rays, expected);
  cast_down_bvh(trees.bvh, rays, found);
  expect_equal(found, expected, "boca", where);
  cast_by_skip_counts(trees.bvh.nodes(), rays, found);
  expect_equal(found, expected, "saa", where);
  Candidates candidates;
  collect_candidates(trees.bvh, rays, candidates);
  cast_at_candidates(boxes, candidates, rays, found);
  expect_equal(found, expected, "bvha", where);
  rays::WideStack stack;
  found.reset(rays.size()), found.stats = {};
  rays::cast_wide(trees.wide, rays, {}, found.object, found.distance, stack, found.stats);
  expect_equal(found, expected, "wide-rays", where);
  std::vector<std::uint32_t> backwards(rays.size());
  std::iota(backwards.rbegin(), backwards.rend(), 0u);
  found.reset(rays.size()), found.stats = {};
  rays::cast_wide(trees.wide, rays, backwards, found.object, found.distance, stack, found.stats);
  expect_equal(found, expected, "wide-rays backwards", where);
  return expected.stats.hits;
}

TEST(NearestBox, IsTheSameForEveryMethodOnNastyScenes) {
  scene::Random random(31);
  std::uint64_t hits = 0, rays = 0;
  for (int round = 0; round < 200; ++round) {
    const Boxes boxes = test::nasty_boxes(random, 1 + random.below(300));
    const Trees trees(boxes);
    const std::vector<PreparedRay> nasty = test::nasty_rays(random, boxes, 500);
    hits += compare_all(boxes, trees, nasty, "scene " + std::to_string(round));
    rays += nasty.size();
    // Many boxes a ray: rays by turns instead of packets.
    compare_all(boxes, trees, std::span(nasty).first(13), "few rays at scene " + std::to_string(round));
    rays::RayGrid grid;
    grid.make(test::random_view(random, {{-12, -12, -12}, {12, 12, 12}}), 20, 15);
    hits += compare_all(boxes, trees, grid.prepared, "view of scene " + std::to_string(round));
    rays += grid.size();
  }
  EXPECT_GT(hits, rays / 4);
  EXPECT_LT(hits, rays * 9 / 10);
}

TEST(NearestBox, IsTheSameForEveryMethodOnTheFiveModels) {
  for (int model = 1; model <= 5; ++model) {
    const Scene scene = generate_world("strata?triangles=20000&model=" + std::to_string(model));
    const Trees trees(scene.bounds);
    const View view = *make_view(
        {.eye = scene.viewpoints[1].eye, .forward = scene.viewpoints[1].forward, .far_plane = 1e5f}, 1280,
        720);
    rays::RayGrid grid;
    grid.make(view, 100, 100);
    EXPECT_GT(compare_all(scene.bounds, trees, grid.prepared, scene.name), 1000u);
  }
}

TEST(NearestBox, IsTheSameForEveryMethodOnTheIrregularWorldAlsoAlongAxes) {
  const Scene scene = generate_world("irregular?detail=0");
  const Trees trees(scene.bounds);
  rays::RayGrid grid;
  for (const Viewpoint& from : scene.viewpoints) {
    grid.make(*make_view({.eye = from.eye, .forward = from.forward}, 1280, 720), 100, 100);
    EXPECT_GT(compare_all(scene.bounds, trees, grid.prepared, from.name), 300u);
  }
  const Camera above{.eye = {0, 100, 0},
                     .forward = {0, -1, 0},
                     .up = {1, 0, 0},
                     .orthographic_height = 200,
                     .near_plane = 1,
                     .far_plane = 200};
  grid.make(*make_view(above, 1000, 1000), 100, 100);
  EXPECT_GT(compare_all(scene.bounds, trees, grid.prepared, "orthographic"), 1000u);
}

TEST(NearestBox, IsTheSameForEveryMethodInAGameLevel) {
  if (!std::filesystem::exists("/usr/share/games/openarena/baseoa/pak1-maps.pk3")) {
    GTEST_SKIP() << "openarena-081-maps is not installed";
  }
  const Scene scene = load_scene("pak1-maps.pk3:maps/oa_dm1.bsp");
  const Trees trees(scene.bounds);
  rays::RayGrid grid;
  for (const Viewpoint& from : scene.viewpoints) {
    grid.make(*make_view({.eye = from.eye, .forward = from.forward}, 1280, 720), 40, 40);
    EXPECT_GT(compare_all(scene.bounds, trees, grid.prepared, from.name), 800u);
  }
}

TEST(NearestBox, OfAGridIsTheSameTileByTile) {
  const Scene scene = generate_world("strata?triangles=20000");
  const Trees trees(scene.bounds);
  rays::RayGrid grid;
  grid.make(
      *make_view({.eye = scene.viewpoints[0].eye, .forward = scene.viewpoints[0].forward, .far_plane = 1e5f},
                 640, 480),
      53, 31);
  rays::RayHits expected, found;
  cast_at_all_boxes(scene.bounds, grid.prepared, expected);
  rays::WideStack stack;
  rays::cast_wide(trees.wide, grid, stack, found);
  expect_equal(found, expected, "wide-rays", "grid");
}

TEST(NearestBox, OfAGridIsTheSameForAnyNumberOfThreads) {
  const Scene scene = generate_world("strata?triangles=20000&model=3");
  const Trees trees(scene.bounds);
  rays::RayGrid grid;
  const View view = *make_view(
      {.eye = scene.viewpoints[1].eye, .forward = scene.viewpoints[1].forward, .far_plane = 1e5f}, 640, 480);
  for (const std::uint32_t side : {3u, 31u, 32u, 133u}) {  // fewer rays than a piece, one piece, and many
    grid.make(view, side, side);
    rays::RayHits expected, first, found;
    cast_at_all_boxes(scene.bounds, grid.prepared, expected);
    for (const std::uint32_t threads : {1u, 2u, 5u}) {
      const JobSystem jobs{test::run_threads, nullptr, threads};
      std::vector<rays::WideStack> stacks(threads);
      for (int again = 0; again < 20; ++again) {
        rays::cast_wide(trees.wide, grid, jobs, stacks, found);
        expect_equal(found, expected, "wide-rays", std::to_string(threads) + " threads");
        if (threads == 1) first = found;
        EXPECT_EQ(found.stats.nodes, first.stats.nodes);
        EXPECT_EQ(found.stats.boxes, first.stats.boxes);
      }
    }
  }
  const JobSystem jobs{test::run_threads, nullptr, 2};
  std::vector<rays::WideStack> stacks(2);
  rays::RayHits nothing;
  rays::cast_wide(Trees(Boxes{}).wide, grid, jobs, stacks, nothing);
  EXPECT_EQ(nothing.object, std::vector<ObjectId>(grid.size(), kNoObject));
}

TEST(NearestBox, OfNothingIsAMiss) {
  const Trees trees(Boxes{});
  const std::vector<PreparedRay> rays{PreparedRay(Ray{{0, 0, 0}, {0, 0, 1}})};
  EXPECT_EQ(compare_all(Boxes{}, trees, rays, "nothing"), 0u);
}

TEST(NearestBox, IsTheSameAfterObjectsMoved) {
  scene::Random random(32);
  Boxes boxes = test::nasty_boxes(random, 500);
  Trees trees(boxes);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 50; ++i) {
      boxes.set(random.below(static_cast<std::uint32_t>(boxes.size())),
                test::random_box(random, {{-9, -9, -9}, {9, 9, 9}}));
    }
    trees.bvh.refit(boxes), trees.wide.refit(boxes);
    compare_all(boxes, trees, test::nasty_rays(random, boxes, 300), "round " + std::to_string(round));
  }
}

}  // namespace
}  // namespace sightline::methods
