// Ranges of an order beside the ids of a plain cull and beside brute force, while objects come, move and go;
// and the order itself beside an instance buffer that knows of nothing but reports.
#include <sightline/ranges.hpp>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "library/geometry/box_reader.hpp"
#include "support/random_views.hpp"
#include "support/rounds.hpp"
#include "support/run_threads.hpp"
#include "support/world_twin.hpp"

namespace sightline {
namespace {

using scene::Random;

constexpr Box kRangePlace{{-300, -40, -300}, {300, 40, 300}};

// Who sees each slot that ranges hold.
std::map<std::uint32_t, std::uint8_t> slots_of(const RangeResult& result) {
  std::map<std::uint32_t, std::uint8_t> out;
  std::uint64_t objects = 0;
  for (std::size_t r = 0; r < result.ranges.size(); ++r) {
    const auto [first, count] = result.ranges[r];
    const std::uint8_t mask = result.masks.empty() ? std::uint8_t{1} : result.masks[r];
    EXPECT_GT(count, 0u);
    EXPECT_NE(mask, 0);
    objects += count;
    for (std::uint32_t slot = first; slot < first + count; ++slot)
      EXPECT_TRUE(out.emplace(slot, mask).second) << "slot " << slot << " stands in two ranges";
    if (r == 0) continue;
    const SlotRange& last = result.ranges[r - 1];
    EXPECT_FALSE(last.first + last.count == first && (result.masks.empty() || result.masks[r - 1] == mask))
        << "two ranges could be one";
  }
  EXPECT_EQ(objects, result.objects);
  return out;
}

// A world, and what a renderer would keep of it.
class Play {
public:
  explicit Play(std::uint32_t seed) : random_(seed), layers_(seed % 3 == 0), distances_(seed % 5 == 0) {}

  void insert(std::size_t count) {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> layers;
    std::vector<DistanceRange> distances;
    for (std::size_t i = 0; i < count; ++i) {
      boxes.push_back(place(test::random_box(random_, kRangePlace)));
      layers.push_back(boxes[i].min.x > 0 && random_.below(40) > 0 ? 3 : 1 + random_.below(15));
      distances.push_back({0, boxes[i].min.z > 0 ? 200.0f : random_.between(100, 500)});
    }
    std::vector<Handle> handles(count);
    ObjectColumns columns;
    if (layers_) columns.layers = std::span<const std::uint32_t>(layers);
    if (distances_) columns.distances = std::span<const DistanceRange>(distances);
    ASSERT_TRUE(world.insert(BoxView(boxes), handles, columns));
    standing_.insert(standing_.end(), handles.begin(), handles.end());
  }

  void change() {
    insert(random_.below(20));
    std::vector<Handle> some = pick(random_.below(3) == 0 ? 1 : 4);
    std::vector<Box> boxes;
    const float by = random_.below(2) ? 3 : 60;
    for (const Handle h : some) {
      Box b = geometry::relative_box(world.box(h), {});
      const float x = random_.between(-by, by), z = random_.between(-by, by);
      b.min.x += x, b.max.x += x, b.min.z += z, b.max.z += z;
      boxes.push_back(random_.below(50) ? b : place(b));
    }
    ASSERT_TRUE(world.move(some, BoxView(boxes)));
    some = pick(12);
    ASSERT_TRUE(world.remove(some));
    std::erase_if(standing_, [&](Handle h) { return !world.contains(h); });
    // The ids of those that went are used again, perhaps in the same slots.
    insert(random_.below(8));
  }

  // Reads the report as a renderer does.
  void follow(bool renumber = false) {
    const std::size_t slots_before = order.slot_limit();
    const auto report = renumber ? order.renumber(world) : order.update(world);
    ASSERT_TRUE(report);
    std::set<std::uint32_t> changed;
    for (const SlotChange& change : *report) {
      ASSERT_TRUE(changed.insert(change.slot).second) << "reported twice";
      if (change.slot >= buffer_.size()) buffer_.resize(change.slot + 1u);
      buffer_[change.slot] = world.handle(change.object);
    }
    reported += report->size();
    ASSERT_TRUE(order.update(world)->empty()) << "nothing has changed";
    std::size_t live = 0;
    const auto objects = order.objects();
    for (std::size_t slot = 0; slot < buffer_.size(); ++slot) {
      const bool free = slot >= objects.size() || objects[slot] == kNoObject;
      ASSERT_EQ(buffer_[slot].index, free ? kNoObject : objects[slot]) << "slot " << slot;
      live += !free;
    }
    ASSERT_EQ(live, standing_.size());
    for (const Handle h : standing_) {
      const std::uint32_t slot = order.slot(world, h);
      ASSERT_LT(slot, order.slot_limit());
      ASSERT_EQ(buffer_[slot], h);
    }
    if (renumber) ASSERT_LE(order.slot_limit(), slots_before);
  }

