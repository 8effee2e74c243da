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
#include "support/run_threads.hpp"
#include "support/solid_boxes.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using namespace test;

// Rooms of ten metres, each with a door in every wall.
std::vector<Box> walls_of(int rooms) {
  std::vector<Box> out;
  for (int x = 0; x <= rooms; ++x) {
    for (int z = 0; z <= rooms; ++z) {
      const float at_x = 10.0f * static_cast<float>(x), at_z = 10.0f * static_cast<float>(z);
      // Left and right of the door along either axis; the door's place differs from room to room.
      const float door = 1 + static_cast<float>((7 * x + 3 * z) % 7);
      if (x < rooms) {
        out.push_back({{at_x, 0, at_z - 0.1f}, {at_x + door, 4, at_z + 0.1f}});
        out.push_back({{at_x + door + 1, 0, at_z - 0.1f}, {at_x + 10, 4, at_z + 0.1f}});
      }
      if (z < rooms) {
        out.push_back({{at_x - 0.1f, 0, at_z}, {at_x + 0.1f, 4, at_z + door}});
        out.push_back({{at_x - 0.1f, 0, at_z + door + 1}, {at_x + 0.1f, 4, at_z + 10}});
      }
    }
  }
  return out;
}

Occluder mesh_of(const std::vector<Box>& boxes) {
  constexpr std::array<std::uint32_t, 36> kCorners{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                                   2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  Occluder out;
  for (const Box& b : boxes) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (std::uint32_t i = 0; i < 8; ++i)
      out.positions.push_back(
          {i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z});
    for (const std::uint32_t corner : kCorners) out.indices.push_back(first + corner);
  }
  out.sides = {Sides::front};
  return out;
}

// Things in the rooms, and one object whose occluder all of the walls are.
struct Level {
  static constexpr int kRooms = 16;
  Level() : walls(walls_of(kRooms)) {
    Random random(4);
    const float size = 10.0f * kRooms;
    while (things.size() < 3000) {
      const Box thing = box_at({random.between(0, size), random.between(0.2f, 3), random.between(0, size)},
                               {0.15f, 0.15f, 0.15f});
      things.push_back(thing);
    }
    std::vector<Box> all = things;
    all.push_back({{-1, 0, -1}, {size + 1, 4, size + 1}});
    handles.resize(all.size());
    EXPECT_TRUE(world.insert(BoxView(all), handles));
    const Occluder mesh = mesh_of(walls);
    EXPECT_GT(mesh.indices.size() / 3, 12000u);
    const auto name = world.add_occluder(mesh);
    EXPECT_TRUE(name);
    const OccluderPlacement placement{*name};
    EXPECT_TRUE(world.set_occluders(std::span(handles).last(1), {&placement, 1}));
  }
  [[nodiscard]] static View from(Random& random, std::uint32_t width = 160, std::uint32_t height = 90) {
    const float x = 10.0f * static_cast<float>(random.below(kRooms)) + random.between(1, 9),
                z = 10.0f * static_cast<float>(random.below(kRooms)) + random.between(1, 9);
    const float angle = random.between(0, 6.28f);
    return looking({x, 1.7f, z}, {std::sin(angle), 0, -std::cos(angle)}, width, height);
  }

  std::vector<Box> walls, things;
  std::vector<Handle> handles;
  World world;
};

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
       {Case{300, 1, 1}, Case{1000, 5, 0.25}, Case{3000, 15, 0.1}, Case{10000, 90, 0.02}}) {
    Culler culler, plain;
    Random random(6);
    double cost = 0, frustum_cost = 0;
    std::size_t kept = 0, in_view = 0;
    for (int frame = 0; frame < 100; ++frame) {
      const CullView view{.view = {Level::from(random), {}}};
      const Culled seen = cull_with(culler, level.world, {&view, 1}, automatic(object));
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

TEST(Parts, OfALevelAreDrawnOnLargeImagesToo) {
  // Walls around the eye cover all of the image each, most of their triangles little of it.
  const Level level;
  Culler culler, plain;
  Random random(6);
  std::size_t kept = 0, in_view = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const CullView view{.view = {Level::from(random, 1280, 720), {}}};
    const Culled seen = cull_with(culler, level.world, {&view, 1}, automatic(10000));
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

TEST(Parts, AreTheSameForAnyNumberOfJobs) {
  const Level level;
  std::vector<Culled> first;
  for (const std::uint32_t threads : {1u, 2u, 8u}) {
    Culler culler;
    CullOptions options = automatic(1000);
    if (threads > 1) options.jobs = {run_threads, nullptr, threads};
    Random random(8);
    for (std::size_t frame = 0; frame < 20; ++frame) {
      const CullView view{.view = {Level::from(random), {}}};
      const Culled seen = cull_with(culler, level.world, {&view, 1}, options);
      if (threads == 1) {
        first.push_back(seen);
        continue;
      }
      ASSERT_EQ(seen.ids, first[frame].ids);
      ASSERT_EQ(seen.result.cost, first[frame].result.cost);
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
    occlusion::draw_mesh(OcclusionAccess::tiles(buffer), OcclusionAccess::topology(mesh),
                         geometry::row_transform(Mat4{}), budget);
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
