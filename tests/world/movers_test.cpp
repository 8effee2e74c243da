// What moves: right whatever it does, in the order of its history alone, and settled when it rests.
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "library/world/world_state.hpp"
#include "world/crowd.hpp"

namespace sightline {
namespace {

using namespace test;
using scene::Random;

TEST(Movers, EqualBruteForceAfterTenThousandRandomOperations) {
  Crowd crowd(31, kTwoSectors);
  crowd.insert(4000);
  std::size_t most = 0;
  for (int step = 0; step < 10000; ++step) {
    const std::uint32_t dice = crowd.random().below(100);
    if (dice < 50) {
      crowd.move(0, 40, 1);  // the same again and again
    } else if (dice < 70) {
      crowd.move(crowd.random().below(4000), 1 + crowd.random().below(30), 1);
    } else if (dice < 80) {
      crowd.move(crowd.random().below(4000), 1 + crowd.random().below(30), 0);
    } else if (dice < 81) {
      crowd.move(crowd.random().below(4000), crowd.size() / 2, step % 3 == 0 ? 0.0f : 2.0f);
    } else if (dice < 90) {
      crowd.insert(1 + crowd.random().below(9));
    } else {
      crowd.remove(1 + crowd.random().below(9));
    }
    most = std::max(most, movers_of(crowd.world()));
    if (step % 4 == 0) crowd.cull();  // frames end
    if (step % 100 == 99) {
      expect_sound(crowd.world());
      crowd.expect_right();
    }
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(most, 1000u);
}

// All that begin to move together stand among the movers at once, some of them told twice to move, and what
// they left holds them no more.
TEST(Movers, ManyBeginAtOnce) {
  for (const Box& around : {kOneSector, kTwoSectors}) {
    for (const std::size_t more : {0, 50}) {
      Crowd crowd(41, around);
      crowd.insert(5000);
      crowd.cull();
      // Of few in a sector none are movers.
      const auto expect_movers = [&](std::size_t count) {
        const std::size_t movers = movers_of(crowd.world());
        EXPECT_LE(movers, count);
        EXPECT_GE(movers, around == kOneSector ? count : count / 2);
      };
      crowd.move(0, 700, 1);
      expect_movers(700);
      crowd.move(300, 2000, 1);
      expect_movers(2300);
      crowd.move(0, 5000 + more, 1);
      expect_movers(5000);
      expect_sound(crowd.world());
      crowd.expect_right();
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

// What says who is seen goes with them.
TEST(Movers, ManyTakeTheirLayersAlong) {
  Random random(42);
  const Box around{{-20, -20, -60}, {20, 20, -20}};
  std::vector<Box> boxes;
  std::vector<std::uint32_t> layers;
  for (std::uint32_t i = 0; i < 3000; ++i)
    boxes.push_back(test::random_box(random, around)), layers.push_back(1u << random.below(2));
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  ASSERT_TRUE(world.set_layers(handles, layers));
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(world));
  for (int frame = 0; frame < 3; ++frame) {
    std::size_t seen = 0;
    for (const std::uint32_t layer : {1u, 2u}) {
      CullView view{.view = {*make_view({}, 64, 64), {}}};
      view.layers = layer;
      const CullResult result = *culler.cull(world, view, visible);
      for (std::size_t i = 0; i < result.count; ++i) EXPECT_EQ(layers[visible[i]], layer);
      seen += result.count;
    }
    EXPECT_GT(seen, 1000u);
    ASSERT_TRUE(world.move(handles, BoxView(boxes)));
    expect_sound(world);
  }
  EXPECT_EQ(movers_of(world), handles.size());
}

// Where others move each time pages begin in the second frame; where the same do, they stand well as they
// are.
TEST(Movers, PagesBeginOnceOthersMove) {
  for (const bool others : {false, true}) {
    Crowd crowd(43, {{-300, -50, -300}, {300, 50, 300}});
    crowd.insert(6000);
    for (int frame = 0; frame < 4; ++frame) {
      if (others) crowd.shuffle();
      crowd.move(0, 3000, 1);
      EXPECT_EQ(keeps_pages(crowd.world()), others && frame > 0) << frame;
      expect_sound(crowd.world());
      crowd.expect_right();
      crowd.cull();
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

// All settle when nobody moves, a part a frame, and a world that is given up leaves nothing behind.
TEST(Movers, SettleWhenTheyRest) {
  Crowd crowd(32, kOneSector);
  crowd.insert(6000);
  EXPECT_EQ(movers_of(crowd.world()), 0u);
  for (int frame = 0; frame < 5; ++frame) {
    crowd.move(0, 3000, 1);
    crowd.cull();
  }
  EXPECT_EQ(movers_of(crowd.world()), 3000u);
  std::size_t before = 3000;
  for (int frame = 0; frame < 1000; ++frame) {
    crowd.move(0, 100, 1);
    crowd.cull();
    const std::size_t now = movers_of(crowd.world());
    ASSERT_GE(now + 64 + before / 64, before) << "too much in one frame";
    before = now;
  }
  EXPECT_EQ(before, 100u);
  expect_sound(crowd.world());
  crowd.expect_right();
  for (int frame = 0; frame < 600; ++frame) {
    crowd.move(0, 0, 1);
    crowd.cull();
  }
  EXPECT_EQ(movers_of(crowd.world()), 0u);
  EXPECT_TRUE(WorldAccess::state(crowd.world()).awake.empty());
  expect_sound(crowd.world());
  crowd.remove(crowd.size());
  EXPECT_TRUE(WorldAccess::state(crowd.world()).sector_of_cell.empty());
}

// Half of all, others each frame, within one sector and across two; come, gone and listed twice; at last
// none.
TEST(Movers, ThoseThatMoveInNoOrderStandInPages) {
  for (const Box& around : {kOneSector, kTwoSectors}) {
    Crowd crowd(34, around);
    crowd.insert(6000);
    bool kept = false;
    for (int frame = 0; frame < 60; ++frame) {
      crowd.shuffle();
      crowd.move(0, 3000, frame % 5 == 0 ? 0.0f : 2.0f);
      kept = kept || keeps_pages(crowd.world());
      if (frame % 7 == 3) crowd.remove(40), crowd.insert(45);
      crowd.move(crowd.size() - 1, 2, 1);
      if (frame % 10 == 9) expect_sound(crowd.world()), crowd.expect_right();
      crowd.cull();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_TRUE(kept);
    EXPECT_GT(movers_of(crowd.world()), 5000u);
    for (int frame = 0; frame < 1500 && movers_of(crowd.world()) > 0; ++frame)
      crowd.move(0, 0, 1), crowd.cull();
    EXPECT_EQ(movers_of(crowd.world()), 0u);
    expect_sound(crowd.world());
    crowd.expect_right();
    crowd.move(0, 1, 1);
    EXPECT_FALSE(keeps_pages(crowd.world()));
  }
}

// Many listed in no order are moved in that of their pages, some at a time; of one listed again the last
// counts.
TEST(Movers, OfThoseListedAgainInNoOrderTheLastCounts) {
  for (const Box& around : {kOneSector, kTwoSectors}) {
    Crowd crowd(36, around);
    crowd.insert(6000);
    for (int frame = 0; frame < 12; ++frame) {
      crowd.shuffle();
      crowd.give(kForms[frame % kForms.size()]);
      crowd.move(0, crowd.size() / 2, 2);
      crowd.move(0, crowd.size(), 2, 200);
      crowd.expect_boxes();
      crowd.cull();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_TRUE(keeps_pages(crowd.world()));
    expect_sound(crowd.world());
    crowd.expect_right();
  }
}

// Sorted in single precision about their sector, as long as all stay in it; then as they are.
TEST(Movers, ThoseListedInNoOrderMayLeaveTheirSector) {
  for (const Form form : kForms) {
    Crowd crowd(46, kOneSector);
    crowd.give(form);
    crowd.insert(6000);
    for (int frame = 0; frame < 6; ++frame) {
      crowd.shuffle();
      if (frame == 4) crowd.go({{-1000, -50, -1000}, {2e6f, 50, 1000}});
      crowd.move(0, crowd.size(), frame < 4 ? 2.0f : 0.0f);
      EXPECT_EQ(WorldAccess::state(crowd.world()).sector_of_cell.size() > 1, frame >= 4);
      crowd.expect_boxes();
      expect_sound(crowd.world());
      crowd.expect_right();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_TRUE(keeps_pages(crowd.world()));
  }
}

// Others each frame in the order of their ids, of which many fall in each page: they are written together,
// also beside holes, where some come to their pages only now, and where some go far.
TEST(Movers, ThoseThatMoveInTheOrderOfTheirIdsStandInPages) {
  for (const Box& around : {kOneSector, kTwoSectors}) {
    Crowd crowd(35, around);
    crowd.insert(6000);
    for (int frame = 0; frame < 60; ++frame) {
      const std::size_t count = crowd.size() / (frame % 2 == 0 ? 2 : 4);
      crowd.choose(count);
      crowd.move(0, count, frame % 5 == 4 ? 0.0f : 2.0f);
      if (frame % 7 == 3) crowd.remove(40), crowd.insert(45);
      if (frame % 5 == 4) expect_sound(crowd.world()), crowd.expect_right();
      crowd.cull();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_TRUE(keeps_pages(crowd.world()));
    EXPECT_GT(movers_of(crowd.world()), 5000u);
  }
}

// Those who come later have pages, too, behind those that were there; and rows of boxes grow with them.
TEST(Movers, PagesGrowWithTheWorld) {
  Crowd crowd(37, kOneSector);
  crowd.insert(3000);
  for (int frame = 0; frame < 40; ++frame) {
    crowd.shuffle();
    crowd.move(0, crowd.size() / 2, 2);
    if (frame % 4 == 3) crowd.insert(1000);
    if (frame % 10 == 9) expect_sound(crowd.world()), crowd.expect_right();
    crowd.cull();
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_TRUE(keeps_pages(crowd.world()));
  EXPECT_GT(movers_of(crowd.world()), 9000u);
}

// However many stand still, the first that moves needs less memory than a large page, which takes its time to
// come.
TEST(Movers, TheFirstWaitForNoLargePages) {
  Crowd crowd(45, kOneSector);
  crowd.insert(100'000);
  crowd.cull();
  crowd.move(0, 1, 0);
  ASSERT_EQ(movers_of(crowd.world()), 1u);
  const world::ChunkMap& map = *WorldAccess::state(crowd.world()).sectors[0].map;
  std::uint32_t chunk = 0;
  while (!map.holds_movers(chunk)) ++chunk;
  EXPECT_LT(6 * sizeof(float) * map.chunk(chunk).step, geometry::kLargePage);
  EXPECT_LT(sizeof(ObjectId) * map.pool_ids(1).size(), geometry::kLargePage);
}

// More of them than the longest rows hold, in the order in which they came and then in pages: other rows
// follow, of movers that came one by one, too.
TEST(Movers, RowsFollowTheLongest) {
  Crowd crowd(44, kOneSector);
  crowd.insert(70'000);
  crowd.cull();
  for (const std::size_t count : {1, 100, 70'000}) {
    crowd.move(0, count, 1);
    crowd.cull();
  }
  EXPECT_EQ(movers_of(crowd.world()), 70'000u);
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(keeps_pages(crowd.world()), frame > 1) << frame;
    expect_sound(crowd.world());
    crowd.expect_right();
    crowd.shuffle();
    crowd.move(0, 70'000, 1);
    if (testing::Test::HasFatalFailure()) return;
  }
}

// Pages have room for all ids of the world, of which each of five sectors holds few.
TEST(Movers, PagesOfManySectorsHaveRoom) {
  Crowd crowd(39, {{-1600, -50, -1000}, {14400, 50, 1000}});
  crowd.insert(10000);
  std::size_t with_pages = 0;
  for (int frame = 0; frame < 12; ++frame) {
    crowd.shuffle();
    crowd.move(0, crowd.size(), 2);
    if (frame % 4 == 3) expect_sound(crowd.world()), crowd.expect_right();
    crowd.cull();
    if (testing::Test::HasFatalFailure()) return;
    with_pages = std::max(with_pages, sectors_with_pages(crowd.world()));
  }
  EXPECT_GE(with_pages, 4u);
}

// Where others go anywhere each frame, who went is not filed, for he will go again soon. Once fewer go, all
// are.
TEST(Movers, WhoSoonMovesAgainIsNotFiled) {
  Crowd crowd(38, kOneSector);
  crowd.insert(10000);
  for (int frame = 0; frame < 400; ++frame) {
    crowd.shuffle();
    crowd.move(0, 100, 0);
    crowd.cull();
  }
  EXPECT_GT(movers_of(crowd.world()), 7000u);
  expect_sound(crowd.world());
  crowd.expect_right();
  for (int frame = 0; frame < 1500 && movers_of(crowd.world()) > 0; ++frame)
    crowd.move(0, 0, 1), crowd.cull();
  EXPECT_EQ(movers_of(crowd.world()), 0u);
  expect_sound(crowd.world());
  crowd.expect_right();
}

// A handle of before is refused there, too, and one that nobody was ever given.
TEST(Movers, StaleHandlesAreRefusedWherePagesAre) {
  World world;
  Random random(36);
  std::vector<Box> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(test::random_box(random, kOneSector));
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(world));
  for (int frame = 0; frame < 6; ++frame) {
    std::vector<Handle> some;
    std::vector<Box> to;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t at = random.below(3000);
      some.push_back(handles[at]), to.push_back(boxes[at]);
    }
    ASSERT_TRUE(world.move(some, BoxView(to)));
    ASSERT_TRUE(culler.cull(world, CullView{.view = {*make_view({}, 64, 64), {}}}, visible));
  }
  ASSERT_TRUE(keeps_pages(world));
  const Handle gone = handles[7];
  ASSERT_TRUE(world.remove(std::span(&gone, 1)));
  for (const Handle bad : {gone, Handle{gone.index, gone.generation + 1}, Handle{gone.index, 0xffffffffu},
                           Handle{3000, 0}, Handle{kNoObject, 0}})
    EXPECT_EQ(world.move(std::span(&bad, 1), BoxView(std::span(boxes).first(1))).code(),
              StatusCode::stale_handle)
        << bad.index << " " << bad.generation;
  Handle anew;
  ASSERT_TRUE(world.insert(BoxView(std::span(boxes).first(1)), std::span(&anew, 1)));
  EXPECT_EQ(anew.index, gone.index);
  EXPECT_TRUE(world.move(std::span(&anew, 1), BoxView(std::span(boxes).first(1))));
  EXPECT_FALSE(world.move(std::span(&gone, 1), BoxView(std::span(boxes).first(1))));
}

// What moves a little stays where it stands: chunks are not searched again.
TEST(Movers, SmallMovesStayInTheirChunk) {
  Crowd crowd(33, kOneSector);
  crowd.insert(20000);
  for (int frame = 0; frame < 40; ++frame) {
    crowd.move(static_cast<std::size_t>(frame) * 500, 500, 0.2f);
    crowd.cull();
  }
  EXPECT_LT(movers_of(crowd.world()), 1000u);
  expect_sound(crowd.world());
  crowd.expect_right();
}

}  // namespace
}  // namespace sightline
