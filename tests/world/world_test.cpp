#include <sightline/inspect.hpp>
#include <sightline/instances.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/ranges.hpp>
#include <sightline/rays.hpp>
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "library/geometry/linear.hpp"
#include "library/world/sector_test.hpp"
#include "library/world/world_state.hpp"
#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/snapshots.hpp"
#include "support/world_twin.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::expect_right;
using test::wide;

TEST(World, EqualsBruteForceAfterTenThousandRandomOperations) {
  for (const double shift : {0.0, 1e7}) {
    const WorldPoint origin{shift, 0, -shift};
    Random random(7);
    World world;
    Culler culler;
    std::map<ObjectId, WorldBox> twin;
    std::vector<Handle> standing;
    const Box around{{-4000, -300, -4000}, {4000, 300, 4000}};
    for (int step = 0; step < 10000; ++step) {
      const std::uint32_t dice = random.below(20);
      const std::size_t batch = 1 + random.below(8);
      std::vector<WorldBox> boxes;
      for (std::size_t i = 0; i < batch; ++i) boxes.push_back(wide(test::random_box(random, around), origin));
      if (dice < 9) {
        std::vector<Handle> handles(batch);
        ASSERT_TRUE(world.insert(boxes, handles));
        for (std::size_t i = 0; i < batch; ++i) {
          ASSERT_TRUE(twin.emplace(handles[i].index, boxes[i]).second);
          standing.push_back(handles[i]);
        }
      } else if (dice < 17 && standing.size() > batch) {
        std::vector<Handle> chosen;
        for (std::size_t i = 0; i < batch; ++i) {
          std::swap(standing[random.below(static_cast<std::uint32_t>(standing.size()))], standing.back());
          chosen.push_back(standing.back());
          standing.pop_back();
        }
        if (dice < 12) {
          ASSERT_TRUE(world.move(chosen, boxes));
          for (std::size_t i = 0; i < batch; ++i) twin[chosen[i].index] = boxes[i];
          standing.insert(standing.end(), chosen.begin(), chosen.end());
        } else {
          ASSERT_TRUE(world.remove(chosen));
          for (const Handle& handle : chosen) {
            twin.erase(handle.index);
            ASSERT_FALSE(world.contains(handle));
          }
        }
      } else if (dice == 19 && step % 3 == 0) {
        std::vector<WorldView> views;
        for (std::size_t v = 1 + random.below(3); v > 0; --v)
          views.push_back({test::random_view(random, around), origin});
        expect_right(world, culler, twin, views, 0.02);
        if (HasFatalFailure()) return;
      }
      ASSERT_EQ(world.size(), twin.size());
    }
    for (const Handle& handle : standing) {
      const WorldBox stored = world.box(handle), &given = twin[handle.index];
      ASSERT_LE(stored.min.x, given.min.x);
      ASSERT_GE(stored.max.z, given.max.z);
      ASSERT_NEAR(stored.min.x, given.min.x, 1e-3);
      ASSERT_NEAR(stored.max.z, given.max.z, 1e-3);
    }
    for (const auto& sector : WorldAccess::state(world).sectors) {
      if (sector.map) ASSERT_TRUE(sector.map->check());
    }
  }
}

// Who comes once a scene is loaded does not wait until all objects are copied to larger memory.
TEST(World, HasRoomForSomeWhoComeOnceASceneIsLoaded) {
  Random random(9);
  std::vector<Box> boxes(8800);
  for (Box& box : boxes) box = test::random_box(random, {{-500, -50, -500}, {500, 50, 500}});
  std::vector<Handle> handles(boxes.size());
  World world;
  ASSERT_TRUE(world.insert(BoxView(std::span(boxes).first(8000)), std::span(handles).first(8000)));
  const auto* const loaded = WorldAccess::state(world).objects.data();
  for (std::size_t i = 8000; i < boxes.size(); ++i)
    ASSERT_TRUE(world.insert(BoxView(std::span(boxes).subspan(i, 1)), std::span(handles).subspan(i, 1)));
  EXPECT_EQ(WorldAccess::state(world).objects.data(), loaded);
}

