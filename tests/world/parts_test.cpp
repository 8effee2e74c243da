// Large occluders, as the walls of a level are: drawn in parts, for as much as there is to spend.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/rays.hpp>
#include <sightline/world.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "support/solid_boxes.hpp"
#include "support/streets_and_rooms.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using namespace test;

// The walls' triangles are small, and on these images most are less than a pixel wide.
CullOptions for_centres(float object) {
  CullOptions options = automatic(object);
  options.buffer.coverage = Coverage::centres;
  return options;
}

TEST(Parts, OfALevelAreDrawnAsFarAsTheAccountGoes) {
  const Level level;
  struct Case {
    float object;
    std::size_t fewer;  // times as few are left as are in view
    double cost;        // of frustum culling's
  };
  // As much as there is to spend: drawing all of the walls would cost more than the dearest frame's
  // twentieth.
  for (const auto& [object, fewer, most_cost] :
       {Case{300, 3, 0.4}, Case{1000, 40, 0.06}, Case{3000, 60, 0.03}, Case{10000, 90, 0.02}}) {
    Culler culler, plain;
    Random random(6);
    double cost = 0, frustum_cost = 0;
    std::size_t kept = 0, in_view = 0;
    for (int frame = 0; frame < 100; ++frame) {
      const CullView view{.view = {Level::from(random), {}}};
      const Culled seen = cull_with(culler, level.world, {&view, 1}, for_centres(object));
      cost += seen.result.cost, frustum_cost += seen.result.frustum_cost;
      ASSERT_LE(seen.result.cost, 1.05 * seen.result.frustum_cost);
      ASSERT_LE(cost, 1.02 * frustum_cost);
      kept += seen.result.count;
      in_view += cull_with(plain, level.world, {&view, 1}, {}).result.count;
    }
    EXPECT_LT(fewer * kept, in_view) << object;
    EXPECT_LT(cost, most_cost * frustum_cost) << object;
  }
}

// A wall of small triangles before few objects: the twentieth that the frame may spend before it has saved
// anything draws some of it, what that hides pays for more.
TEST(Parts, ArePaidForByWhatTheFirstOnesHide) {
  constexpr int kSide = 40;
  Occluder wall;
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x)
      wall.positions.push_back({static_cast<float>(x - kSide / 2), static_cast<float>(y - kSide / 2), -10});
  }
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t a = y * (kSide + 1) + x, b = a + 1, c = b + kSide + 1, d = c - 1;
      wall.indices.insert(wall.indices.end(), {a, b, c, a, c, d});
    }
  }
  for (const bool with_triangles : {false, true}) {
    World world;
    std::vector<Box> boxes{{{-20, -20, -10}, {20, 20, -10}}};
    for (int i = 0; i < 80; ++i) {
      const Vec3 at{static_cast<float>(i % 10) * 3 - 14, static_cast<float>(i / 10) * 3 - 11, -20};
      boxes.push_back({at, {at.x + 1, at.y + 1, at.z + 1}});
    }
    std::vector<Handle> handles(boxes.size());
    ASSERT_TRUE(world.insert(BoxView(boxes), handles));
    const Result<OccluderId> occluder = world.add_occluder(wall);
    ASSERT_TRUE(occluder);
    const OccluderPlacement placement{*occluder};
    ASSERT_TRUE(world.set_occluders({handles.data(), 1}, {&placement, 1}));
    for (std::size_t i = 1; with_triangles && i < boxes.size(); ++i) {
      const std::array corners{boxes[i].min, Vec3{boxes[i].max.x, boxes[i].min.y, boxes[i].max.z},
                               boxes[i].max};
      ASSERT_TRUE(world.set_triangles(handles[i], corners));
    }
    Culler culler;
    const CullView view{.view = {*make_view(Camera{}, 320, 240), {}}};
    double cost = 0, frustum_cost = 0;
    std::size_t kept = 0;
    for (int frame = 0; frame < 20; ++frame) {
      const Culled seen = cull_with(culler, world, {&view, 1}, for_centres(10000));
      cost += seen.result.cost, frustum_cost += seen.result.frustum_cost;
      ASSERT_LE(seen.result.cost, 1.05 * seen.result.frustum_cost);
      ASSERT_LE(cost, 1.02 * frustum_cost);
      kept = seen.result.count;
    }
    EXPECT_LE(kept, 12u) << with_triangles;
  }
}

TEST(Parts, OfALevelAreDrawnOnLargeImagesToo) {
  // Walls around the eye cover all of the image each, most of their triangles little of it.
  const Level level;
  Culler culler, plain;
  Random random(6);
  std::size_t kept = 0, in_view = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const CullView view{.view = {Level::from(random, 1280, 720), {}}};
    const Culled seen = cull_with(culler, level.world, {&view, 1}, for_centres(10000));
    ASSERT_LE(seen.result.cost, 1.05 * seen.result.frustum_cost);
    kept += seen.result.count;
    in_view += cull_with(plain, level.world, {&view, 1}, {}).result.count;
  }
  EXPECT_LT(60 * kept, in_view);
}

