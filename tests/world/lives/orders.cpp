#include <gtest/gtest.h>

#include <algorithm>

#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

// What the reports so far tell is what the order says; each object has one slot.
void expect_order(Life& life, Lane& lane) {
  const std::span<const ObjectId> objects = lane.order.objects();
  ASSERT_TRUE(std::equal(objects.begin(), objects.end(), lane.slots.begin(), lane.slots.end()));
  std::vector<ObjectId> numbered;
  for (std::uint32_t slot = 0; slot < objects.size(); ++slot) {
    if (objects[slot] == kNoObject) continue;
    ASSERT_TRUE(life.model.has(objects[slot])) << "slot " << slot << " holds " << objects[slot];
    ASSERT_EQ(lane.order.slot(lane.world, life.model.objects[objects[slot]].handle), slot);
    numbered.push_back(objects[slot]);
  }
  std::vector<ObjectId> all = life.model.all();
  std::sort(all.begin(), all.end()), std::sort(numbered.begin(), numbered.end());
  ASSERT_EQ(numbered, all);
  for (const Handle stale : life.model.gone) ASSERT_EQ(lane.order.slot(lane.world, stale), kNoSlot);
}

void take_report(Lane& lane, std::span<const SlotChange> report) {
  const std::size_t limit = lane.order.slot_limit();
  lane.slots.resize(std::max(lane.slots.size(), limit), kNoObject);
  std::vector<bool> reported(lane.slots.size());
  for (const SlotChange& change : report) {
    ASSERT_LT(change.slot, lane.slots.size());
    ASSERT_FALSE(reported[change.slot]) << "reported twice: " << change.slot;
    reported[change.slot] = true;
    lane.slots[change.slot] = change.object;
  }
  for (std::size_t slot = limit; slot < lane.slots.size(); ++slot) ASSERT_EQ(lane.slots[slot], kNoObject);
  lane.slots.resize(limit);
}

// Those in the ranges, as a cull would write them.
Answer told_by(const Lane& lane, const RangeResult& found, bool masks) {
  Answer out;
  for (std::size_t i = 0; i < found.ranges.size(); ++i) {
    const auto [first, count] = found.ranges[i];
    EXPECT_GT(count, 0u);
    EXPECT_LE(std::size_t{first} + count, lane.slots.size());
    if (i > 0) {
      const SlotRange& before = found.ranges[i - 1];
      const bool alike = !masks || found.masks[i - 1] == found.masks[i];
      EXPECT_FALSE(before.first + before.count == first && alike) << "ranges that could join";
    }
    for (std::size_t slot = first; slot < std::min(std::size_t{first} + count, lane.slots.size()); ++slot) {
      out.ids.push_back(lane.slots[slot]);
      if (masks) out.masks.push_back(found.masks[i]);
    }
  }
  EXPECT_EQ(found.objects, out.ids.size());
  return out;
}

}  // namespace

void follow_order(Life& life, Lane& lane, bool anew) {
  const auto report = anew ? lane.order.renumber(lane.world) : lane.order.update(lane.world);
  ASSERT_TRUE(report) << report.error().message();
  take_report(lane, *report);
  if (!testing::Test::HasFailure()) expect_order(life, lane);
}

void cull_ranges(Life& life) {
  Random& random = life.random;
  const std::vector<CullView> views = life.any_views(one_in(random, 2));
  RangeOptions options;
  options.masks = one_in(random, 2), options.whole_chunks = one_in(random, 4);
  const bool anew = one_in(random, 12);
  Answer of_first;
  for (const auto& lane : life.lanes) {
    follow_order(life, *lane, anew);
    options.jobs = lane->kind == Lane::twin ? life.any_jobs() : JobSystem{};
    const Result<RangeResult> found = lane->ranger.cull(lane->world, lane->order, views, options);
    ASSERT_TRUE(found) << found.error().message();
    Answer told = told_by(*lane, *found, options.masks);
    if (testing::Test::HasFailure()) return;
    const Answer culled = ask(lane->plain, lane->world, views, {}, {});
    if (lane->kind == Lane::twin) {
      expect_same(of_first, told);
      continue;
    }
    const std::vector<std::uint8_t> expected = masks_by_id(life.model, culled.ids, culled.masks);
    const std::vector<std::uint8_t> in_ranges = masks_by_id(life.model, told.ids, told.masks);
    for (std::size_t id = 0; id < expected.size(); ++id) {
      // Whole chunks show more, and without masks nobody says who sees it.
      const std::uint8_t whole = options.masks ? expected[id] : expected[id] != 0 ? 0xff : 0;
      ASSERT_EQ(in_ranges[id] & whole, whole) << "ranges lose object " << id;
      if (!options.whole_chunks) ASSERT_EQ(in_ranges[id], whole) << "of object " << id;
    }
    expect_right(life.model, views, culled);
    if (lane->kind == Lane::first) of_first = std::move(told);
  }
}

// What has changed since is refused, and so is an order that another one has followed.
void leave_the_order_stale(Life& life) {
  for (const auto& lane : life.lanes) follow_order(life, *lane);
  const std::vector<ObjectId> who = life.model.some(life.random, 1 + life.random.below(5));
  if (who.empty() || testing::Test::HasFailure()) return;
  const bool by_another = one_in(life.random, 2);
  if (!by_another) step(life, who);
  const CullView view{.view = life.any_view()};
  for (const auto& lane : life.lanes) {
    ObjectOrder other;
    if (by_another) ASSERT_EQ(other.update(lane->world)->size(), life.model.all().size());
    const Result<RangeResult> found = lane->ranger.cull(lane->world, lane->order, view);
    ASSERT_FALSE(found);
    ASSERT_EQ(found.error().code(), StatusCode::stale_buffer);
    ASSERT_EQ(lane->order.slot(lane->world, life.model.objects[who[0]].handle), kNoSlot);
  }
}

}  // namespace sightline::lives