  void expect_right() {
    const std::size_t count = 1 + random_.below(4);
    std::vector<CullView> views;
    OcclusionBuffer buffer;
    for (std::size_t v = 0; v < count; ++v) {
      CullView view{.view = {test::random_view(random_, kRangePlace), {}}};
      if (v > 0 && random_.below(3) == 0) view.view = views[0].view;
      if (random_.below(3) == 0) view.layers = random_.below(16);
      if (random_.below(6) == 0) view.min_area = random_.between(0.1f, 50);
      if (random_.below(6) == 0) view.distance_scale = random_.between(0.3f, 3);
      views.push_back(view);
    }
    if (random_.below(4) == 0) {
      ASSERT_TRUE(buffer.begin(views[0].view));
      const Box wall{{-60, -40, -3}, {60, 40, 3}};
      ASSERT_TRUE(buffer.draw_boxes(BoxView(std::span(&wall, 1))));
      views[0].occlusion = &buffer;
    }
    compare(views);
  }

  World world;
  ObjectOrder order;
  std::size_t reported = 0, seen = 0, ranges = 0, left_out = 0, whole_ranges = 0, excess = 0;

private:
  // Some in other sectors.
  Box place(Box b) {
    if (random_.below(30) == 0) b.min.x += 3200, b.max.x += 3200;
    return b;
  }

  std::vector<Handle> pick(std::uint32_t one_in) {
    std::vector<Handle> out;
    for (const Handle h : standing_)
      if (random_.below(one_in) == 0) out.push_back(h);
    return out;
  }

  void compare(const std::vector<CullView>& views) {
    const CullOptions plain{.jobs = {test::run_threads, nullptr, 3}};
    std::vector<ObjectId> ids(cull_capacity(world, plain));
    std::vector<std::uint8_t> masks(ids.size());
    const CullResult expected = test::cull(ids_, world, views, ids, masks, plain);
    std::map<std::uint32_t, std::uint8_t> wanted;
    for (std::size_t i = 0; i < expected.count; ++i)
      wanted[order.slot(world, world.handle(ids[i]))] = masks[i];

    RangeOptions options{.masks = true};
    const auto got = culler_.cull(world, order, views, options);
    ASSERT_TRUE(got) << got.error().message();
    EXPECT_EQ(slots_of(*got), wanted);
    EXPECT_EQ(got->tested, expected.tested);
    EXPECT_EQ(got->culled_occlusion, expected.culled_occlusion);
    const std::vector<SlotRange> ranges_of_one(got->ranges.begin(), got->ranges.end());
    const std::vector<std::uint8_t> masks_of_one(got->masks.begin(), got->masks.end());
    seen += got->objects, ranges += got->ranges.size(), left_out += standing_.size() - got->objects;
    compare_with_brute_force(views, wanted);

    options.jobs = {test::run_threads, nullptr, 4};
    const auto threaded = culler_.cull(world, order, views, options);
    EXPECT_TRUE(std::ranges::equal(threaded->ranges, ranges_of_one));
    EXPECT_TRUE(std::ranges::equal(threaded->masks, masks_of_one));

    options.masks = false;
    const auto unmasked = culler_.cull(world, order, views, options);
    const auto without = slots_of(*unmasked);
    EXPECT_EQ(without.size(), wanted.size());
    for (const auto& [slot, mask] : without) EXPECT_TRUE(wanted.contains(slot));
    compare_whole_chunks(views, wanted);
  }

  // Plain views: what the matrices say.
  void compare_with_brute_force(const std::vector<CullView>& views,
                                const std::map<std::uint32_t, std::uint8_t>& got) {
    for (std::size_t v = 0; v < views.size(); ++v) {
      const bool plain = views[v].layers == kAllLayers && views[v].min_area == 0 && !views[v].occlusion;
      if (!plain || distances_) continue;
      const std::vector<glm::dvec4> planes = test::planes_of(views[v].view);
      for (const Handle h : standing_) {
        const double depth = test::depth_in(planes, views[v].view.origin, world.box(h));
        const auto found = got.find(order.slot(world, h));
        const bool kept = found != got.end() && (found->second >> v & 1);
        if (depth >= 0) EXPECT_TRUE(kept) << "lost " << h.index << " in view " << v;
        if (depth < -0.02) EXPECT_FALSE(kept) << "kept " << h.index << " in view " << v;
      }
    }
  }

  void compare_whole_chunks(const std::vector<CullView>& views,
                            const std::map<std::uint32_t, std::uint8_t>& wanted) {
    const auto whole = culler_.cull(world, order, views, {.masks = true, .whole_chunks = true});
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->tested, 0u);
    const auto slots = slots_of(*whole);
    for (const auto& [slot, mask] : wanted) {
      const auto found = slots.find(slot);
      ASSERT_TRUE(found != slots.end() && (found->second & mask) == mask) << "lost slot " << slot;
    }
    for (const auto& [slot, mask] : slots) ASSERT_NE(order.objects()[slot], kNoObject);
    whole_ranges += whole->ranges.size(), excess += slots.size() - wanted.size();
  }

