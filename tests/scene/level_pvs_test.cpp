#include <sightline/workbench/level_pvs.hpp>

#include <gtest/gtest.h>

#include <array>

#include "support/refusal.hpp"

namespace sightline {
namespace {

// Three rooms in a row along x, split at x = 0 and x = 10; object i is in room i, object 3 in no leaf. The
// outer rooms do not see each other.
LevelPvs three_rooms() {
  LevelPvs level;
  level.nodes = {{{{1, 0, 0}, 0}, 1, -1}, {{{1, 0, 0}, -10}, -3, -2}};
  level.leaves.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    level.leaves[i].cluster = static_cast<std::int32_t>(i);
    level.leaves[i].first_object = i;
    level.leaves[i].object_count = 1;
  }
  level.leaf_objects = {0, 1, 2};
  level.clusters = 3;
  level.bytes_per_cluster = 1;
  level.visibility = {0b011, 0b111, 0b110};
  level.in_some_leaf = {1, 1, 1, 0};
  level.in_world_model = {1, 1, 1, 0};
  return level;
}

TEST(LevelPvs, FindsTheLeafOfAPoint) {
  const LevelPvs level = three_rooms();
  EXPECT_EQ(level.leaf_at({-5, 0, 0}), 0u);
  EXPECT_EQ(level.leaf_at({5, 0, 0}), 1u);
  EXPECT_EQ(level.leaf_at({15, 0, 0}), 2u);
}

TEST(LevelPvs, SeesItsClustersAndWhatNoLeafLists) {
  const LevelPvs level = three_rooms();
  std::array<std::uint8_t, 4> mask{};
  level.potentially_visible({-5, 0, 0}, mask);
  EXPECT_EQ(mask, (std::array<std::uint8_t, 4>{1, 1, 0, 1}));
  level.potentially_visible({5, 0, 0}, mask);
  EXPECT_EQ(mask, (std::array<std::uint8_t, 4>{1, 1, 1, 1}));
}

TEST(LevelPvs, FromInsideSolidEverythingMayBeSeen) {
  LevelPvs level = three_rooms();
  level.leaves[0].cluster = -1;
  std::array<std::uint8_t, 4> mask{};
  level.potentially_visible({-5, 0, 0}, mask);
  EXPECT_EQ(mask, (std::array<std::uint8_t, 4>{1, 1, 1, 1}));
}

TEST(LevelPvs, RefusesWhatWouldLeadAstray) {
  EXPECT_NO_THROW(check(three_rooms(), 4));
  const auto spoilt = [](auto&& spoil) {
    LevelPvs level = three_rooms();
    spoil(level);
    return !test::refusal([&] { check(level, 4); }).empty();
  };
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.nodes[1].front = 0; }));  // a circle
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.nodes[1].front = 2; }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.nodes[1].back = -4; }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.nodes[1].back = std::numeric_limits<std::int32_t>::min(); }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.leaves.clear(); }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.leaves[2].object_count = 0xffffffff; }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.leaves[2].cluster = 3; }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.leaf_objects[0] = 4; }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.visibility.pop_back(); }));
  EXPECT_TRUE(spoilt([](LevelPvs& l) { l.in_some_leaf.pop_back(); }));
}

// Every point that is looked up walks down the tree, and a segment down all that it crosses.
TEST(LevelPvs, RefusesTreesThatAreNoneOrTooDeep) {
  const auto refusal_of = [](std::size_t nodes) {
    LevelPvs level = three_rooms();
    level.nodes.assign(nodes, {{{1, 0, 0}, 0}, -1, -2});
    for (std::size_t i = 0; i + 1 < nodes; ++i) level.nodes[i].front = static_cast<std::int32_t>(i + 1);
    return test::refusal([&] { check(level, 4); });
  };
  EXPECT_EQ(refusal_of(1024), "");
  EXPECT_EQ(refusal_of(1025), "level PVS: node 1023 has a child below 1024 others, expected fewer");
  LevelPvs level = three_rooms();
  level.nodes[0].back = level.nodes[0].front;
  EXPECT_EQ(test::refusal([&] { check(level, 4); }),
            "level PVS: node 0 has a child that another node has too, expected a tree");
}

}  // namespace
}  // namespace sightline
