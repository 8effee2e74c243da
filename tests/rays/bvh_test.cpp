#include "library/rays/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "library/rays/wide_bvh.hpp"
#include "support/nasty_boxes.hpp"

namespace sightline::rays {
namespace {

bool holds(const Box& outer, const Box& inner) {
  return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
         outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

// Every node's children follow it, its skip count leads past them, and each object is one leaf.
void expect_sound(const Bvh& bvh, const Boxes& boxes) {
  const auto nodes = bvh.nodes();
  ASSERT_EQ(nodes.size(), 2 * boxes.size() - 1);
  ASSERT_EQ(nodes[0].descendants, nodes.size() - 1);
  std::vector<int> leaves(boxes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const BvhNode& node = nodes[i];
    if (node.object != kNoObject) {
      ASSERT_EQ(node.descendants, 0u);
      ASSERT_EQ((Box{node.min, node.max}), boxes[node.object]);
      ++leaves[node.object];
      continue;
    }
    const std::size_t left = i + 1, right = left + 1 + nodes[left].descendants;
    ASSERT_EQ(node.descendants, 2 + nodes[left].descendants + nodes[right].descendants);
    ASSERT_TRUE(holds({node.min, node.max}, {nodes[left].min, nodes[left].max}));
    ASSERT_TRUE(holds({node.min, node.max}, {nodes[right].min, nodes[right].max}));
  }
  ASSERT_TRUE(std::all_of(leaves.begin(), leaves.end(), [](int n) { return n == 1; }));
}

// Four boxes on a line: the centre of 0 … 10 parts {0, 1} from {9}, then the rest as it lies.
TEST(Bvh, SplitsTheLongestAxisAtItsCentre) {
  Boxes boxes;
  for (const float x : {9.0f, 0.0f, 1.0f}) boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  Bvh bvh;
  bvh.build(boxes);
  const auto nodes = bvh.nodes();
  ASSERT_EQ(nodes.size(), 5u);
  EXPECT_EQ(nodes[1].descendants, 2u);
  EXPECT_EQ(nodes[2].object, 1u);
  EXPECT_EQ(nodes[3].object, 2u);
  EXPECT_EQ(nodes[4].object, 0u);
}

TEST(Bvh, SplitsAtTheMedianWhereASideStaysEmpty) {
  Boxes boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  Bvh bvh;
  bvh.build(boxes);
  expect_sound(bvh, boxes);
  EXPECT_EQ(bvh.nodes()[1].descendants + 1, 999u);  // 500 leaves, 499 nodes above them
}

void expect_sound(const WideBvh& bvh, const Boxes& boxes) {
  const auto nodes = bvh.nodes();
  std::vector<int> found(boxes.size());
  std::vector<bool> is_leaf(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::uint32_t lane = 0; lane < kWide; ++lane) {
      const WideNode& node = nodes[i];
      const std::uint32_t child = node.child[lane];
      if (child == kNoObject) continue;
      const Box box{{node.min_x[lane], node.min_y[lane], node.min_z[lane]},
                    {node.max_x[lane], node.max_y[lane], node.max_z[lane]}};
      if (child < WideNode::kInner) {
        ASSERT_EQ(box, boxes[child]);
        ++found[child];
        continue;
      }
      ASSERT_FALSE(is_leaf[i]);
      const std::uint32_t below = child & WideNode::kIndex;
      ASSERT_GT(below, i);
      ASSERT_LT(below, nodes.size());
      ASSERT_EQ(box, nodes[below].bounds());
      is_leaf[below] = (child & WideNode::kLeaf) != 0;
    }
  }
  ASSERT_TRUE(std::all_of(found.begin(), found.end(), [](int n) { return n == 1; }));
}

template <class Tree>
void expect_sound_after_refitting(std::uint64_t seed, std::uint32_t most) {
  scene::Random random(seed);
  for (int round = 0; round < 50; ++round) {
    Boxes boxes = test::nasty_boxes(random, 1 + random.below(most));
    Tree tree;
    tree.build(boxes);
    expect_sound(tree, boxes);
    for (std::size_t i = 0; i < boxes.size(); i += 3) {
      boxes.set(i, test::random_box(random, {{-9, -9, -9}, {9, 9, 9}}));
    }
    tree.refit(boxes);
    expect_sound(tree, boxes);
  }
}

TEST(Bvh, IsSoundAlsoAfterRefitting) {
  expect_sound_after_refitting<Bvh>(51, 400);
}

TEST(WideBvh, IsSoundAlsoAfterRefitting) {
  expect_sound_after_refitting<WideBvh>(52, 2000);
}

TEST(WideBvh, OfBoxesAllInOnePlaceStaysShallow) {
  Boxes boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  WideBvh bvh;
  bvh.build(boxes);
  expect_sound(bvh, boxes);
  EXPECT_LT(bvh.stack_size(), 100u);
}

// Sizes that halve again and again make the deepest trees.
TEST(Bvh, OfBoxesThatShrinkWithoutEndIsBuilt) {
  Boxes boxes;
  for (int i = 0; i < 3000; ++i) {
    const float x = std::ldexp(1.0f, -(i % 140)), y = std::ldexp(1.0f, -(i / 140));
    boxes.push_back({{x, y, 0}, {x, y, 0}});
  }
  Bvh bvh;
  bvh.build(boxes);
  expect_sound(bvh, boxes);
  WideBvh wide;
  wide.build(boxes);
  expect_sound(wide, boxes);
}

}  // namespace
}  // namespace sightline::rays