TEST(World, KeepsNoSectorThatNothingStandsIn) {
  World world;
  const std::array<WorldBox, 3> home{wide({{0, 0, 0}, {1, 1, 1}}), wide({{9000, 0, 0}, {9001, 1, 1}}),
                                     wide({{0, 0, 9000}, {1, 1, 9001}})};
  std::array<Handle, 3> handles;
  ASSERT_TRUE(world.insert(home, handles));
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(world));
  // One object wanders 3,000 km: each step leaves a sector behind.
  for (int step = 1; step <= 1000; ++step) {
    const double x = 3000.0 * step;
    const WorldBox box{{x, 0, 0}, {x + 1, 1, 1}};
    ASSERT_TRUE(world.move({&handles[0], 1}, std::span(&box, 1)));
    ASSERT_LE(WorldAccess::state(world).sectors.size(), 4u);
    ASSERT_LE(WorldAccess::state(world).sector_of_cell.size(), 3u);
    if (step % 100 != 0) continue;
    const WorldView view{*make_view(Camera{.eye = {0.5f, 0.5f, 10}}, 64, 64), {x, 0, 0}};
    ASSERT_EQ(test::cull(world, view, visible).count, 1u);
    ASSERT_EQ(visible[0], handles[0].index);
  }
  ASSERT_TRUE(world.remove(handles));
  EXPECT_TRUE(WorldAccess::state(world).sector_of_cell.empty());
  ASSERT_TRUE(world.insert(home, handles));
  const WorldView back{*make_view(Camera{.eye = {0.5f, 0.5f, 10}}, 64, 64), {}};
  EXPECT_EQ(test::cull(world, back, visible).count, 1u);
  EXPECT_EQ(world.box(handles[1]), home[1]);
}

// A move or a removal looks at the sectors that it touches, however many there are.
TEST(World, TidiesOnlyTheSectorsItTouches) {
  World world;
  std::vector<WorldBox> boxes;
  for (int i = 0; i < 1000; ++i)
    boxes.push_back(wide({{0, 0, 0}, {1, 1, 1}}, {world::kSectorSide * i, 0, 0}));
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  const world::WorldState& state = WorldAccess::state(world);
  ASSERT_EQ(state.sectors.size(), 1000u);
  const auto tidied_by = [&](auto&& change) {
    const std::uint64_t before = state.tidied;
    EXPECT_TRUE(change());
    EXPECT_TRUE(state.touched.empty());
    for (const world::Sector& sector : state.sectors) {
      EXPECT_FALSE(sector.touched);
      if (sector.map) EXPECT_EQ(sector.bounds, sector.map->nodes()[0].bounds);
    }
    return state.tidied - before;
  };
  // Within its sector; to the next one, 7 leaving theirs empty; and several at once, each sector but once.
  const WorldBox aside = wide({{5, 0, 0}, {6, 1, 1}});
  EXPECT_EQ(tidied_by([&] { return world.move({&handles[0], 1}, std::span(&aside, 1)); }), 1u);
  EXPECT_EQ(
      tidied_by([&] { return world.move(std::span(handles).first(7), std::span(boxes).subspan(1, 7)); }), 8u);
  EXPECT_EQ(state.sector_of_cell.size(), 999u);
  const std::array both{handles[6], handles[7]};
  EXPECT_EQ(tidied_by([&] { return world.remove(both); }), 1u);
  EXPECT_EQ(state.sector_of_cell.size(), 998u);
  std::array<Handle, 2> again;
  EXPECT_EQ(tidied_by([&] { return world.insert(std::span(boxes).first(2), again); }), 2u);
  EXPECT_EQ(state.sectors.size(), 1000u);
}

// The sector's bounds against the frustum that its view has.
bool frustum_misses(const WorldView& view, const world::Sector& sector) {
  using namespace geometry;
  glm::dmat4 moved(1.0);
  moved[3] = {sector.origin.x - view.origin.x, sector.origin.y - view.origin.y,
              sector.origin.z - view.origin.z, 1.0};
  const glm::dmat4 clip = to_double(view.view.eye_to_clip) * (to_double(view.view.world_to_eye) * moved);
  const Frustum frustum = frustum_of(clip, view_direction(view.view), sector.bounds);
  return classify(frustum, sector.bounds) == Overlap::outside;
}

