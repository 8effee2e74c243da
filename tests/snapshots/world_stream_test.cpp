// Sectors in and out of a world: within a budget, beside another thread, and with the handles that they had.
#include <sightline/instances.hpp>
#include <sightline/ranges.hpp>
#include <sightline/snapshot.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <thread>
#include <utility>

#include "support/placed.hpp"
#include "support/random_views.hpp"
#include "support/snapshots.hpp"
#include "support/solid_boxes.hpp"
#include "support/world_twin.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::FileBytes;

constexpr float kSide = 16'000;

// Boxes on a ground of 10 × 10 sectors, lain in bytes.
struct Ground {
  World world;
  std::vector<Handle> handles;
  FileBytes bytes;

  explicit Ground(std::size_t count = 20'000) {
    Random random(5);
    std::vector<Box> boxes;
    while (boxes.size() < count) {
      const Vec3 at = random.inside({{-kSide, -20, -kSide}, {kSide, 20, kSide}});
      boxes.push_back(test::box_at(at, {random.between(1, 30), random.between(1, 30), 5}));
    }
    handles.resize(count);
    EXPECT_TRUE(world.insert(BoxView(boxes), handles));
    bytes = test::saved(world);
  }
};

CullView looking_from(const Vec3& eye, float heading, float far_plane = 4000) {
  Camera camera{.eye = eye, .forward = {std::sin(heading), 0, std::cos(heading)}};
  camera.near_plane = 0.1f, camera.far_plane = far_plane, camera.vertical_fov = 1;
  return {.view = {*make_view(camera, 1280, 720), {}}};
}

// Views that have no sector in common.
std::pair<CullView, CullView> from_opposite_corners() {
  return {looking_from({-kSide, 0, -kSide}, 0.7f), looking_from({kSide, 0, kSide}, 3.9f)};
}

// The ground's world as its bytes bring it in.
struct Streamed {
  Ground ground;
  World world;
  Result<WorldStream> stream;

  explicit Streamed(std::size_t count = 20'000)
      : ground(count), stream(WorldStream::open(ground.bytes, world)) {
    EXPECT_TRUE(stream);
  }
};

// What all of the ground's boxes show, less those whose sectors are out, is what is seen.
void expect_all_that_is_in(const Ground& ground, const World& world, const WorldStream& stream,
                           const CullView& view) {
  std::set<ObjectId> seen;
  for (const auto& [id, mask, level] : test::seen(world, {&view, 1})) seen.insert(id);
  for (const auto& [id, mask, level] : test::seen(ground.world, {&view, 1})) {
    const Handle handle = ground.world.handle(id);
    ASSERT_NE(world.contains(handle), stream.stands_out(handle)) << id;
    ASSERT_EQ(seen.erase(id), world.contains(handle)) << id;
  }
  ASSERT_TRUE(seen.empty()) << "more is seen than there is";
}

std::size_t memory_of_all(const WorldStream& stream) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) sum += stream.sector(i).memory;
  return sum;
}

// An order learns of the chunks that come with a sector, also where one went and came again between two
// updates.
TEST(WorldStream, OrdersFollowWhatComesAndGoes) {
  Streamed streamed;
  auto& [ground, world, stream] = streamed;
  const StreamOptions options{.budget = memory_of_all(*stream) / 4};
  ObjectOrder order;
  RangeCuller culler;
  std::vector<ObjectId> slots;
  std::size_t drawn = 0, all = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const CullView view = looking_from({-kSide + 800.0f * frame, 0, 0}, 0.05f * frame);
    ASSERT_TRUE(stream->bring_in({&view, 1}, options));
    const CullView behind = looking_from({kSide - 800.0f * frame, 0, 0}, 3);
    if (frame % 3 == 0) {
      ASSERT_TRUE(stream->bring_in({&behind, 1}, options));
      ASSERT_TRUE(stream->bring_in({&view, 1}, options));
    }
    const auto changes = order.update(world);
    ASSERT_TRUE(changes);
    slots.resize(order.slot_limit(), kNoObject);
    for (const auto& [slot, object] : *changes)
      if (slot < slots.size()) slots[slot] = object;
    const auto ranges = culler.cull(world, order, view);
    ASSERT_TRUE(ranges) << ranges.error().message();
    std::multiset<ObjectId> by_slots, by_ids;
    for (const auto& [first, count] : ranges->ranges)
      for (std::uint32_t i = 0; i < count; ++i) by_slots.insert(slots[first + i]);
    for (const auto& [id, mask, level] : test::seen(world, {&view, 1})) by_ids.insert(id);
    ASSERT_EQ(by_slots, by_ids) << frame;
    drawn += by_ids.size(), all += world.size();
  }
  EXPECT_GT(drawn, 1000u);
  EXPECT_LT(drawn, all / 2);
}

