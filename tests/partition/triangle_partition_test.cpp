// Partitions of triangles against brute force: nothing missing, nothing where it does not belong, and the
// walk finds every cell that the frustum touches.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include <sightline/workbench/error.hpp>

#include "support/random_views.hpp"
#include "support/triangles.hpp"
#include "workbench/partition/triangle_box.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::partition {
namespace {

struct Flat {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices, ids;

  explicit Flat(const std::vector<test::Triangle>& triangles) {
    for (const auto& triangle : triangles)
      positions.insert(positions.end(), triangle.begin(), triangle.end());
    indices.resize(positions.size()), ids.resize(triangles.size());
    std::iota(indices.begin(), indices.end(), 0u);
    std::iota(ids.begin(), ids.end(), 0u);
  }
  [[nodiscard]] TriangleSpan span() const { return {positions, indices}; }
};

constexpr std::array kStructures{Structure::grid, Structure::octree, Structure::kd_tree};
constexpr CellRules kToTheHeight{.least = 0}, kPrinted{.least = 0, .printed = true};

bool holds(const Box& box, const Vec3& p, float room) {
  return p.x >= box.min.x - room && p.x <= box.max.x + room && p.y >= box.min.y - room &&
         p.y <= box.max.y + room && p.z >= box.min.z - room && p.z <= box.max.z + room;
}

void expect_sound_tree(const TrianglePartition& partition, std::size_t triangles) {
  const auto nodes = partition.nodes();
  ASSERT_FALSE(nodes.empty());
  EXPECT_EQ(nodes[0].next, nodes.size());
  EXPECT_EQ(nodes[0].first_cell, 0u);
  EXPECT_EQ(nodes[0].last_cell, partition.cells());
  std::uint32_t leaves = 0;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].next == i + 1) {
      ASSERT_EQ(nodes[i].first_cell, leaves);
      ASSERT_EQ(nodes[i].last_cell, leaves + 1);
      ASSERT_EQ(nodes[i].bounds, partition.bounds(leaves));
      ++leaves;
    }
    for (std::uint32_t cell = nodes[i].first_cell; cell < nodes[i].last_cell; ++cell)
      ASSERT_EQ(united(nodes[i].bounds, partition.bounds(cell)), nodes[i].bounds);
  }
  ASSERT_EQ(leaves, partition.cells());
  std::set<std::uint32_t> found;
  for (std::uint32_t cell = 0; cell < partition.cells(); ++cell) {
    const auto ids = partition.triangles(cell);
    ASSERT_FALSE(ids.empty()) << "cell " << cell << " is empty";
    ASSERT_TRUE(std::ranges::is_sorted(ids));
    ASSERT_EQ(std::ranges::adjacent_find(ids), ids.end());
    found.insert(ids.begin(), ids.end());
  }
  ASSERT_EQ(found.size(), triangles);
}

// Every point of a triangle lies within the bounds of a cell that holds the triangle, so whatever part of
// space is looked at, the triangle is found there.
TEST(TrianglePartition, EveryPointOfATriangleIsInACellOfIts) {
  for (const auto& [name, triangles] : test::awkward_triangles()) {
    const Flat flat(triangles);
    for (const Structure structure : kStructures) {
      for (std::uint32_t height = 1; height <= 8; ++height) {
        TrianglePartition partition;
        // The last two times the paper's rules, at a height that some triangles fill with copies.
        const CellRules rules = height == 7 ? kToTheHeight : height == 8 ? kPrinted : CellRules{};
        partition.build(structure, flat.span(), flat.ids, height > 6 ? 3 : height, rules);
        SCOPED_TRACE(name + " structure " + std::to_string(static_cast<int>(structure)) + " height " +
                     std::to_string(height));
        expect_sound_tree(partition, triangles.size());
        std::vector<std::vector<std::uint32_t>> cells_of(triangles.size());
        for (std::uint32_t cell = 0; cell < partition.cells(); ++cell) {
          for (const std::uint32_t t : partition.triangles(cell)) cells_of[t].push_back(cell);
        }
        scene::Random random(42);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
          for (int sample = 0; sample < 6; ++sample) {
            float u = random.unit(), v = random.unit();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            if (sample < 3) u = sample == 1, v = sample == 2;  // the corners
            const auto& [a, b, c] = triangles[t];
            const Vec3 p{a.x + u * (b.x - a.x) + v * (c.x - a.x), a.y + u * (b.y - a.y) + v * (c.y - a.y),
                         a.z + u * (b.z - a.z) + v * (c.z - a.z)};
            ASSERT_TRUE(std::ranges::any_of(
                cells_of[t], [&](std::uint32_t cell) { return holds(partition.bounds(cell), p, 2e-5f); }))
                << "triangle " << t << " at " << p.x << ' ' << p.y << ' ' << p.z;
          }
        }
      }
    }
  }
}

