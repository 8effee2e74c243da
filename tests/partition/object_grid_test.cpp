#include "workbench/partition/object_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "support/random_views.hpp"

namespace sightline::partition {
namespace {

constexpr Box kAround{{-200, -20, -200}, {200, 20, 200}};

Boxes random_boxes(scene::Random& random, std::size_t count) {
  Boxes boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = random.inside(kAround),
               half{random.between(0, 3), random.between(0, 3), random.between(0, 3)};
    boxes.push_back(
        {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
  }
  return boxes;
}

TEST(ObjectGrid, HoldsEveryObjectOnceInsideItsCell) {
  scene::Random random(1);
  const Boxes boxes = random_boxes(random, 2000);
  ObjectGrid grid;
  grid.build(boxes, 10);
  std::set<ObjectId> seen(grid.order().begin(), grid.order().end());
  EXPECT_EQ(seen.size(), 2000u);
  EXPECT_EQ(grid.order().size(), 2000u);
  for (std::uint32_t r = 0; r < grid.rows(); ++r) {
    for (std::uint32_t c = 0; c < grid.columns(); ++c) {
      const Box cell = grid.cell_bounds(r, c);
      const auto [begin, end] = grid.slots(r, c, c + 1);
      for (std::uint32_t s = begin; s < end; ++s) {
        const Box box = boxes[grid.order()[s]];
        ASSERT_TRUE(box.min.x >= cell.min.x && box.max.x <= cell.max.x && box.min.y >= cell.min.y &&
                    box.max.y <= cell.max.y && box.min.z >= cell.min.z && box.max.z <= cell.max.z);
      }
    }
  }
}

TEST(ObjectGrid, HasAsManyCellsAsAskedForAndKnowsWhereTheyLie) {
  scene::Random random(3);
  const Boxes boxes = random_boxes(random, 2000);
  ObjectGrid grid;
  grid.build(boxes, 10, {4, 7});
  ASSERT_EQ(grid.rows(), 4u);
  ASSERT_EQ(grid.columns(), 7u);
  for (std::uint32_t r = 0; r < 4; ++r) {
    for (std::uint32_t c = 0; c < 7; ++c) {
      const Box ground = grid.cell_ground(r, c);
      EXPECT_EQ(grid.cell_at(0.5f * (ground.min.x + ground.max.x), 0.5f * (ground.min.z + ground.max.z)),
                std::pair(r, c));
      const auto [begin, end] = grid.slots(r, c, c + 1);
      for (std::uint32_t s = begin; s < end; ++s) {
        const Box box = boxes[grid.order()[s]];
        ASSERT_NEAR(0.5f * (box.min.x + box.max.x), 0.5f * (ground.min.x + ground.max.x), 0.51f * 400 / 7);
        ASSERT_NEAR(0.5f * (box.min.z + box.max.z), 0.5f * (ground.min.z + ground.max.z), 0.51f * 400 / 4);
      }
    }
  }
  EXPECT_EQ(grid.cell_at(-1e6f, 1e6f), std::pair(3u, 0u));
}

TEST(ObjectGrid, KeepsGiantsApart) {
  scene::Random random(2);
  Boxes boxes = random_boxes(random, 500);
  boxes.push_back({{-200, 0, -200}, {200, 1, 200}});
  ObjectGrid grid;
  grid.build(boxes, 10);
  const auto [begin, end] = grid.oversize_slots();
  ASSERT_EQ(end - begin, 1u);
  EXPECT_EQ(grid.order()[begin], 500u);
}

// The runs that classify() finds by bisection are the cells that a test of every cell finds.
TEST(ObjectGrid, ClassifiesLikeATestOfEveryCell) {
  scene::Random random(3);
  for (int round = 0; round < 40; ++round) {
    const Boxes boxes = random_boxes(random, 50 + random.below(1500));
    ObjectGrid grid;
    grid.build(boxes, random.between(2, 60));
    for (int v = 0; v < 100; ++v) {
      const Frustum frustum = make_frustum(test::random_view(random, kAround));
      std::vector<ObjectGrid::Run> runs;
      grid.classify(frustum, runs);
      std::map<std::pair<std::uint32_t, std::uint32_t>, Overlap> found;
      for (const auto& run : runs) {
        ASSERT_LT(run.first_column, run.last_column);
        for (std::uint32_t c = run.first_column; c < run.last_column; ++c) {
          ASSERT_TRUE(found.emplace(std::pair(run.row, c), run.overlap).second);
        }
      }
      for (std::uint32_t r = 0; r < grid.rows(); ++r) {
        const auto [row_begin, row_end] = grid.slots(r, 0, grid.columns());
        if (row_begin == row_end) continue;
        for (std::uint32_t c = 0; c < grid.columns(); ++c) {
          const Overlap expected = classify(frustum, grid.cell_bounds(r, c));
          const auto at = found.find({r, c});
          ASSERT_EQ(at == found.end() ? Overlap::outside : at->second, expected) << r << ' ' << c;
        }
      }
    }
  }
}

TEST(ObjectGrid, StandsOneObjectAndAllAtOnePlace) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{50}}) {
    Boxes boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back({{1, 2, 3}, {1, 2, 3}});
    ObjectGrid grid;
    grid.build(boxes, 1);
    EXPECT_EQ(grid.order().size(), count);
    std::vector<ObjectGrid::Run> runs;
    grid.classify(make_frustum(*make_view({.eye = {1, 2, 20}}, 64, 64)), runs);
    EXPECT_EQ(runs.size() + (grid.oversize_slots().second - grid.oversize_slots().first),
              count == 1 || !runs.empty() ? 1u : 50u);
  }
}

TEST(ObjectGrid, EmptyColumnsAtTheEdgeDoNoHarm) {
  // A giant's centre stretches the grid; the columns on its side hold nothing.
  Boxes boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 0.5f, 1, 1}});
  boxes.push_back({{0, 0, 0}, {500, 1, 1}});
  ObjectGrid grid;
  grid.build(boxes, 2);
  const Frustum frustum = make_frustum(*make_view({.eye = {10, 0.5f, 20}}, 64, 64));
  std::vector<ObjectGrid::Run> runs;
  grid.classify(frustum, runs);
  std::set<ObjectId> touched;
  for (const auto& run : runs) {
    const auto [begin, end] = grid.slots(run.row, run.first_column, run.last_column);
    touched.insert(grid.order().begin() + begin, grid.order().begin() + end);
  }
  for (ObjectId i = 0; i < 20; ++i) {
    if (overlaps(frustum, boxes[i])) EXPECT_TRUE(touched.contains(i)) << i;
  }
}

}  // namespace
}  // namespace sightline::partition