TEST(WorldStream, WithAllSectorsInItAnswersAsTheWorldThatWasSaved) {
  Streamed streamed;
  auto& [ground, world, stream] = streamed;
  EXPECT_EQ(world.size(), 0u);
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const CullView view =
        looking_from(random.inside({{-kSide, 0, -kSide}, {kSide, 9, kSide}}), random.unit());
    const auto report = stream->bring_in({&view, 1});
    ASSERT_TRUE(report);
    ASSERT_EQ(report->missing, 0u);
    expect_all_that_is_in(ground, world, *stream, view);
  }
  const CullView view = looking_from({0, 0, 0}, 0);
  for (StreamReport report; report.in < stream->size();) {
    report = *stream->update({&view, 1}, {.ahead = 1e9});
    while (stream->work()) {
    }
  }
  test::expect_same_objects(ground.world, world);
  const CullView wide = looking_from({0, 0, -kSide}, 0, 3 * kSide);
  EXPECT_EQ(test::seen(ground.world, {&wide, 1}), test::seen(world, {&wide, 1}));
  EXPECT_EQ(test::saved(world), ground.bytes);
}

TEST(WorldStream, StaysWithinItsBudgetBesideAThreadThatReads) {
  Streamed streamed;
  auto& [ground, world, stream] = streamed;
  std::atomic<bool> done{false};
  std::vector<std::thread> readers;
  for (int i = 0; i < 2; ++i)
    readers.emplace_back([&] {
      while (!done.load())
        if (!stream->work()) std::this_thread::yield();
    });
  const StreamOptions options{.budget = memory_of_all(*stream) / 3, .ahead = 1000};
  std::size_t frames = 0, came = 0, complete = 0;
  for (float along = -kSide; along < kSide && !testing::Test::HasFatalFailure(); along += 100, ++frames) {
    const CullView view = looking_from({0.5f * along, 3, along}, 0.01f * along);
    auto report = stream->update({&view, 1}, options);
    // The readers are waited for now and then, so that all that is in view is there.
    for (; report && report->coming > 0 && frames % 8 == 0; report = stream->update({&view, 1}, options))
      std::this_thread::yield();
    ASSERT_TRUE(report);
    ASSERT_LE(report->memory, options.budget);
    std::size_t in = 0;
    for (std::size_t s = 0; s < stream->size(); ++s) {
      const StreamSector sector = stream->sector(s);
      if (sector.state == SectorState::in || sector.state == SectorState::coming) in += sector.memory;
    }
    ASSERT_EQ(in, report->memory);
    came = std::max(came, report->in), complete += report->missing == 0;
    if (frames % 8 == 0) ASSERT_EQ(report->missing, 0u);
    expect_all_that_is_in(ground, world, *stream, view);
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_GT(came, 3u);
  EXPECT_GE(complete, frames / 8);
  test::expect_sound(world);
}

TEST(WorldStream, HandlesNameTheSameObjectsAgain) {
  Streamed streamed(5000);
  auto& [ground, world, stream] = streamed;
  const auto& [here, there] = from_opposite_corners();
  const StreamOptions options{.budget = memory_of_all(*stream) / 10};
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(stream->bring_in({i % 2 ? &here : &there, 1}, options));
    std::size_t in = 0;
    for (const Handle handle : ground.handles) {
      ASSERT_NE(world.contains(handle), stream->stands_out(handle));
      if (!world.contains(handle)) continue;
      ++in;
      ASSERT_EQ(world.box(handle), ground.world.box(handle));
    }
    EXPECT_EQ(in, world.size());
    EXPECT_GT(in, 0u);
  }
  EXPECT_FALSE(stream->stands_out({}));
  for (const Handle handle : ground.handles) {
    if (world.contains(handle)) continue;
    EXPECT_EQ(world.remove(std::span(&handle, 1)).code(), StatusCode::stale_handle);
    break;
  }
}