TEST(TrianglePartition, ATriangleIsOnlyInCellsItReachesInto) {
  const Flat flat(test::awkward_triangles()[0].triangles);
  for (const Structure structure : kStructures) {
    TrianglePartition partition;
    partition.build(structure, flat.span(), flat.ids, 4);
    std::size_t crossing = 0;
    for (std::uint32_t cell = 0; cell < partition.cells(); ++cell) {
      crossing += partition.triangles(cell).size();
      for (const std::uint32_t t : partition.triangles(cell))
        ASSERT_TRUE(overlaps(flat.span()[t], partition.region(cell)));
    }
    EXPECT_GT(crossing, flat.ids.size());  // some cross, and belong to each
  }
}

TEST(TrianglePartition, RegularCellsHaveTheirShareOfTheRoot) {
  scene::Random random(46);
  std::vector<test::Triangle> triangles;
  for (int i = 0; i < 8000; ++i)
    triangles.push_back(test::random_triangle(random, {{-50, -20, -50}, {50, 20, 50}}, 0.8f));
  const Flat flat(triangles);
  TrianglePartition octree, grid;
  octree.build(Structure::octree, flat.span(), flat.ids, 2);
  grid.build(Structure::grid, flat.span(), flat.ids, 3);
  const Box all = octree.nodes()[0].bounds;
  EXPECT_LE(octree.cells(), 64u);
  EXPECT_GT(octree.cells(), 32u);
  EXPECT_LE(grid.cells(), 64u);
  for (std::uint32_t cell = 0; cell < octree.cells(); ++cell) {
    const Box r = octree.region(cell);
    EXPECT_NEAR(r.max.y - r.min.y, (all.max.y - all.min.y) / 4, 1e-3);
  }
  for (std::uint32_t cell = 0; cell < grid.cells(); ++cell) {
    const Box r = grid.region(cell);
    EXPECT_NEAR(r.max.x - r.min.x, (all.max.x - all.min.x) / 8, 1e-3);
    EXPECT_EQ(r.max.y - r.min.y, all.max.y - all.min.y);
  }
}

// A split that cannot gain what its calls may cost is left alone: 8 × 11 triangles, eleven being a call's
// worth.
TEST(TrianglePartition, TreesKeepFewTrianglesInOneCell) {
  scene::Random random(47);
  for (const auto& [structure, least] :
       {std::pair{Structure::octree, 88}, std::pair{Structure::kd_tree, 22}}) {
    for (const int count : {least - 1, least}) {
      std::vector<test::Triangle> triangles;
      for (int i = 0; i < count; ++i)
        triangles.push_back(test::random_triangle(random, {{-50, -20, -50}, {50, 20, 50}}, 0.8f));
      const Flat flat(triangles);
      TrianglePartition partition;
      partition.build(structure, flat.span(), flat.ids, 6);
      EXPECT_EQ(partition.cells() > 1, count == least);
      expect_sound_tree(partition, triangles.size());
    }
  }
}

// As the paper has it: however few triangles, and whatever that multiplies.
TEST(TrianglePartition, WithoutALeastEveryNodeIsSplitToTheHeight) {
  scene::Random random(48);
  std::vector<test::Triangle> triangles;
  for (int i = 0; i < 20; ++i)
    triangles.push_back(test::random_triangle(random, {{-50, -20, -50}, {50, 20, 50}}, i < 2 ? 60.0f : 0.8f));
  const Flat flat(triangles);
  for (const Structure structure : kStructures) {
    TrianglePartition partition;
    partition.build(structure, flat.span(), flat.ids, 3, kToTheHeight);
    expect_sound_tree(partition, triangles.size());
    // Depth of each leaf: nodes that it lies under.
    const auto nodes = partition.nodes();
    for (std::uint32_t leaf = 0; leaf < nodes.size(); ++leaf) {
      if (nodes[leaf].next != leaf + 1) continue;
      int depth = 0;
      for (std::uint32_t above = 0; above < leaf; ++above) depth += nodes[above].next > leaf;
      ASSERT_EQ(depth, 3) << "structure " << static_cast<int>(structure);
    }
  }
}