// What is said of a sector's bounds before its view is made must be what its view would say.
TEST(World, LeavesOutFarSectorsThatTheirOwnFrustumsMiss) {
  using namespace geometry;
  for (const double shift : {0.0, 1e7, 9e10}) {
    const WorldPoint origin{shift, 0, -shift};
    Random random(11);
    World world;
    Culler culler;
    std::map<ObjectId, WorldBox> twin;
    const Box around{{-60000, -4000, -60000}, {60000, 4000, 60000}};
    std::vector<WorldBox> boxes;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 at = random.inside(around);
      const float half = std::exp(random.between(-5, 6));
      boxes.push_back(
          wide({{at.x - half, at.y - half, at.z - half}, {at.x + half, at.y + half, at.z + half}}, origin));
    }
    std::vector<Handle> handles(boxes.size());
    ASSERT_TRUE(world.insert(boxes, handles));
    for (std::size_t i = 0; i < boxes.size(); ++i) twin[handles[i].index] = boxes[i];
    std::uint64_t outside = 0, missed = 0, kept = 0, orthographic = 0, infinite = 0, reversed = 0;
    for (int step = 0; step < 300; ++step) {
      const Camera camera = test::random_camera(random, around);
      const Result<View> made = make_view(camera, 1280, 720);
      if (!made) continue;
      WorldView view{*made, origin};
      if (step % 8 == 0) view.origin.x -= 1e6, view.origin.z += 1e6;
      orthographic += camera.orthographic_height > 0, infinite += std::isinf(camera.far_plane);
      reversed += camera.depth == Depth::reversed;
      for (const world::Sector& sector : WorldAccess::state(world).sectors) {
        const bool its_own = frustum_misses(view, sector);
        outside += its_own;
        if (!world::SectorTest(view).misses(sector.origin, sector.bounds)) continue;
        ++missed;
        ASSERT_TRUE(its_own) << "step " << step;
      }
      // Planes brought within millimetres of a sector's bounds.
      const auto& sectors = WorldAccess::state(world).sectors;
      const glm::dmat4 clip = to_double(made->eye_to_clip) * to_double(made->world_to_eye);
      const glm::dmat4 rows = glm::transpose(clip), back = glm::inverse(clip);
      for (const auto& [plane, middle] :
           {std::pair{rows[3] + rows[0], glm::dvec4(-1, 0, 0.5, 1)},
            std::pair{rows[3] - rows[1], glm::dvec4(0, 1, 0.5, 1)},
            std::pair{camera.depth == Depth::reversed ? rows[3] - rows[2] : rows[2],
                      glm::dvec4(0, 0, camera.depth == Depth::reversed ? 1 : 0, 1)}}) {
        const world::Sector& sector = sectors[random.below(static_cast<std::uint32_t>(sectors.size()))];
        const glm::dvec3 n = glm::normalize(glm::dvec3(plane));
        const glm::dvec4 on_plane = back * middle;
        const Box& b = sector.bounds;
        const glm::dvec3 corner(n.x >= 0 ? b.max.x : b.min.x, n.y >= 0 ? b.max.y : b.min.y,
                                n.z >= 0 ? b.max.z : b.min.z);
        const glm::dvec3 at = glm::dvec3(sector.origin.x, sector.origin.y, sector.origin.z) + corner -
                              glm::dvec3(on_plane) / on_plane.w + n * double{random.between(0, 0.004f)};
        const WorldView touching{*made, {at.x, at.y, at.z}};
        if (frustum_misses(touching, sector)) continue;
        ++kept;
        ASSERT_FALSE(world::SectorTest(touching).misses(sector.origin, sector.bounds)) << "step " << step;
      }
      if (step % 20 != 0) continue;
      expect_right(world, culler, twin, {&view, 1}, 0.5);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(kept, 30u);
    EXPECT_GT(orthographic, 9u);
    EXPECT_GT(infinite, 9u);
    EXPECT_GT(reversed, 9u);
    EXPECT_GT(outside, 100000u);
    EXPECT_GT(missed, outside - outside / 1000) << "of " << outside;
  }
}