TEST(WorldStream, WhatWasChangedStaysInAndWhatWasPutThereComesTogether) {
  Streamed streamed(5000);
  auto& [ground, world, stream] = streamed;
  const auto& [here, there] = from_opposite_corners();
  // Before its sector has come.
  const Box box = test::box_at({-kSide + 10, 0, -kSide + 20}, {1, 1, 1});
  Handle added;
  ASSERT_TRUE(world.insert(BoxView(std::span(&box, 1)), std::span(&added, 1)));
  EXPECT_EQ(added.index, 5000u);
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  std::vector<Handle> in;
  for (const Handle handle : ground.handles)
    if (world.contains(handle)) in.push_back(handle);
  ASSERT_EQ(world.size(), in.size() + 1);
  test::expect_sound(world);
  const auto count = [&](SectorState state) {
    std::size_t sectors = 0;
    for (std::size_t s = 0; s < stream->size(); ++s) sectors += stream->sector(s).state == state;
    return sectors;
  };
  EXPECT_EQ(count(SectorState::changed), 1u);
  // A value, which no map knows.
  const std::uint32_t value = 77;
  Handle valued = in.front();
  for (const Handle handle : in)
    if (world.box(handle).min.x > -kSide + 4000) valued = handle;
  ASSERT_TRUE(world.set_values(std::span<const Handle>(&valued, 1), std::span(&value, 1)));
  EXPECT_EQ(count(SectorState::changed), 2u);
  // All others go.
  ASSERT_TRUE(stream->bring_in({&there, 1}, {.budget = 1}));
  EXPECT_EQ(count(SectorState::in), 0u);
  EXPECT_EQ(count(SectorState::changed), 2u);
  EXPECT_TRUE(world.contains(added));
  EXPECT_EQ(world.value(valued), 77u);
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  for (const Handle handle : in) ASSERT_TRUE(world.contains(handle));
  test::expect_sound(world);
  std::set<ObjectId> once;
  for (const auto& [id, mask, level] : test::seen(world, {&here, 1})) ASSERT_TRUE(once.insert(id).second);
}

// A column's first use changes the objects that it is set of, and leaves all other sectors free to go.
TEST(WorldStream, AFirstColumnPinsOnlyTheSectorsThatItIsSetIn) {
  Streamed streamed(5000);
  auto& [ground, world, stream] = streamed;
  const auto& [here, there] = from_opposite_corners();
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  const std::size_t before = world.size();
  Handle one;
  for (const Handle handle : ground.handles)
    if (world.contains(handle)) one = handle;
  const std::uint32_t layers = 4;
  ASSERT_TRUE(world.set_layers(std::span<const Handle>(&one, 1), std::span(&layers, 1)));
  ASSERT_TRUE(stream->bring_in({&there, 1}, {.budget = 1}));
  EXPECT_TRUE(world.contains(one));
  EXPECT_LT(world.size(), before / 2);
  // What went comes back as it was.
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  EXPECT_EQ(world.size(), before);
  for (const Handle handle : ground.handles)
    if (world.contains(handle)) ASSERT_EQ(world.layers(handle), handle == one ? 4 : kAllLayers);
  test::expect_sound(world);
}

TEST(WorldStream, WhatObjectsCarriedIsForgottenWhenTheyGo) {
  Streamed streamed(2000);
  auto& [ground, world, stream] = streamed;
  const CullView here = looking_from({0, 0, 0}, 0), there = looking_from({kSide, 0, kSide}, 0.7f);
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  const auto occluder = world.add_occluder(test::kUnitBox);
  ASSERT_TRUE(occluder);
  const Handle handle = world.handle(std::get<0>(test::seen(world, {&here, 1}).at(0)));
  OccluderPlacement placement{*occluder};
  ASSERT_TRUE(world.set_occluders(std::span(&handle, 1), std::span(&placement, 1)));
  EXPECT_FALSE(world.remove_occluder(*occluder));
  ASSERT_TRUE(stream->bring_in({&there, 1}, {.budget = 1}));
  EXPECT_TRUE(stream->stands_out(handle));
  EXPECT_TRUE(std::ranges::count(stream->went(), handle));
  EXPECT_TRUE(world.remove_occluder(*occluder));
  // Who comes again is given another.
  ASSERT_TRUE(stream->bring_in({&here, 1}));
  placement.occluder = *world.add_occluder(test::kUnitBox);
  const std::vector<OccluderPlacement> placements(stream->came().size(), placement);
  ASSERT_TRUE(std::ranges::count(stream->came(), handle));
  ASSERT_TRUE(world.set_occluders(stream->came(), placements));
}