TEST(TrianglePartition, PrintedCellsAreEqualAndAGridsAreAsHighAsEverything) {
  const Flat flat(test::awkward_triangles()[0].triangles);
  for (const Structure structure : kStructures) {
    TrianglePartition printed, tight;
    printed.build(structure, flat.span(), flat.ids, 3, kPrinted);
    tight.build(structure, flat.span(), flat.ids, 3, kToTheHeight);
    ASSERT_EQ(printed.cells(), tight.cells());
    const Box all = printed.nodes()[0].bounds;
    std::uint32_t larger = 0;
    for (std::uint32_t cell = 0; cell < printed.cells(); ++cell) {
      const Box &cut = printed.bounds(cell), &shown = tight.bounds(cell);
      ASSERT_EQ(cut, printed.region(cell));
      ASSERT_EQ(united(cut, shown), cut);
      larger += cut != shown;
      if (structure == Structure::kd_tree) continue;
      ASSERT_NEAR(cut.max.x - cut.min.x, (all.max.x - all.min.x) / 8, 1e-3);
      ASSERT_NEAR(cut.max.y - cut.min.y, (all.max.y - all.min.y) / (structure == Structure::grid ? 1 : 8),
                  1e-3);
    }
    EXPECT_GT(larger, printed.cells() / 2);
  }
}

TEST(TrianglePartition, RefusesMoreCopiesThanTheRulesAllow) {
  const Flat flat(test::awkward_triangles()[0].triangles);
  CellRules rules = kToTheHeight;
  rules.most_held = flat.ids.size();
  TrianglePartition partition;
  EXPECT_THROW(partition.build(Structure::octree, flat.span(), flat.ids, 3, rules), Error);
  rules.most_held = 100 * flat.ids.size();
  partition.build(Structure::octree, flat.span(), flat.ids, 3, rules);
  EXPECT_GT(partition.cells(), 1u);
}

TEST(TrianglePartition, KdTreeSplitsAtTheMeanOfTheAxisOfHighestVariance) {
  std::vector<test::Triangle> triangles;
  for (int i = 0; i < 8; ++i) {
    for (const float x : {0.0f, 1.0f, 2.0f, 21.0f})
      triangles.push_back({Vec3{x, 0, 0}, Vec3{x + 0.3f, 1, 0}, Vec3{x + 0.3f, 0, 2}});
  }
  const Flat flat(triangles);
  TrianglePartition partition;
  partition.build(Structure::kd_tree, flat.span(), flat.ids, 1);
  ASSERT_EQ(partition.cells(), 2u);
  EXPECT_NEAR(partition.region(0).max.x, 6.2, 1e-5);
  EXPECT_EQ(partition.triangles(0).size(), 24u);
}

TEST(TrianglePartition, WalkFindsExactlyTheCellsThatOverlap) {
  constexpr Box kAround{{-60, -25, -60}, {60, 25, 60}};
  for (const auto& [name, triangles] : test::awkward_triangles()) {
    const Flat flat(triangles);
    std::vector<TrianglePartition> partitions(7);
    for (std::size_t s = 0; s < 3; ++s) {
      partitions[s].build(kStructures[s], flat.span(), flat.ids, 4);
      partitions[4 + s].build(kStructures[s], flat.span(), flat.ids, 3, kPrinted);
    }
    partitions[3].build_clusters(flat.span(), flat.ids, 32);
    scene::Random random(43);
    for (const TrianglePartition& partition : partitions) {
      for (int v = 0; v < 200; ++v) {
        const Frustum frustum = make_frustum(test::random_view(random, kAround));
        std::vector<TrianglePartition::Run> runs;
        partition.walk(frustum, runs);
        std::vector<std::uint32_t> found, expected;
        for (std::size_t r = 0; r < runs.size(); ++r) {
          ASSERT_LT(runs[r].first_cell, runs[r].last_cell);
          if (r > 0) ASSERT_GT(runs[r].first_cell, runs[r - 1].last_cell);
          for (std::uint32_t c = runs[r].first_cell; c < runs[r].last_cell; ++c) found.push_back(c);
        }
        for (std::uint32_t c = 0; c < partition.cells(); ++c) {
          if (overlaps(frustum, partition.bounds(c))) expected.push_back(c);
        }
        ASSERT_EQ(found, expected) << name << " view " << v;
      }
    }
  }
}

