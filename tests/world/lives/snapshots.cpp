#include "support/snapshots.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

bool comes(SectorState state) {
  return state == SectorState::in || state == SectorState::changed || state == SectorState::coming;
}

void expect_report(const Streaming& streaming, const StreamReport& report) {
  std::size_t in = 0, coming = 0, memory = 0;
  for (std::size_t i = 0; i < streaming.stream->size(); ++i) {
    const StreamSector sector = streaming.stream->sector(i);
    if (comes(sector.state)) memory += sector.memory, ++(sector.state == SectorState::coming ? coming : in);
  }
  ASSERT_EQ(report.damaged, 0u);
  ASSERT_EQ(report.in, in);
  ASSERT_EQ(report.coming, coming);
  ASSERT_EQ(report.memory, memory);
  ASSERT_LE(report.memory, streaming.budget);
}

// Who came and who went with the last update, before it is noted.
void expect_passed(const Life& life, const World& world) {
  std::vector<Handle> came, went;
  for (const ObjectId id : life.model.standing) {
    const Object& object = life.model.objects[id];
    if (world.contains(object.handle) != object.in) (object.in ? went : came).push_back(object.handle);
  }
  const auto expect_same = [](std::vector<Handle> expected, std::span<const Handle> listed) {
    std::vector<Handle> found(listed.begin(), listed.end());
    std::ranges::sort(expected, {}, &Handle::index);
    std::ranges::sort(found, {}, &Handle::index);
    ASSERT_EQ(found, expected);
  };
  expect_same(came, life.streaming->stream->came());
  expect_same(went, life.streaming->stream->went());
}

// Notes who is in now. Whoever came is as he was, and who has changed since the stream began stays.
void expect_in_or_out(Life& life) {
  World& world = life.world();
  for (const ObjectId id : life.model.standing) {
    Object& object = life.model.objects[id];
    object.in = world.contains(object.handle);
    if (object.changed) ASSERT_TRUE(object.in) << "object " << id << " was changed, and went out";
    if (!object.in) ASSERT_TRUE(life.streaming->stream->stands_out(object.handle)) << id;
  }
  expect_objects(world, life.model, life.model.standing);
}

void bring_all_in(Life& life, std::span<const CullView> views) {
  WorldStream& stream = *life.streaming->stream;
  StreamOptions options;
  options.ahead = 1e12;
  for (std::size_t i = 0; i < 2 * stream.size() + 8; ++i) {
    while (stream.work()) {
    }
    ASSERT_TRUE(stream.update(views, options));
  }
  expect_in_or_out(life);
  ASSERT_EQ(life.model.all().size(), life.model.standing.size());
}

}  // namespace

// The same world gives the same bytes, and these a world that lives on beside it, until the next one.
void save_and_load(Life& life) {
  if (life.streaming) {
    std::vector<std::byte> bytes;
    const bool whole = life.model.all().size() == life.model.standing.size();
    const Status done = save(life.world(), test::sink_into(bytes));
    ASSERT_TRUE(whole || done.code() == StatusCode::bad_argument) << done.message();
    return;
  }
  const std::vector<std::byte> bytes = test::saved(life.world());
  ASSERT_EQ(test::saved(life.lanes[1]->world), bytes);
  Result<World> loaded = load(bytes);
  ASSERT_TRUE(loaded) << loaded.error().message();
  test::expect_same_objects(life.world(), *loaded);
  if (life.lanes.size() > 2) life.lanes.pop_back();
  auto lane = std::make_unique<Lane>(Lane::loaded);
  lane->world = *std::move(loaded);
  life.add_lane(std::move(lane));
}

// From here on there is one lane, whose sectors come and go.
void begin_stream(Life& life) {
  if (life.streaming || !life.plan.streams || life.model.standing.empty()) return;
  Random& random = life.random;
  const std::vector<std::byte> bytes = test::saved(life.world());
  life.lanes.clear();
  life.streaming.emplace().bytes = bytes;
  auto lane = std::make_unique<Lane>(Lane::first);
  Result<WorldStream> opened = WorldStream::open(life.streaming->bytes, lane->world);
  ASSERT_TRUE(opened) << opened.error().message();
  WorldStream& stream = life.streaming->stream.emplace(*std::move(opened));
  life.add_lane(std::move(lane));
  std::size_t total = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) total += stream.sector(i).memory;
  const double share = double{random.between(0.2f, 1.1f)};
  life.streaming->budget = ~std::size_t{0};
  if (one_in(random, 2))
    life.streaming->budget = static_cast<std::size_t>(share * static_cast<double>(total));
  for (const ObjectId id : life.model.standing) life.model.objects[id].in = false;
  ASSERT_EQ(life.world().size(), 0u);
}

void stream(Life& life) {
  if (!life.streaming) return;
  Random& random = life.random;
  WorldStream& stream = *life.streaming->stream;
  const std::vector<CullView> views = life.any_views(true);
  StreamOptions options;
  options.budget = life.streaming->budget;
  options.ahead = any_of(random, {0.0, 3200.0, 1e5, 1e12});
  for (std::uint32_t frames = 1 + random.below(6); frames > 0; --frames) {
    const auto report = one_in(random, 5) ? stream.bring_in(views, options) : stream.update(views, options);
    ASSERT_TRUE(report) << report.error().message();
    expect_report(*life.streaming, *report);
    expect_passed(life, life.world());
    expect_in_or_out(life);
    if (testing::Test::HasFailure()) return;
    for (std::uint32_t works = random.below(5); works > 0; --works) stream.work();
  }
  if (life.streaming->budget == ~std::size_t{0} && one_in(random, 4)) bring_all_in(life, views);
}

}  // namespace sightline::lives
