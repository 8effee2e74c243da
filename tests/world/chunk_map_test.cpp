#include "library/world/chunk_map.hpp"
#include "library/world/chunk_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "support/random_views.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::world {
namespace {

using scene::Random;

constexpr Box kGround{{-100, 0, -80}, {100, 0, 80}};

Box random_box(Random& random, float reach, float largest) {
  const Vec3 at = random.inside({{-reach, -20, -reach}, {reach, 20, reach}});
  const Vec3 half = random.inside({{0, 0, 0}, {largest, largest, largest}});
  return {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}};
}

std::string failure(const ChunkMap& map) {
  const Status sound = map.check();
  return sound ? "" : std::string(sound.message()) + " " + std::to_string(sound.index());
}

// The objects of the chunks that a walk leaves, tested one by one where their chunk crosses.
std::vector<ObjectId> walked(const ChunkMap& map, const Frustum& frustum) {
  ChunkWalk walk_out;
  walk(map, frustum, walk_out);
  std::vector<ObjectId> kept;
  for (const std::uint32_t c : walk_out.inside) {
    const auto chunk = map.chunk(c);
    kept.insert(kept.end(), chunk.objects, chunk.objects + chunk.count);
  }
  for (const std::uint32_t c : walk_out.crossing) {
    const auto chunk = map.chunk(c);
    for (std::uint32_t i = 0; i < chunk.count; ++i) {
      if (overlaps(frustum, map.box(chunk.objects[i]))) kept.push_back(chunk.objects[i]);
    }
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

TEST(ChunkMap, HomesAnObjectByTheRegionsItTouches) {
  ChunkMap map({kGround, 3});  // leaf regions of 25 m × 20 m
  map.insert(0, {{-99, 0, -79}, {-98, 1, -78}});
  map.insert(1, {{-76, 0, -79}, {-74, 1, -78}});
  map.insert(2, {{-90, 0, -79}, {-74, 1, -30}});
  map.insert(3, {{500, 0, 500}, {501, 1, 501}});  // beyond the ground: the nearest region
  EXPECT_EQ(map.chunk_regions(map.location(0).chunk), (RegionSet{0, 0, 0, 0}));
  EXPECT_FALSE(map.chunk_regions(map.location(0).chunk).shared());
  EXPECT_EQ(map.chunk_regions(map.location(1).chunk), (RegionSet{0, 0, 1, 0}));
  EXPECT_EQ(map.chunk_regions(map.location(2).chunk), (RegionSet{0, 0, 1, 2}));
  EXPECT_TRUE(map.chunk_regions(map.location(2).chunk).shared());
  EXPECT_EQ(map.chunk_regions(map.location(3).chunk), (RegionSet{7, 7, 7, 7}));
  EXPECT_EQ(map.chunk_bounds(map.location(3).chunk), (Box{{500, 0, 500}, {501, 1, 501}}));
  EXPECT_EQ(failure(map), "");
}

TEST(ChunkMap, EqualsBruteForceAfterThousandsOfRandomOperations) {
  for (const std::uint32_t depth : {0u, 1u, 3u, 6u}) {
    Random random(depth + 1);
    ChunkMap map({kGround, depth});
    std::map<ObjectId, Box> twin;
    std::vector<ObjectId> present, absent;
    for (ObjectId id = 0; id < 3000; ++id) absent.push_back(id);
    for (int step = 0; step < 12000; ++step) {
      // Grows, then shrinks, then grows: splits and merges both happen.
      const bool growing = (step / 3000) % 2 == 0;
      const std::uint32_t dice = random.below(10);
      if (!absent.empty() && dice < (growing ? 5u : 1u)) {
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(absent.size()));
        const ObjectId id = absent[i];
        absent[i] = absent.back(), absent.pop_back(), present.push_back(id);
        map.insert(id, twin[id] = random_box(random, 130, random.below(20) == 0 ? 60.0f : 1.0f));
      } else if (!present.empty() && dice < 6) {
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(present.size()));
        const ObjectId id = present[i];
        present[i] = present.back(), present.pop_back(), absent.push_back(id);
        map.remove(id);
        twin.erase(id);
      } else if (!present.empty()) {
        const ObjectId id = present[random.below(static_cast<std::uint32_t>(present.size()))];
        Box& box = twin[id];
        if (random.below(2) == 0) {
          box = random_box(random, 130, 1);
        } else {
          const float by = random.between(-2, 2);
          box.min.x += by, box.max.x += by;
        }
        map.move(id, box);
      }
      if (step % 500 == 499) {
        map.tighten();
        ASSERT_EQ(failure(map), "") << "depth " << depth << " step " << step;
        ASSERT_EQ(map.size(), twin.size());
        for (const auto& [id, box] : twin) ASSERT_EQ(map.box(id), box);
        for (const ObjectId id : absent) ASSERT_FALSE(map.contains(id));
        for (int v = 0; v < 4; ++v) {
          const View view = test::random_view(random, {{-150, -30, -150}, {150, 30, 150}});
          const Frustum frustum = make_frustum(view);
          std::vector<ObjectId> truth;
          for (const auto& [id, box] : twin) {
            if (overlaps(frustum, box)) truth.push_back(id);
          }
          ASSERT_EQ(walked(map, frustum), truth);
        }
      }
    }
    while (!present.empty()) map.remove(present.back()), present.pop_back();
    map.tighten();
    EXPECT_EQ(failure(map), "");
    for (std::uint32_t c = 0; c < map.chunk_limit(); ++c) EXPECT_EQ(map.chunk(c).count, 0u);
  }
}