std::set<ObjectId> ids_of(std::span<const Handle> handles, const World& of) {
  std::set<ObjectId> out;
  for (const Handle handle : handles) {
    EXPECT_EQ(handle, of.handle(handle.index));
    EXPECT_TRUE(out.insert(handle.index).second) << handle.index << " is listed twice";
  }
  return out;
}

// A small budget and sectors that become ready late: some are put in that nobody wants any more, and go at
// once.
TEST(WorldStream, ListsWhoCameAndWhoWent) {
  Streamed streamed(5000);
  auto& [ground, world, stream] = streamed;
  Random random(11);
  std::set<ObjectId> in;
  std::size_t came = 0, went = 0;
  for (int i = 0; i < 300; ++i) {
    const CullView view =
        looking_from(random.inside({{-kSide, 0, -kSide}, {kSide, 9, kSide}}), random.between(-3, 3), 9000);
    const StreamOptions options{.budget = memory_of_all(*stream) / (2 + random.below(30)), .ahead = 0};
    ASSERT_TRUE(random.below(4) == 0 ? stream->bring_in({&view, 1}, options)
                                     : stream->update({&view, 1}, options));
    std::set<ObjectId> now;
    for (const Handle handle : ground.handles)
      if (world.contains(handle)) now.insert(handle.index);
    std::set<ObjectId> newly, gone;
    std::ranges::set_difference(now, in, std::inserter(newly, newly.end()));
    std::ranges::set_difference(in, now, std::inserter(gone, gone.end()));
    ASSERT_EQ(ids_of(stream->came(), ground.world), newly) << i;
    ASSERT_EQ(ids_of(stream->went(), ground.world), gone) << i;
    came += newly.size(), went += gone.size();
    in = std::move(now);
    for (std::uint32_t works = random.below(4); works > 0; --works) stream->work();
  }
  EXPECT_GT(came, 5000u);
  EXPECT_GT(went, 5000u);
  // A call that is refused changes nothing.
  const CullView view = looking_from({0, 0, 0}, 0);
  ASSERT_TRUE(stream->bring_in({&view, 1}));
  const std::size_t last = stream->came().size();
  EXPECT_GT(last, 0u);
  EXPECT_FALSE(stream->update({}));
  EXPECT_FALSE(stream->bring_in({&view, 1}, {.ahead = -1}));
  EXPECT_EQ(stream->came().size(), last);
}

// Two sectors: a row of boxes along z in the first, and a few in the next.
struct NearAndFar {
  static constexpr std::size_t kNear = 3000;
  std::vector<Handle> handles;
  FileBytes bytes;

  NearAndFar() {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < kNear; ++i)
      boxes.push_back(test::box_at({0, 0, -static_cast<float>(i) / 3}, {1, 1, 1}));
    for (int i = 0; i < 10; ++i) boxes.push_back(test::box_at({0, 0, -4000.0f - i}, {1, 1, 1}));
    handles.resize(boxes.size());
    World world;
    EXPECT_TRUE(world.insert(BoxView(boxes), handles));
    bytes = test::saved(world);
  }
};

