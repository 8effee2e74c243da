#include <sightline/instances.hpp>

#include <gtest/gtest.h>

#include <algorithm>

#include "support/placed.hpp"
#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

constexpr std::size_t kMostInstances = 12;

InstancePlacement any_placement(Life& life) {
  Random& random = life.random;
  const float scale = any_of(random, {1.0f, 1.0f, 0.5f, 3.0f, 0.01f});
  const auto away = life.plan.away > 1e4 ? 0.0f : static_cast<float>(life.plan.radius);
  const Vec3 at = random.inside({{-away, -away, -away}, {away, away, away}});
  InstancePlacement out;
  out.transform = test::random_turn(random, one_in(random, 4) ? 1 : scale, at);
  if (one_in(random, 4)) out.transform = {};
  if (one_in(random, 2)) out.origin = life.any_point();
  return out;
}

// What happens to instances before they are culled, in each lane alike.
struct Change {
  std::vector<InstancePlacement> placements;  // to come
  std::vector<std::uint32_t> layers;
  std::size_t goes = kMostInstances, moves = kMostInstances;  // by their place in the lane's list
};

Change any_change(Life& life) {
  Random& random = life.random;
  const std::size_t count = life.first().placed.size();
  Change out;
  if (count < 3 || one_in(random, 6)) {
    for (std::size_t i = 1 + random.below(4); i > 0 && count + i <= kMostInstances; --i) {
      out.placements.push_back(any_placement(life));
      out.layers.push_back(one_in(random, 2) ? kAllLayers : random.below(8));
    }
  }
  if (count > 0 && one_in(random, 8)) out.goes = below(random, count);
  if (count > 1 && one_in(random, 8)) out.moves = 1;
  return out;
}

void come(Lane& lane, const Change& change) {
  if (change.placements.empty()) return;
  if (lane.placed_world == kNoPlacedWorld) lane.placed_world = *lane.instances.add_world(lane.world);
  std::vector<InstancePlacement> placements = change.placements;
  for (InstancePlacement& placement : placements) placement.world = lane.placed_world;
  std::vector<Handle> handles(placements.size());
  ASSERT_TRUE(lane.instances.insert(placements, handles, change.layers));
  for (std::size_t i = 0; i < handles.size(); ++i)
    lane.placed.push_back({handles[i], placements[i], change.layers[i]});
}

void go_and_move(Lane& lane, const Change& change) {
  if (change.moves < lane.placed.size()) {
    Placed& placed = lane.placed[change.moves];
    placed.placement = lane.placed[0].placement;
    ASSERT_TRUE(lane.instances.move(std::span(&placed.handle, 1), std::span(&placed.placement, 1)));
    ASSERT_EQ(lane.instances.placement(placed.handle).transform, placed.placement.transform);
  }
  if (change.goes < lane.placed.size()) {
    const auto gone = lane.placed.begin() + static_cast<std::ptrdiff_t>(change.goes);
    ASSERT_TRUE(lane.instances.remove(std::span(&gone->handle, 1)));
    ASSERT_FALSE(lane.instances.contains(gone->handle));
    lane.placed.erase(gone);
  }
}

// A cull of one instance, as one of its world would have written it.
Answer told_of(const InstanceCullResult& found, const Placed& placed) {
  Answer out;
  const auto range = std::find_if(found.ranges.begin(), found.ranges.end(),
                                  [&](const InstanceRange& r) { return r.instance == placed.handle.index; });
  if (range == found.ranges.end()) return out;
  const auto part = [&](const auto& of) {
    const auto some = of.empty() ? of : of.subspan(range->first, range->count);
    return std::vector(some.begin(), some.end());
  };
  out.ids = part(found.ids), out.masks = part(found.masks), out.levels = part(found.levels);
  return out;
}

void expect_instances(Life& life, Lane& lane, std::span<const CullView> views,
                      const InstanceCullOptions& options, const InstanceCullResult& found) {
  ASSERT_LE(found.ranges.size(), lane.placed.size());
  std::uint64_t objects = 0;
  for (const Placed& placed : lane.placed) {
    const Sight sight(views, placed.placement, placed.layers);
    const Answer told = told_of(found, placed);
    objects += told.ids.size();
    expect_right(life.model, sight, masks_by_id(life.model, told.ids, told.masks), options.masks);
    if (testing::Test::HasFailure()) return;
    const ViewTruth& sized_by = sight.truths[options.level_options.view];
    for (std::size_t i = 0; i < told.levels.size(); ++i)
      expect_level(life.model, told.ids[i], sized_by, told.levels[i]);
  }
  ASSERT_EQ(objects, found.objects) << "objects of nobody's instance";
}

}  // namespace

// The lanes' own worlds are placed, also before they have followed what changed in them: that is refused or
// right.
void cull_instances(Life& life) {
  if (life.plan.away > 1e8) return;  // where single precision places nothing
  Random& random = life.random;
  const Change change = any_change(life);
  const std::vector<CullView> views = life.any_views(one_in(random, 2));
  InstanceCullOptions options;
  options.masks = one_in(random, 2), options.levels = one_in(random, 3);
  options.level_options.view = static_cast<std::uint32_t>(below(random, views.size()));
  std::vector<InstanceRange> ranges;
  std::vector<ObjectId> ids;
  for (const auto& lane : life.lanes) {
    if (lane->kind == Lane::loaded) continue;
    come(*lane, change);
    const Result<InstanceCullResult> late = lane->instance_culler.cull(lane->instances, views, options);
    if (late)
      expect_instances(life, *lane, views, options, *late);
    else
      ASSERT_EQ(late.error().code(), StatusCode::bad_argument) << late.error().message();
    ASSERT_TRUE(lane->instances.update());
    go_and_move(*lane, change);
    options.jobs = lane->kind == Lane::twin ? life.any_jobs() : JobSystem{};
    const Result<InstanceCullResult> found = lane->instance_culler.cull(lane->instances, views, options);
    ASSERT_TRUE(found) << found.error().message();
    if (lane->kind == Lane::first) {
      ranges.assign(found->ranges.begin(), found->ranges.end());
      ids.assign(found->ids.begin(), found->ids.end());
      expect_instances(life, *lane, views, options, *found);
    } else {
      ASSERT_TRUE(std::equal(ranges.begin(), ranges.end(), found->ranges.begin(), found->ranges.end()));
      ASSERT_TRUE(std::equal(ids.begin(), ids.end(), found->ids.begin(), found->ids.end()));
    }
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace sightline::lives