TEST(ChunkMap, HoldsManyObjectsInOnePoint) {
  ChunkMap map({kGround, 3});
  const Box box{{1, 1, 1}, {2, 2, 2}};
  for (ObjectId id = 0; id < 1000; ++id) map.insert(id, box);
  EXPECT_EQ(failure(map), "");
  // Other centres in the same region, then all removed in another order.
  for (ObjectId id = 1000; id < 1400; ++id) {
    const float x = 3 + 0.01f * static_cast<float>(id - 1000);
    map.insert(id, {{x, 1, 1}, {x + 1, 2, 2}});
  }
  EXPECT_EQ(failure(map), "");
  for (ObjectId id = 0; id < 1000; id += 2) map.move(id, {{5, 1, 1}, {6, 2, static_cast<float>(2 + id % 7)}});
  EXPECT_EQ(failure(map), "");
  for (ObjectId id = 0; id < 1400; ++id) map.remove((id * 37) % 1400);
  EXPECT_EQ(failure(map), "");
  EXPECT_EQ(map.size(), 0u);
}

TEST(ChunkMap, MovesTouchTheSameMemoryHoweverManyThereAre) {
  // A shuttle of moves leaves neither chunks nor groups behind.
  ChunkMap map({kGround, 3});
  Random random(5);
  std::vector<Box> boxes;
  for (ObjectId id = 0; id < 5000; ++id) map.insert(id, boxes.emplace_back(random_box(random, 100, 1)));
  for (int round = 0; round < 3; ++round) {
    for (ObjectId id = 0; id < 5000; ++id) map.move(id, {{90, 0, 70}, {91, 1, 71}});
    for (ObjectId id = 0; id < 5000; ++id) map.move(id, boxes[id]);
  }
  EXPECT_EQ(failure(map), "");
  EXPECT_LT(map.chunk_limit(), 600u);
  EXPECT_LT(map.groups().size(), 600u);
}

// How many chunks do not begin where the one before them in their group ends.
std::size_t strays(const ChunkMap& map) {
  std::size_t count = 0;
  for (const ChunkMap::Group& group : map.groups()) {
    for (std::uint32_t i = 1; i < group.count; ++i) {
      const auto before = map.chunk(group, i - 1), here = map.chunk(group, i);
      count += here.objects != before.objects + before.step;
    }
  }
  return count;
}

