// Instances of worlds: what they share, what hides them, what they follow, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <sightline/instances.hpp>

#include "library/geometry/linear.hpp"
#include "support/placed.hpp"
#include "support/random_views.hpp"

namespace sightline::placed {
namespace {

using namespace geometry;
using namespace test;

// A square of boxes on the ground, 20 m wide.
void fill_floor(World& world, std::vector<Handle>& handles) {
  std::vector<Box> boxes;
  for (int i = 0; i < 400; ++i) {
    const float x = static_cast<float>(i % 20) - 10, z = static_cast<float>(i / 20) - 10;
    boxes.push_back({{x, 0, z}, {x + 0.5f, 1, z + 0.5f}});
  }
  handles.resize(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
}

TEST(Instances, OfOneWorldThatAreSeenWholeShareTheirIds) {
  World floor;
  std::vector<Handle> objects;
  fill_floor(floor, objects);
  Instances tower;
  const PlacedWorldId name = *tower.add_world(floor);
  std::vector<InstancePlacement> placements(1000, {name, {}, {}});
  for (std::size_t i = 0; i < placements.size(); ++i) placements[i].origin.y = static_cast<double>(i) * 4;
  std::vector<Handle> handles(placements.size());
  ASSERT_TRUE(tower.insert(placements, handles));
  EXPECT_EQ(tower.objects(), 400'000u);
  Camera camera{.eye = {0, 2000, 4000}, .far_plane = 9000};
  const CullView view{.view = {*make_view(camera, 640, 480), {}}};
  InstanceCuller culler;
  const auto all = culler.cull(tower, view);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->objects, 400'000u);
  EXPECT_EQ(all->ids.size(), 400u);
  EXPECT_EQ(all->ranges.size(), 1000u);
  // With room for no more than the few that are crossed.
  EXPECT_TRUE(culler.cull(tower, view, {.most_objects = 400}));
  EXPECT_EQ(culler.cull(tower, view, {.most_objects = 399}).error().code(), StatusCode::too_many);
}

// What occluders hide is hidden, and nothing else: a point of what was left out lies behind one of them.
TEST(Instances, AreHiddenByOccludersAndOnlyByThem) {
  std::size_t hidden = 0, asked = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    scene::Random random(seed);
    World world;
    std::vector<Box> boxes;
    for (int i = 0; i < 150; ++i) boxes.push_back(random_box(random, {{-15, -5, -15}, {15, 5, 15}}));
    std::vector<Handle> objects(boxes.size());
    ASSERT_TRUE(world.insert(BoxView(boxes), objects));
    Instances instances;
    std::vector<InstancePlacement> placements;
    const PlacedWorldId name = *instances.add_world(world);
    for (int i = 0; i < 8; ++i)
      placements.push_back({name,
                            random_turn(random, std::exp(random.between(-1, 1)),
                                        {random.between(-60, 60), 0, random.between(-160, -30)}),
                            {}});
    std::vector<Handle> handles(placements.size());
    ASSERT_TRUE(instances.insert(placements, handles));
    const Camera camera{.eye = {0, 1, 0}, .far_plane = 400};
    CullView view{.view = {*make_view(camera, 320, 240), {}}};
    std::vector<Box> walls;
    for (int i = 0; i < 3; ++i) {
      const float x = random.between(-25, 15), z = random.between(-28, -10);
      walls.push_back({{x, -20, z}, {x + 10, 20, z + 1}});
    }
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin(view.view, {.coverage = Coverage::area}));
    ASSERT_TRUE(buffer.draw_boxes(BoxView(walls)));
    InstanceCuller culler;
    const AllSaid all = all_said(*culler.cull(instances, view));
    view.occlusion = &buffer;
    const auto result = culler.cull(instances, view);
    ASSERT_TRUE(result);
    const AllSaid left = all_said(*result);
    for (const auto& [which, said] : left) ASSERT_TRUE(all.contains(which));
    for (const auto& [which, said] : all) {
      if (left.contains(which)) continue;
      ++hidden;
      const glm::dmat4 placed = to_double(instances.placement(instances.handle(which.first)).transform);
      const WorldBox b = world.box(world.handle(which.second));
      for (int k = 0; k < 20; ++k) {
        const auto in = [&](double low, double high) { return low + (high - low) * double{random.unit()}; };
        const glm::dvec3 p(placed *
                           glm::dvec4(in(b.min.x, b.max.x), in(b.min.y, b.max.y), in(b.min.z, b.max.z), 1));
        const glm::dvec4 clip = to_double(world_to_clip(view.view.view)) * glm::dvec4(p, 1);
        if (std::fabs(clip.x) >= clip.w || std::fabs(clip.y) >= clip.w || clip.z < 0 || clip.z > clip.w)
          continue;
        ++asked;
        const glm::dvec3 eye(0, 1, 0);
        const bool blocked = std::ranges::any_of(walls, [&](const Box& wall) {
          double first = 0, last = 1;
          for (int a = 0; a < 3; ++a) {
            const double low = a == 0   ? wall.min.x
                               : a == 1 ? wall.min.y
                                        : wall.min.z,
                         high = a == 0   ? wall.max.x
                                : a == 1 ? wall.max.y
                                         : wall.max.z,
                         by = p[a] - eye[a];
            const double s = (low - eye[a]) / by, t = (high - eye[a]) / by;
            first = std::max(first, std::min(s, t)), last = std::min(last, std::max(s, t));
          }
          return first <= last + 1e-9;
        });
        ASSERT_TRUE(blocked) << "seed " << seed << " lost object " << which.second << " of " << which.first;
      }
    }
  }
  EXPECT_GT(hidden, 5000u);
  EXPECT_GT(asked, 50000u);
}

TEST(Instances, FollowTheirWorldsAfterAnUpdate) {
  World world;
  Instances instances;
  const PlacedWorldId name = *instances.add_world(world);
  const std::vector<InstancePlacement> placements(2, {name, {}, {0, 0, -20}});
  std::vector<Handle> handles(2);
  ASSERT_TRUE(instances.insert(placements, handles));
  const CullView view{.view = {*make_view({}, 64, 48), {}}};
  InstanceCuller culler;
  EXPECT_EQ(culler.cull(instances, view)->objects, 0u);
  std::vector<Handle> objects;
  fill_floor(world, objects);
  const auto refused = culler.cull(instances, view);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), StatusCode::bad_argument);
  EXPECT_EQ(refused.error().index(), name);
  ASSERT_TRUE(instances.update());
  EXPECT_EQ(culler.cull(instances, view)->ranges.size(), 2u);
  EXPECT_LE(instances.box(handles[0]).min.x, -10);
  // Where it shrinks nothing need be said.
  ASSERT_TRUE(world.remove(std::span(objects).first(399)));
  EXPECT_TRUE(culler.cull(instances, view));
  EXPECT_FALSE(instances.remove_world(name));
  ASSERT_TRUE(instances.remove(handles));
  EXPECT_EQ(instances.size(), 0u);
  EXPECT_TRUE(instances.remove_world(name));
  EXPECT_EQ(instances.world(name), nullptr);
  EXPECT_FALSE(instances.insert(placements, handles));
}