// A sector that makes room for one that turns out to be damaged, and is taken in again: its objects carry
// nothing any more.
TEST(WorldStream, ListsTwiceWhoWentAndCameAgain) {
  NearAndFar two;
  const std::span near = std::span(two.handles).first(NearAndFar::kNear),
                  far = std::span(two.handles).subspan(NearAndFar::kNear);
  World world;
  auto stream = WorldStream::open(two.bytes, world);
  ASSERT_TRUE(stream && stream->size() == 2);
  const StreamSector large = stream->sector(stream->sector(0).objects == near.size() ? 0 : 1);
  ASSERT_EQ(large.objects, near.size());
  two.bytes[large.first_byte + 1000] ^= std::byte{1};
  constexpr float kAhead = std::numbers::pi_v<float>;
  const CullView beyond = looking_from({0, 0, -3900}, kAhead, 500),
                 both = looking_from({0, 0, 10}, kAhead, 8000);
  ASSERT_TRUE(stream->bring_in({&beyond, 1}));
  ASSERT_EQ(stream->came().size(), far.size());
  const OccluderId occluder = *world.add_occluder(test::kUnitBox);
  const std::vector<OccluderPlacement> placements(far.size(), OccluderPlacement{occluder});
  ASSERT_TRUE(world.set_occluders(stream->came(), placements));
  const auto report = stream->bring_in({&both, 1}, {.budget = large.memory});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->damaged, 1u);
  EXPECT_TRUE(world.contains(far[0]) && !world.contains(near[0]));
  EXPECT_EQ(ids_of(stream->came(), world).size(), far.size());
  EXPECT_EQ(stream->went().size(), far.size());
  // Nobody carries it any more, until those that came are given it again.
  ASSERT_TRUE(world.set_occluders(stream->came(), placements));
  EXPECT_FALSE(world.remove_occluder(occluder));
}

// Instances of a streamed world show what those of the whole one show, less what is out; and a cull is
// refused until they were told that the world reaches farther than it did.
TEST(WorldStream, InstancesShowWhatIsIn) {
  Streamed streamed(5000);
  auto& [ground, world, stream] = streamed;
  Instances whole, parts;
  const PlacedWorldId of_whole = *whole.add_world(ground.world), of_parts = *parts.add_world(world);
  Random random(7);
  std::vector<InstancePlacement> placements;
  for (const float scale : {1.0f, 0.25f, 0.5f})
    placements.push_back(
        {of_whole,
         test::random_turn(random, scale, random.inside({{-kSide, -99, -kSide}, {kSide, 99, kSide}})),
         {}});
  std::vector<Handle> handles(placements.size());
  ASSERT_TRUE(whole.insert(placements, handles));
  for (InstancePlacement& placement : placements) placement.world = of_parts;
  ASSERT_TRUE(parts.insert(placements, handles));
  const StreamOptions options{.budget = memory_of_all(*stream) / 4};
  InstanceCuller all_culler, culler;
  std::size_t shown = 0, out = 0, refused = 0;
  for (int step = 0; step < 30; ++step) {
    const CullView near = looking_from({-kSide + 1000.0f * step, 0, 0}, 0.2f * step, 2 * kSide);
    ASSERT_TRUE(stream->bring_in({&near, 1}, options));
    const auto cull = [&] { return culler.cull(parts, near); };
    if (const auto early = cull(); !early) {
      ++refused;
      ASSERT_EQ(early.error().code(), StatusCode::bad_argument);
      ASSERT_EQ(early.error().index(), of_parts);
    }
    ASSERT_TRUE(parts.update());
    const auto now = cull();
    ASSERT_TRUE(now) << now.error().message();
    test::AllSaid left = test::all_said(*now);
    for (const auto& [which, said] : test::all_said(*all_culler.cull(whole, near))) {
      const bool in = world.contains(ground.world.handle(which.second));
      ASSERT_EQ(left.erase(which), in) << which.first << ", " << which.second;
      (in ? shown : out) += 1;
    }
    ASSERT_TRUE(left.empty()) << "more is seen than there is";
  }
  EXPECT_GT(shown, 1000u);
  EXPECT_GT(out, 1000u);
  EXPECT_GT(refused, 0u);
}

TEST(WorldStream, RefusesWhatIsNoView) {
  Streamed streamed(100);
  auto& [ground, world, stream] = streamed;
  EXPECT_EQ(stream->update({}).error().code(), StatusCode::bad_argument);
  CullView view = looking_from({0, 0, 0}, 0);
  EXPECT_EQ(stream->update({&view, 1}, {.ahead = -1}).error().code(), StatusCode::bad_argument);
  view.view.view.world_to_eye.m[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(stream->update({&view, 1}).error().code(), StatusCode::bad_view);
  EXPECT_EQ(stream->sector(10'000).objects, 0u);
}

}  // namespace
}  // namespace sightline