  Random random_;
  bool layers_, distances_;
  std::vector<Handle> standing_, buffer_;
  RangeCuller culler_;
  Culler ids_;
};

TEST(Ranges, EqualIdsAndBruteForceInAThousandRandomWorldsAndViews) {
  std::size_t seen = 0, left_out = 0, ranges = 0, whole_ranges = 0, excess = 0;
  const std::uint32_t worlds = test::rounds(1000);
  for (std::uint32_t seed = 0; seed < worlds; ++seed) {
    Play play(seed);
    play.insert(seed % 50 == 0 ? 2500 : 20 + seed % 200);
    for (int round = 0; round < 3; ++round) {
      play.follow();
      play.expect_right();
      ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed << ", round " << round;
      play.change();
    }
    seen += play.seen, left_out += play.left_out, ranges += play.ranges;
    whole_ranges += play.whole_ranges, excess += play.excess;
  }
  EXPECT_GT(seen, 50 * worlds);
  EXPECT_GT(left_out, 50 * worlds);
  EXPECT_LT(ranges, seen);
  EXPECT_LT(whole_ranges, ranges);
  EXPECT_GT(excess, worlds);
}

// Many frames in which a world moves, so that movers come, rest and stand in pages.
TEST(Ranges, FollowAWorldThatMovesAndReportLittle) {
  Play play(1);
  play.insert(4000);
  play.follow();
  for (int frame = 0; frame < 150; ++frame) {
    play.change();
    play.follow(frame % 40 == 39);
    if (frame % 5 == 0) play.expect_right();
    ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
  }
  // A world that stands still changes nothing, and one object moved a little neither.
  for (int frame = 0; frame < 300; ++frame)
    ASSERT_TRUE(play.world.move(std::span<const Handle>(), BoxView()));
  play.follow();
}

TEST(Ranges, OfAStillWorldAreDenseAndFewWhereMuchIsSeen) {
  Random random(3);
  std::vector<Box> boxes;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 at = random.inside({{-500, 0, -500}, {500, 10, 500}});
    boxes.push_back({at, {at.x + 1, at.y + 1, at.z + 1}});
  }
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  ObjectOrder order;
  ASSERT_EQ(order.update(world)->size(), boxes.size());
  EXPECT_EQ(order.slot_limit(), boxes.size());
  RangeCuller culler;
  Camera above{.eye = {0, 3000, 0}, .forward = {0, -1, 0}, .up = {0, 0, -1}};
  above.far_plane = 4000;
  const auto all = culler.cull(world, order, {.view = {*make_view(above, 640, 640), {}}});
  ASSERT_TRUE(all);
  ASSERT_EQ(all->ranges.size(), 1u);
  EXPECT_EQ(all->ranges[0], (SlotRange{0, 20'000}));
  // One that leaves makes a gap, and what takes its place is told.
  const std::uint32_t slot = order.slot(world, handles[77]);
  ASSERT_TRUE(world.remove(std::span(handles).subspan(77, 1)));
  EXPECT_EQ(order.slot(world, handles[78]), kNoSlot);
  const auto report = order.update(world);
  EXPECT_GE(report->size(), 1u);
  EXPECT_LE(report->size(), 2u);
  EXPECT_EQ(report->front().slot, slot);
  EXPECT_EQ(order.slot(world, handles[77]), kNoSlot);
}

TEST(Ranges, RefuseAnOrderThatIsNotTheWorlds) {
  World world, other;
  const std::array boxes{Box{{-1, -1, -9}, {1, 1, -7}}};
  std::array<Handle, 1> handles, others;
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  ASSERT_TRUE(other.insert(BoxView(boxes), others));
  const CullView view{.view = {*make_view({}, 64, 64), {}}};
  RangeCuller culler;
  ObjectOrder order, second;
  EXPECT_EQ(culler.cull(world, order, view).error().code(), StatusCode::stale_buffer);
  EXPECT_EQ(order.slot(world, handles[0]), kNoSlot);
  ASSERT_TRUE(order.update(world));
  EXPECT_EQ(culler.cull(world, order, view)->objects, 1u);
  EXPECT_EQ(culler.cull(other, order, view).error().code(), StatusCode::stale_buffer);
  ASSERT_TRUE(world.move(handles, BoxView(boxes)));
  EXPECT_EQ(culler.cull(world, order, view).error().code(), StatusCode::stale_buffer);
  EXPECT_TRUE(order.update(world)->empty());
  EXPECT_EQ(culler.cull(world, order, view)->objects, 1u);
  // Another order takes over, and the first begins anew.
  EXPECT_EQ(second.update(world)->size(), 1u);
  EXPECT_EQ(culler.cull(world, order, view).error().code(), StatusCode::stale_buffer);
  EXPECT_EQ(order.update(world)->size(), 1u);
  // Of a world that is gone, or that moved to another place.
  World moved = std::move(world);
  EXPECT_EQ(culler.cull(moved, order, view)->objects, 1u);
  ASSERT_TRUE(order.update(other));
  EXPECT_EQ(culler.cull(moved, order, view).error().code(), StatusCode::stale_buffer);
  EXPECT_EQ(culler.cull(other, order, view)->objects, 1u);
  EXPECT_EQ(culler.cull(other, order, std::span<const CullView>()).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(culler.cull(other, order, view, {.jobs = {nullptr, nullptr, 65}}).error().code(),
            StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