TEST(TriangleClusters, HoldEachTriangleOnceInBoundsThatHoldIt) {
  for (const auto& [name, triangles] : test::awkward_triangles()) {
    const Flat flat(triangles);
    for (const std::uint32_t size : {4u, 18u, 32u, 128u, 500u, 4096u}) {
      TrianglePartition partition;
      partition.build_clusters(flat.span(), flat.ids, size);
      SCOPED_TRACE(name + ", size " + std::to_string(size));
      expect_sound_tree(partition, triangles.size());
      std::size_t held = 0;
      for (std::uint32_t cell = 0; cell < partition.cells(); ++cell) {
        EXPECT_LE(partition.triangles(cell).size(), size);
        held += partition.triangles(cell).size();
        for (const std::uint32_t t : partition.triangles(cell))
          ASSERT_EQ(united(partition.bounds(cell), bounds_of(triangles[t])), partition.bounds(cell));
      }
      EXPECT_EQ(held, triangles.size());
    }
  }
}

// Several alike, triangles of two or three equal corners, and the same one from behind.
TEST(TriangleClusters, TellTrianglesOfTheSameCornersApart) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{1, 1, 0};
  std::vector<test::Triangle> triangles;
  for (int i = 0; i < 10; ++i) {
    for (const test::Triangle& triangle : {test::Triangle{a, b, c},
                                           {b, c, a},
                                           {c, b, a},
                                           {b, d, c},
                                           {a, a, b},
                                           {a, b, a},
                                           {b, a, a},
                                           {a, a, a},
                                           {d, c, d}})
      triangles.push_back(triangle);
  }
  const Flat flat(triangles);
  for (const std::uint32_t size : {4u, 16u, 64u, 256u}) {
    TrianglePartition partition;
    partition.build_clusters(flat.span(), flat.ids, size);
    expect_sound_tree(partition, triangles.size());
    EXPECT_GE(partition.cells(), triangles.size() / size);
  }
}

// A triangle as large as the scene must not be handed down to every cell of a deep octree, nor may a heap of
// them multiply without end.
TEST(TrianglePartition, LargeTrianglesDoNotMultiplyWithoutEnd) {
  std::vector<test::Triangle> triangles;
  scene::Random random(44);
  for (int i = 0; i < 300; ++i)
    triangles.push_back(test::random_triangle(random, {{-1, -1, -1}, {1, 1, 1}}, 100));
  const Flat flat(triangles);
  for (const Structure structure : kStructures) {
    TrianglePartition partition;
    partition.build(structure, flat.span(), flat.ids, 6);
    std::size_t held = 0;
    for (std::uint32_t cell = 0; cell < partition.cells(); ++cell) held += partition.triangles(cell).size();
    EXPECT_LE(held, 64 * triangles.size());
  }
}

TEST(TriangleBox, AgreesWithSamplingAndIsCertainWhenItSaysNo) {
  scene::Random random(45);
  std::size_t apart = 0, touching = 0;
  for (int i = 0; i < 20000; ++i) {
    const test::Triangle t = test::random_triangle(random, {{-2, -2, -2}, {2, 2, 2}}, 1.5f);
    const bool said = overlaps(t, {{-1, -1, -1}, {1, 1, 1}});
    (said ? touching : apart)++;
    for (int s = 0; s < 40 && !said; ++s) {
      float u = random.unit(), v = random.unit();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p{t[0].x + u * (t[1].x - t[0].x) + v * (t[2].x - t[0].x),
                   t[0].y + u * (t[1].y - t[0].y) + v * (t[2].y - t[0].y),
                   t[0].z + u * (t[1].z - t[0].z) + v * (t[2].z - t[0].z)};
      ASSERT_FALSE(holds({{-1, -1, -1}, {1, 1, 1}}, p, -1e-5f)) << i;
    }
  }
  EXPECT_GT(apart, 2000u);
  EXPECT_GT(touching, 2000u);
  // In the box's corner region, yet past it: boxes of bounds overlap, the triangle does not.
  EXPECT_FALSE(
      overlaps({Vec3{1.9f, 0.9f, 0}, Vec3{0.9f, 1.9f, 0}, Vec3{1.9f, 1.9f, 0}}, {{-1, -1, -1}, {1, 1, 1}}));
}

}  // namespace
}  // namespace sightline::partition