TEST(ChunkMap, PutsNeighboursSideBySideOnceMostChunksAreNew) {
  ChunkMap map({kGround, 1});
  Random random(6);
  std::vector<Box> boxes;
  const auto fill = [&](ObjectId limit) {
    while (boxes.size() < limit) {
      const auto id = static_cast<ObjectId>(boxes.size());
      map.insert(id, boxes.emplace_back(random_box(random, 100, 1)));
    }
  };
  fill(20000);
  EXPECT_GT(strays(map), 100u);
  map.tighten();
  EXPECT_EQ(strays(map), 0u);
  EXPECT_EQ(failure(map), "");
  // A few new chunks are not worth it; many are, with the room that removals left behind.
  fill(21000);
  map.tighten();
  const std::size_t few = strays(map);
  EXPECT_GT(few, 0u);
  for (ObjectId id = 0; id < 5000; ++id) map.remove(3 * id);
  fill(50000);
  EXPECT_GT(strays(map), few);
  map.tighten();
  EXPECT_EQ(strays(map), 0u);
  EXPECT_EQ(failure(map), "");
  for (ObjectId id = 0; id < 50000; ++id) {
    if (id % 3 != 0 || id >= 15000) ASSERT_EQ(map.box(id), boxes[id]);
  }
  // Room is given and taken as before.
  for (ObjectId id = 0; id < 5000; ++id) map.insert(3 * id, boxes[3 * id]);
  EXPECT_EQ(failure(map), "");
}

// What comes in bulk leaves chunks no more room than they need, and what comes, moves and goes afterwards
// finds its place all the same.
TEST(ChunkMap, HasLittleMoreRoomThanObjectsAfterABulk) {
  Random random(8);
  ChunkMap map({kGround, 0});
  std::vector<Box> boxes;
  const auto insert = [&](std::size_t count) {
    for (; count > 0; --count) {
      boxes.push_back(random_box(random, 90, 1));
      map.insert(static_cast<ObjectId>(boxes.size() - 1), boxes.back());
    }
    map.tighten();
  };
  const auto room = [&] { return static_cast<double>(map.pool_ids(0).size()); };
  insert(20000), insert(15000), insert(6000);
  EXPECT_LT(room(), 1.18 * 41000);
  EXPECT_EQ(failure(map), "");
  for (int round = 0; round < 10; ++round) {
    insert(500);
    for (int i = 0; i < 300; ++i) {
      const ObjectId moved = random.below(40000), replaced = random.below(40000);
      map.move(moved, boxes[moved] = random_box(random, 90, 1));
      map.remove(replaced);
      map.insert(replaced, boxes[replaced] = random_box(random, 90, 1));
    }
    ASSERT_EQ(failure(map), "") << round;
  }
  for (ObjectId id = 0; id < boxes.size(); ++id) ASSERT_EQ(map.box(id), boxes[id]) << id;
  EXPECT_LT(room(), 1.6 * static_cast<double>(boxes.size()));
}

TEST(ChunkMap, TellsWhichChunksChanged) {
  ChunkMap map({kGround, 3});
  Random random(9);
  for (ObjectId id = 0; id < 2000; ++id) map.insert(id, random_box(random, 100, 1));
  map.acknowledge_changes();
  EXPECT_TRUE(map.changed_chunks().empty());
  std::vector<std::vector<ChunkVertex>> copy(map.chunk_limit());
  const auto refresh = [&](std::uint32_t c) {
    if (c >= copy.size()) copy.resize(c + std::size_t{1});
    copy[c].resize(map.chunk(c).count);
    map.write_vertices(c, copy[c]);
  };
  for (std::uint32_t c = 0; c < map.chunk_limit(); ++c) refresh(c);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 20; ++i) map.move(random.below(2000), random_box(random, 100, 1));
    EXPECT_FALSE(map.changed_chunks().empty());
    for (const std::uint32_t c : map.changed_chunks()) refresh(c);
    map.acknowledge_changes();
    for (std::uint32_t c = 0; c < map.chunk_limit(); ++c) {
      const auto chunk = map.chunk(c);
      ASSERT_EQ(copy[c].size(), chunk.count);
      for (std::uint32_t i = 0; i < chunk.count; ++i) {
        const ChunkVertex& v = copy[c][i];
        ASSERT_EQ(v.object, chunk.objects[i]);
        const Box box = map.box(v.object);
        ASSERT_LE(v.centre.x - v.half_extent.x, box.min.x);
        ASSERT_GE(v.centre.x + v.half_extent.x, box.max.x);
        ASSERT_LE(v.centre.y - v.half_extent.y, box.min.y);
        ASSERT_GE(v.centre.y + v.half_extent.y, box.max.y);
        ASSERT_LE(v.centre.z - v.half_extent.z, box.min.z);
        ASSERT_GE(v.centre.z + v.half_extent.z, box.max.z);
      }
    }
  }
}

}  // namespace
}  // namespace sightline::world