TEST(Parts, LoseNothingThatARayMeets) {
  const Level level;
  std::vector<Box> boxes = level.things;
  boxes.insert(boxes.end(), level.walls.begin(), level.walls.end());
  BoxBvh bvh;
  ASSERT_TRUE(bvh.build(BoxView(boxes)));
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    for (const float object : {300.0f, 3000.0f}) {
      Culler culler;
      CullOptions options = automatic(object);
      options.buffer.coverage = coverage;
      Random random(7);
      std::size_t seen_things = 0;
      for (int frame = 0; frame < 60; ++frame) {
        const View view = Level::from(random);
        const CullView at{.view = {view, {}}};
        const Culled left = cull_with(culler, level.world, {&at, 1}, options);
        std::vector<std::uint8_t> kept(boxes.size(), 0);
        for (const ObjectId id : left.ids) kept[id] = 1;
        std::vector<ObjectId> truth(boxes.size());
        // For all of a pixel more rays than one through each.
        const std::uint32_t more = coverage == Coverage::area ? 3 : 1;
        const auto count = bvh.visible_set(at.view, more * view.width, more * view.height, truth);
        ASSERT_TRUE(count);
        for (std::size_t i = 0; i < *count; ++i) {
          if (truth[i] >= level.things.size()) continue;
          ++seen_things;
          ASSERT_TRUE(kept[truth[i]]) << "frame " << frame << ", object " << truth[i];
        }
      }
      EXPECT_GT(seen_things, 100u);
    }
  }
}

std::vector<float> drawn(const OccluderMesh& mesh, const View& view, double* left,
                         Coverage coverage = Coverage::centres) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({view, {}}, {.coverage = coverage}));
  occlusion::MeshBudget budget{
      .look = 1, .query = 12, .triangle = 15, .polygon = 100, .tile = 2, .left = left ? *left : 0};
  if (!left) {
    EXPECT_TRUE(buffer.draw_mesh(mesh));
  } else {
    occlusion::draw_mesh(OcclusionAccess::tiles(buffer), OcclusionAccess::topology(mesh), {}, &budget);
    *left = budget.left;
  }
  std::vector<float> out(std::size_t{view.width} * view.height);
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

TEST(Parts, OfAMeshCostNoMoreThanTheBudgetAndHideNoMoreThanTheWhole) {
  const Occluder walls = mesh_of(walls_of(Level::kRooms));
  const auto mesh = OccluderMesh::make(walls.positions, walls.indices, walls.sides);
  ASSERT_TRUE(mesh);
  Random random(9);
  const View view = Level::from(random);
  const std::vector<float> whole = drawn(*mesh, view, nullptr);
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  std::size_t before = 0, pixels = 0;
  for (const double most : {0.0, 700.0, 3000.0, 10000.0, 30000.0, 1e9}) {
    double left = most;
    const std::vector<float> part = drawn(*mesh, view, &left);
    EXPECT_GE(left, 0) << most;
    before = pixels, pixels = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_LE(part[i], whole[i]);
      pixels += double{part[i]} > kNone;
    }
    EXPECT_GE(pixels, before) << most;
    if (most < 1000) {
      EXPECT_EQ(pixels, 0u);
    }
    if (most == 1e9) {
      EXPECT_EQ(part, whole);
      EXPECT_GT(pixels, 5000u);
    }
  }
}

TEST(Parts, ArePaidForWhereTheNearPlaneCutsThem) {
  // Two slopes under the eye that meet aslant across the image, each cut by the near plane. Where all of a
  // pixel counts, one is drawn twice.
  const std::array corners{Vec3{-60, -1, -60}, Vec3{60, -1, 60}, Vec3{60, -40, -60}, Vec3{-60, -9, 60}};
  const std::array<std::uint32_t, 6> indices{0, 1, 2, 1, 0, 3};
  const auto mesh = OccluderMesh::make(corners, indices);
  ASSERT_TRUE(mesh);
  const View view = *make_view({.forward = {0, -1, -0.2f}}, 128, 128);
  constexpr double kNone = -std::numeric_limits<double>::infinity(), kTile = 2;
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    std::size_t before = 0;
    for (double most = 0; most < 3000; most += 50) {
      double left = most;
      const std::vector<float> part = drawn(*mesh, view, &left, coverage);
      std::array<std::uint8_t, 256> covered{};
      for (std::size_t i = 0; i < part.size(); ++i)
        if (double{part[i]} > kNone) covered[i / 128 / 8 * 16 + i % 128 / 8] = 1;
      const auto tiles = static_cast<std::size_t>(std::count(covered.begin(), covered.end(), 1));
      EXPECT_GE(left, 0) << most;
      EXPECT_GE(most - left, kTile * static_cast<double>(tiles)) << most;
      EXPECT_GE(tiles, before) << most;
      before = tiles;
    }
    EXPECT_GT(before, 200u);
  }
}

TEST(Parts, CostTheSameForAnyWidthOfVectors) {
  const Occluder walls = mesh_of(walls_of(Level::kRooms));
  const auto mesh = OccluderMesh::make(walls.positions, walls.indices, walls.sides);
  ASSERT_TRUE(mesh);
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    for (const double most : {3000.0, 10000.0, 30000.0}) {
      Random random(10);
      for (int round = 0; round < 4; ++round) {
        const View view = Level::from(random, 320, 180);
        double left = most;
        const std::vector<float> best = drawn(*mesh, view, &left, coverage);
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
          hwy::SetSupportedTargetsForTest(target);
          double its = most;
          EXPECT_EQ(drawn(*mesh, view, &its, coverage), best) << hwy::TargetName(target);
          EXPECT_EQ(its, left) << hwy::TargetName(target);
        }
        hwy::SetSupportedTargetsForTest(0);
      }
    }
  }
}

}  // namespace
}  // namespace sightline