TEST(World, DropsWhatCoversLessThanTheAreaAsked) {
  World world;
  std::vector<WorldBox> boxes;
  for (int i = 1; i <= 200; ++i) boxes.push_back({{-0.5, -0.5, -5.0 * i - 0.5}, {0.5, 0.5, -5.0 * i + 0.5}});
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  const View view = *make_view(Camera{}, 1280, 720);
  std::vector<ObjectId> visible(cull_capacity(world));
  const auto expected = [&](float area) {
    std::size_t count = 0;
    for (int i = 1; i <= 200; ++i) {
      const double scale = 720 / 2.0 / std::tan(0.5 * 1.04719755), d = 5.0 * i;
      count += M_PI * 0.75 * scale * scale / (d * d) >= area;
    }
    return count;
  };
  const WorldView at{view, {}};
  for (const float area : {1.0f, 4.0f, 100.0f}) {
    EXPECT_EQ(test::cull(world, at, visible, area).count, expected(area));
  }
  EXPECT_EQ(test::cull(world, at, visible).count, 200u);
}

// Masks of many views against each view culled alone.
void expect_each_alone(const World& world, std::span<const WorldView> views,
                       std::span<const OcclusionBuffer* const> occlusion) {
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(world)), single(visible.size());
  std::vector<std::uint8_t> masks(visible.size()), seen(world.id_limit(), 0);
  const std::vector<CullView> each = test::cull_views(views, 0, occlusion);
  const CullResult all = test::cull(culler, world, each, visible, masks);
  for (std::size_t i = 0; i < all.count; ++i) seen[visible[i]] = masks[i];
  std::uint64_t occluded = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const CullResult one = test::cull(culler, world, std::span(each).subspan(v, 1), single);
    occluded += one.culled_occlusion;
    std::size_t expected = 0;
    for (const std::uint8_t mask : seen) expected += mask >> v & 1;
    EXPECT_EQ(one.count, expected) << "view " << v;
    EXPECT_GT(one.count, 100u);
    for (std::size_t i = 0; i < one.count; ++i) ASSERT_TRUE(seen[single[i]] >> v & 1) << "view " << v;
  }
  EXPECT_EQ(all.culled_occlusion, occluded);
}

// Ids and masks are written in steps that reach beyond what is counted: never beyond the buffers.
TEST(World, FitsItsBuffersHoweverManyObjectsAChunkHolds) {
  Camera camera{.eye = {0, 0, 10}, .forward = {0, 0, -1}};
  camera.far_plane = 100;
  const WorldView whole{*make_view(camera, 640, 480), {}};
  camera.eye.x = 8.5f;  // its side crosses the objects
  std::size_t seen = 0, unseen = 0;
  const WorldView part{*make_view(camera, 640, 480), {}};
  for (std::size_t count = 1; count <= 200; ++count) {
    World world;
    std::vector<WorldBox> boxes(count);
    std::vector<Handle> handles(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = 0.01 * static_cast<double>(i) - 1;
      boxes[i] = {{x, -1, -1}, {x, 1, 1}};
    }
    ASSERT_TRUE(world.insert(boxes, handles));
    std::vector<ObjectId> one(cull_capacity(world));
    ASSERT_EQ(test::cull(world, whole, one).count, count);
    const std::array views{whole, part};
    std::vector<ObjectId> visible(cull_capacity(world));
    std::vector<std::uint8_t> masks(visible.size());
    Culler culler;
    const CullResult result = test::cull(culler, world, test::cull_views(views), visible, masks);
    ASSERT_EQ(result.count, count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(visible[i], one[i]);
      ASSERT_TRUE(masks[i] & 1);
      ++(masks[i] & 2 ? seen : unseen);
    }
    std::sort(visible.begin(), visible.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visible[i], i);
  }
  EXPECT_GT(seen, 100u);
  EXPECT_GT(unseen, 100u);
}