TEST(Instances, RefuseWhatTheyCannotShow) {
  World world;
  std::vector<Handle> objects;
  fill_floor(world, objects);
  Instances instances;
  const PlacedWorldId name = *instances.add_world(world);
  std::vector<Handle> handles(2);
  std::vector<InstancePlacement> placements(2, {name, {}, {}});
  const auto refuses = [&](StatusCode code, std::size_t index) {
    const Status said = instances.insert(placements, handles);
    EXPECT_EQ(said.code(), code) << said.message();
    EXPECT_EQ(said.index(), index);
    EXPECT_EQ(instances.size(), 0u);
    placements.assign(2, {name, {}, {}});
  };
  placements[1].world = 7;
  refuses(StatusCode::bad_argument, 1);
  placements[1].transform.m[0] = 2;  // no uniform scale
  refuses(StatusCode::bad_argument, 1);
  placements[1].transform.m[0] = -1;  // a mirror
  refuses(StatusCode::bad_argument, 1);
  placements[1].transform.m[1] = 0.5f;  // sheared
  refuses(StatusCode::bad_argument, 1);
  placements[0].transform.m[3] = 1;  // not affine
  refuses(StatusCode::bad_argument, 0);
  placements[0].transform.m[12] = NAN;
  refuses(StatusCode::bad_argument, 0);
  placements[0].transform.m[0] = placements[0].transform.m[5] = placements[0].transform.m[10] = 1e7f;
  refuses(StatusCode::bad_argument, 0);
  placements[0].origin.x = NAN;
  refuses(StatusCode::bad_argument, 0);
  placements[0].origin.x = kWorldReach;
  refuses(StatusCode::bad_box, 0);
  handles.resize(1);
  refuses(StatusCode::bad_argument, Status::kNoIndex);
  handles.resize(2);
  ASSERT_TRUE(instances.insert(placements, handles));
  EXPECT_EQ(instances.move(std::span(handles).first(1), placements).code(), StatusCode::bad_argument);
  for (const float scale : {1e-6f, 1e6f}) {  // as documented
    Mat4& m = placements[0].transform;
    m.m[0] = m.m[5] = m.m[10] = scale;
    EXPECT_TRUE(instances.move(handles, placements)) << scale;
  }
  placements[0].transform = {};
  ASSERT_TRUE(instances.move(handles, placements));

  const CullView view{.view = {*make_view({}, 64, 48), {}}};
  InstanceCuller culler;
  ShadowCasters casters;
  ASSERT_TRUE(casters.begin(view.view, view.view));
  CullView other = view;
  other.casters = &casters;
  EXPECT_EQ(culler.cull(instances, other).error().code(), StatusCode::bad_argument);
  OcclusionBuffer stale;
  other = view, other.occlusion = &stale;
  EXPECT_EQ(culler.cull(instances, other).error().code(), StatusCode::stale_buffer);
  other = view, other.view.view.eye_to_clip.m[0] = NAN;
  EXPECT_EQ(culler.cull(instances, other).error().code(), StatusCode::bad_view);
  EXPECT_FALSE(culler.cull(instances, std::span<const CullView>()));
  const std::vector<CullView> nine(9, view);
  EXPECT_FALSE(culler.cull(instances, nine));
  EXPECT_FALSE(culler.cull(instances, view, {.levels = true, .level_options = {.view = 1}}));
  EXPECT_FALSE(culler.cull(instances, view, {.levels = true, .level_options = {.hysteresis = 0.1f}}));
  EXPECT_FALSE(culler.cull(instances, view, {.levels = true, .level_options = {.fade = -1}}));
  EXPECT_FALSE(culler.cull(instances, view, {.levels = true, .level_options = {.scale = 0}}));
  CullView endless = view;
  endless.min_area = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(culler.cull(instances, endless));
  EXPECT_FALSE(culler.cull(instances, view, {.most_objects = std::size_t{1} << 32}));
  EXPECT_FALSE(culler.cull(instances, view, {.jobs = {.threads = 0}}));
  EXPECT_TRUE(culler.cull(instances, view));
}

}  // namespace
}  // namespace sightline::placed