TEST(World, CullsViewsThatAreTheSameForEachOfThem) {
  Random random(21);
  World world;
  std::vector<WorldBox> boxes(20000);
  std::vector<Box> occluders;
  for (WorldBox& b : boxes) {
    const Vec3 at = random.inside({{-300, 0, -300}, {300, 20, 300}});
    b = {{at.x - 1.0, at.y - 1.0, at.z - 1.0}, {at.x + 1.0, at.y + 1.0, at.z + 1.0}};
    if (occluders.size() < 100) occluders.push_back({{at.x - 9, 0, at.z - 9}, {at.x + 9, 30, at.z + 9}});
  }
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  const auto view = [](float heading) {
    Camera camera{.eye = {0, 8, 0}, .forward = {std::sin(heading), 0, std::cos(heading)}};
    return WorldView{*make_view(camera, 320, 180), {}};
  };
  const WorldView a = view(0), b = view(0.5f), c = view(2);
  OcclusionBuffer of_a, of_b;
  ASSERT_TRUE(of_a.begin(a));
  ASSERT_TRUE(of_b.begin(b));
  EXPECT_TRUE(of_a.draw_boxes(occluders));
  EXPECT_TRUE(of_b.draw_boxes(occluders));
  const std::array pairs{a, b, a, b};
  const std::array five{a, b, a, c, b};
  const std::array same{c, c, c, c, c, c, c, c};
  expect_each_alone(world, pairs, {});
  expect_each_alone(world, five, {});
  expect_each_alone(world, same, {});
  // One view with its occluders and one without are two.
  const std::array<const OcclusionBuffer*, 5> occlusion{&of_a, &of_b, nullptr, nullptr, &of_b};
  expect_each_alone(world, five, occlusion);
  std::vector<ObjectId> visible(cull_capacity(world));
  std::vector<std::uint8_t> masks(visible.size());
  Culler culler;
  const CullResult result = test::cull(culler, world, test::cull_views(five, 0, occlusion), visible, masks);
  EXPECT_TRUE(std::any_of(masks.begin(), masks.begin() + static_cast<std::ptrdiff_t>(result.count),
                          [](std::uint8_t mask) { return (mask & 5) == 4; }));
}

// Into a new object, whose source is then assigned to again, and out of one that goes without more.
template <class T, class Works>
void expect_moves(T first, const Works& works) {
  T second(std::move(first));
  EXPECT_TRUE(works(second));
  first = std::move(second);
  EXPECT_TRUE(works(first));
}

TEST(World, AndAllThatMovesMayBeAssignedToAndGoWhenMovedFrom) {
  World world;
  std::array<Handle, 1> handle;
  const std::array boxes{Box{{-1, -1, -9}, {1, 1, -8}}};
  ASSERT_TRUE(world.insert(BoxView(boxes), handle));
  const CullView view{.view = {*make_view({}, 64, 64), {}}};
  std::vector<ObjectId> ids(cull_capacity(world));
  Instances instances;
  ObjectOrder order;
  ASSERT_TRUE(order.update(world));
  const auto takes_a_box = [&](auto& to) { return bool{to.insert(BoxView(boxes), handle)}; };
  const auto culls = [&](Culler& by) { return by.cull(world, view, ids)->count == 1; };
  expect_moves(World(), takes_a_box);
  expect_moves(Culler(), culls);
  expect_moves(RangeCuller(), [&](RangeCuller& by) { return bool{by.cull(world, order, view)}; });
  expect_moves(InstanceCuller(), [&](InstanceCuller& by) { return bool{by.cull(instances, view)}; });
  expect_moves(CullInspector(), [&](CullInspector& by) { return bool{by.inspect(world, {&view, 1})}; });
  expect_moves(Instances(), [&](Instances& in) { return bool{in.add_world(world)}; });
  expect_moves(ObjectOrder(), [&](ObjectOrder& in) { return bool{in.update(world)}; });
  expect_moves(ShadowCasters(), [&](ShadowCasters& in) { return bool{in.begin(view.view, view.view)}; });
  expect_moves(OcclusionBuffer(), [&](OcclusionBuffer& in) { return bool{in.begin(view.view)}; });
  expect_moves(OccluderMesh(), [](OccluderMesh& mesh) { return mesh.triangles() == 0; });
  expect_moves(OccludeeTriangles(), [](OccludeeTriangles& of) { return of.objects() == 0; });
  expect_moves(BoxBvh(), [&](BoxBvh& bvh) { return bool{bvh.build(boxes)}; });
  const test::FileBytes bytes = test::saved(world);
  World streamed;
  expect_moves(*WorldStream::open(bytes, streamed), [](WorldStream& stream) { return stream.size() == 1; });
}

}  // namespace
}  // namespace sightline
