// What objects carry: doors, what moved, layers, the near plane, triangles, shapes turned and far away; and
// what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/solid_boxes.hpp"

namespace sightline {
namespace {

using namespace test;

// A wall, and boxes behind it.
struct Wall {
  static constexpr std::size_t kAll = 121;
  Wall() : scene(boxes()), view{.view = {at({0, 1, 0}, {0, 0, -1}), {}}} {}
  static std::vector<Box> boxes() {
    std::vector<Box> out{box_at({0, 1, -10}, {30, 30, 0.5f})};
    for (std::size_t i = 1; i < kAll; ++i)
      out.push_back(box_at({0.3f * static_cast<float>(i) - 18.3f, 1, -40}, {0.1f, 1, 0.1f}));
    return out;
  }
  // Large enough for each thing to hold a pixel's centre.
  static View at(const Vec3& eye, const Vec3& forward) { return looking(eye, forward, 1280, 960); }
  std::size_t seen(Culler& culler) {
    return cull_with(culler, scene.world, {&view, 1}, automatic(5e6f)).result.count;
  }
  // By a culler that remembers nothing, and so tries at once.
  std::size_t seen_anew() {
    Culler culler;
    return seen(culler);
  }
  SolidBoxes scene;
  CullView view;
};
constexpr std::size_t kAll = Wall::kAll;

TEST(Carriers, ADoorHidesWhileItIsSwitchedOn) {
  Wall wall;
  Culler culler;
  const std::span door = std::span(wall.scene.handles).first(1);
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(wall.seen(culler), 1u);
    ASSERT_TRUE(wall.scene.world.set_occluding(door, std::array<std::uint8_t, 1>{0}));
    EXPECT_EQ(wall.seen(culler), kAll);
    ASSERT_TRUE(wall.scene.world.set_occluding(door, std::array<std::uint8_t, 1>{1}));
    // Frames that hid nothing made the next tries rarer.
    for (int frame = 0; frame < 40; ++frame) static_cast<void>(wall.seen(culler));
  }
  const std::array<OccluderPlacement, 1> none{};
  ASSERT_TRUE(wall.scene.world.set_occluders(door, none));
  EXPECT_EQ(wall.seen(culler), kAll);
}

// Each zone ends within the one in which it began, and all that a cull does has one.
TEST(Carriers, ACullTellsAProfilerItsZones) {
  struct Told {
    std::vector<std::string> open, all;
  } told;
  Wall wall;
  CullOptions options = automatic(5e6f);
  options.zones = {[](void* user, const char* name) {
                     auto& t = *static_cast<Told*>(user);
                     t.open.emplace_back(name);
                     t.all.push_back(std::to_string(t.open.size()) + name);
                   },
                   [](void* user) { static_cast<Told*>(user)->open.pop_back(); }, &told};
  Culler culler;
  EXPECT_EQ(cull_with(culler, wall.scene.world, {&wall.view, 1}, options).result.count, 1u);
  EXPECT_TRUE(told.open.empty());
  const std::vector<std::string> expected{"1sightline: cull",
                                          "2sightline: regions and groups",
                                          "2sightline: chunks and objects",
                                          "2sightline: automatic occlusion",
                                          "3sightline: draw occluders",
                                          "3sightline: ask for what is hidden",
                                          "4sightline: chunks and objects",
                                          "3sightline: ask for triangles"};
  EXPECT_EQ(told.all, expected);
  options.zones.end = nullptr;
  std::vector<ObjectId> ids(cull_capacity(wall.scene.world));
  EXPECT_EQ(culler.cull(wall.scene.world, {&wall.view, 1}, options, {ids, {}}).error().code(),
            StatusCode::bad_argument);
}

TEST(Carriers, WhatMovedOrLeftHidesNothingWhereItWas) {
  Wall wall;
  Culler culler;
  EXPECT_EQ(wall.seen(culler), 1u);
  const std::span door = std::span(wall.scene.handles).first(1);
  const std::array away{box_at({0, 100, -10}, {30, 30, 0.5f})};
  ASSERT_TRUE(wall.scene.world.move(door, BoxView(away)));
  EXPECT_EQ(wall.seen(culler), kAll - 1);
  const std::array back{wall.scene.boxes[0]};
  ASSERT_TRUE(wall.scene.world.move(door, BoxView(back)));
  for (int frame = 0; frame < 40; ++frame) static_cast<void>(wall.seen(culler));
  EXPECT_EQ(wall.seen(culler), 1u);
  // Its id goes to another, which carries nothing.
  ASSERT_TRUE(wall.scene.world.remove(door));
  std::array<Handle, 1> other;
  ASSERT_TRUE(wall.scene.world.insert(BoxView(back), other));
  ASSERT_EQ(other[0].index, door[0].index);
  EXPECT_EQ(wall.seen(culler), kAll);
}

// Where its occluder, left behind, still lies within the box, too.
TEST(Carriers, WhatMovedWithinALargeBoxHidesNothingUntilItIsPlacedAgain) {
  Wall wall;
  World& world = wall.scene.world;
  const std::span door = std::span(wall.scene.handles).first(1);
  const auto wide = [](float x) { return std::array{box_at({x, 1, -10}, {50, 50, 2})}; };
  ASSERT_TRUE(world.move(door, BoxView(wide(0))));
  Occluder occluder;
  occluder.boxes = {box_at({0, 0, 0}, {30, 30, 0.5f})};
  const OccluderId shape = *world.add_occluder(occluder);
  OccluderPlacement placement{.occluder = shape, .transform = {}, .origin = {0, 1, -10}};
  ASSERT_TRUE(world.set_occluders(door, std::array{placement}));
  EXPECT_EQ(wall.seen_anew(), 1u);
  ASSERT_TRUE(world.move(door, BoxView(wide(20))));
  EXPECT_EQ(wall.seen_anew(), kAll);
  placement.origin.x = 20;
  ASSERT_TRUE(world.set_occluders(door, std::array{placement}));
  EXPECT_LT(wall.seen_anew(), kAll);
}

TEST(Carriers, WhatAViewDoesNotSeeHidesNothingFromIt) {
  Wall wall;
  const std::array<std::uint32_t, 1> layer{2};
  ASSERT_TRUE(wall.scene.world.set_layers(std::span(wall.scene.handles).first(1), layer));
  Culler culler;
  EXPECT_EQ(wall.seen(culler), 1u);
  wall.view.layers = 1;
  Culler another;
  EXPECT_EQ(wall.seen(another), kAll - 1);
}

TEST(Carriers, WhatTheNearPlaneCutsHidesNothingWithItsInside) {
  Wall wall;
  // From inside the wall one looks out of it.
  wall.view.view.view = Wall::at({0, 1, -10}, {0, 0, -1});
  EXPECT_EQ(wall.seen_anew(), kAll);
  wall.view.view.view = Wall::at({0, 1, -9.48f}, {0, 0, -1});  // 2 cm before it; the near plane is at 5 cm
  EXPECT_EQ(wall.seen_anew(), kAll);

  // A thinner wall inside it shows a front that is not drawn.
  const std::array inside{filling(box_at({0, 1, -10.3f}, {30, 30, 0.1f}), wall.scene.unit)};
  ASSERT_TRUE(wall.scene.world.set_occluders(std::span(wall.scene.handles).first(1), inside));
  for (const float z : {-9.8f, -9.48f}) {
    wall.view.view.view = Wall::at({0, 1, z}, {0, 0, -1});
    EXPECT_EQ(wall.seen_anew(), kAll);
  }
  wall.view.view.view = Wall::at({0, 1, 0}, {0, 0, -1});
  EXPECT_EQ(wall.seen_anew(), 1u);
}

TEST(Carriers, AsksForTheTrianglesOfWhatItsBoxLeaves) {
  Wall wall;
  World& world = wall.scene.world;
  // The foot of its box is nearer than the wall's upper part; its one triangle is behind all of it.
  const std::array boxes{Box{{-1, -2, -22}, {1, 100, -20}}};
  const std::array<Vec3, 3> hidden{Vec3{-1, -2, -21}, {1, -2, -21}, {0, 3, -21}};
  std::array<Handle, 1> handle;
  ASSERT_TRUE(world.insert(BoxView(boxes), handle));
  wall.view.view.view = Wall::at({0, 1, 0}, {0, 0.7f, -1});
  const std::size_t before = wall.seen_anew();
  ASSERT_TRUE(world.set_triangles(handle[0], hidden));
  EXPECT_EQ(wall.seen_anew(), before - 1);
  // From another origin nobody knows where they are.
  wall.view.view.origin = {0, 0, 1e-3};
  EXPECT_EQ(wall.seen_anew(), before);
  wall.view.view.origin = {};
  // They stayed where the object no longer is.
  const std::array moved{Box{{3, -2, -22}, {5, 100, -20}}};
  ASSERT_TRUE(world.move(handle, BoxView(moved)));
  EXPECT_EQ(wall.seen_anew(), before);
  ASSERT_TRUE(world.move(handle, BoxView(boxes)));
  EXPECT_EQ(wall.seen_anew(), before - 1);
  // Or where they lie within its box still.
  const std::array larger{Box{{-1, -2, -22}, {1.5f, 100, -20}}};
  ASSERT_TRUE(world.move(handle, BoxView(larger)));
  EXPECT_EQ(wall.seen_anew(), before);
  ASSERT_TRUE(world.set_triangles(handle[0], hidden));
  EXPECT_EQ(wall.seen_anew(), before - 1);
  ASSERT_TRUE(world.set_triangles(handle[0], {}));
  EXPECT_EQ(wall.seen_anew(), before);
}

TEST(Carriers, DoesNotSeeTrianglesOfOneSideFromBehind) {
  Wall wall;
  World& world = wall.scene.world;
  const std::array boxes{Box{{-1, 0, -6}, {1, 2, -5}}};  // before the wall
  const std::array<Vec3, 3> away{Vec3{-1, 0, -5.5f}, {0, 2, -5.5f}, {1, 0, -5.5f}},
      towards{away[0], away[2], away[1]};
  std::array<Handle, 1> handle;
  ASSERT_TRUE(world.insert(BoxView(boxes), handle));
  ASSERT_TRUE(world.set_triangles(handle[0], away));
  EXPECT_EQ(wall.seen_anew(), 2u);
  ASSERT_TRUE(world.set_triangles(handle[0], away, {}, Sides::front));
  EXPECT_EQ(wall.seen_anew(), 1u);
  ASSERT_TRUE(world.set_triangles(handle[0], towards, {}, Sides::front));
  EXPECT_EQ(wall.seen_anew(), 2u);
}

TEST(Carriers, ShapesAreSharedTurnedAndScaled) {
  World world;
  const std::vector<Box> boxes = Wall::boxes();
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  Occluder mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const std::array<Sphere, 1> ball{Sphere{{0, 0, 0}, 0.5f}};
  // A quad; the box of a wall turned by a quarter about y; a sphere that grew.
  const std::array shapes{*world.add_occluder(mesh), *world.add_occluder(kUnitBox),
                          *world.add_occluder({}, ball)};
  std::array<OccluderPlacement, 3> placements;
  for (std::size_t i = 0; i < 3; ++i) placements[i].occluder = shapes[i];
  placements[0].transform.m = {29, 0, 0, 0, 0, 29, 0, 0, 0, 0, 1, 0, 0, 1, -10, 1};
  placements[1].transform.m = {0, 0, -0.9f, 0, 0, 58, 0, 0, 58, 0, 0, 0, -29, -28, -9.55f, 1};
  placements[2].transform.m = {0.9f, 0, 0, 0, 0, 0.9f, 0, 0, 0, 0, 0.9f, 0, 0, 1, -10, 1};
  const CullView view{.view = {Wall::at({0, 1, 0}, {0, 0, -1}), {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(world.set_occluders(std::span(handles).first(1), std::span(placements).subspan(i, 1)));
    Culler culler;
    const std::size_t seen = cull_with(culler, world, {&view, 1}, automatic(5e6f)).result.count;
    // Behind the sphere, of 0.45 m at 10 m, stand those within 1.8 m of the middle at 40 m, less a pixel or
    // two.
    if (i < 2) EXPECT_EQ(seen, 1u) << i;
    if (i == 2) {
      EXPECT_GE(seen, kAll - 9);
      EXPECT_LE(seen, kAll - 4);
    }
  }
  EXPECT_FALSE(world.remove_occluder(shapes[2]));
  EXPECT_TRUE(world.remove_occluder(shapes[0]));
  EXPECT_FALSE(world.remove_occluder(shapes[0]));
}

TEST(Carriers, FarFromTheOriginItIsTheSame) {
  const std::vector<Box> boxes = Wall::boxes();
  const WorldPoint far{1e7, 0, -1e7};
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes, far), handles));
  std::array placements{filling(boxes[0], *world.add_occluder(kUnitBox))};
  placements[0].origin = far;
  ASSERT_TRUE(world.set_occluders(std::span(handles).first(1), placements));
  const CullView view{.view = {Wall::at({0, 1, 0}, {0, 0, -1}), far}};
  Culler culler;
  EXPECT_EQ(cull_with(culler, world, {&view, 1}, automatic(5e6f)).result.count, 1u);
}

// What moved a little, as seen from so far.
TEST(Carriers, FarFromTheOriginWhatMovedHidesNothingWhereItWas) {
  const auto seen_of = [](const World& world, const CullView& view, Handle of) {
    Culler culler;
    const Culled culled = cull_with(culler, world, {&view, 1}, automatic(1e7f));
    return std::ranges::count(culled.ids, of.index) == 1;
  };
  const Box wall = box_at({0, 0, -20.5f}, {4, 4, 0.5f}), behind = box_at({0, 0, -40.5f}, {0.5f, 0.5f, 0.5f});
  const std::array<Vec3, 3> its{Vec3{-0.4f, -0.4f, -40.5f}, {0.4f, -0.4f, -40.5f}, {0, 0.4f, -40.5f}};
  for (const double distance : {0.0, 1e5, 1e7, 1e10}) {
    for (const bool wall_moves : {true, false}) {
      SCOPED_TRACE(testing::Message() << distance << " m away, " << (wall_moves ? "the wall" : "the box"));
      const WorldPoint far{distance, 0, -distance};
      World world;
      std::array boxes{wall, behind};
      std::array<Handle, 2> handles;
      ASSERT_TRUE(world.insert(BoxView(boxes, far), handles));
      std::array placements{filling(wall, *world.add_occluder(kUnitBox))};
      placements[0].origin = far;
      ASSERT_TRUE(world.set_occluders(std::span(handles).first(1), placements));
      ASSERT_TRUE(world.set_triangles(handles[1], its, far));
      const CullView view{.view = {looking({0, 0, 0}, {0, 0, -1}), far}};
      EXPECT_FALSE(seen_of(world, view, handles[1]));
      Box& moved = boxes[wall_moves ? 0 : 1];
      moved.min.x += 9.5f, moved.max.x += 9.5f;
      ASSERT_TRUE(world.move(handles, BoxView(boxes, far)));
      EXPECT_TRUE(seen_of(world, view, handles[1]));
    }
  }
}

TEST(Carriers, RefusesWhatItCannotTake) {
  Wall wall;
  World& world = wall.scene.world;
  const std::span one = std::span(wall.scene.handles).first(1);
  Occluder bad;
  bad.solid_triangles = 1;
  EXPECT_EQ(world.add_occluder(bad).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(world.add_occluder({}, std::array<Sphere, 1>{Sphere{{}, -1}}).error().code(),
            StatusCode::bad_box);
  bad = kUnitBox;
  bad.boxes[0].max.x = -1;
  EXPECT_EQ(world.add_occluder(bad).error().code(), StatusCode::bad_box);
  bad.boxes.clear(), bad.indices = {0, 1, 2};
  EXPECT_EQ(world.add_occluder(bad).error().code(), StatusCode::bad_mesh);
  bad = kUnitBox, bad.sides = {static_cast<Sides>(9)};
  EXPECT_EQ(world.add_occluder(bad).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(world.remove_occluder(7).code(), StatusCode::bad_argument);
  std::array<OccluderPlacement, 1> placement{OccluderPlacement{7}};
  EXPECT_EQ(world.set_occluders(one, placement).code(), StatusCode::bad_argument);
  placement[0].occluder = wall.scene.unit;
  EXPECT_EQ(world.set_occluders({}, placement).code(), StatusCode::bad_argument);
  placement[0].transform.m[3] = 1;
  EXPECT_EQ(world.set_occluders(one, placement).index(), 0u);
  placement[0].transform = {}, placement[0].origin.x = NAN;
  EXPECT_EQ(world.set_occluders(one, placement).code(), StatusCode::bad_argument);
  EXPECT_EQ(world.set_occluding(one, std::array<std::uint8_t, 1>{2}).code(), StatusCode::bad_argument);
  EXPECT_EQ(world.set_occluding({}, std::array<std::uint8_t, 1>{1}).code(), StatusCode::bad_argument);
  const std::array<std::uint8_t, 2> switches{};
  EXPECT_STREQ(world.set_occluders(one, {nullptr, 1}).message(),
               "world: the placements' pointer is null or their stride too short");
  EXPECT_STREQ(world.set_occluding(one, {switches.data(), 1, 0}).message(),
               "world: the switches' pointer is null or their stride too short");
  EXPECT_EQ(world.set_triangles(one[0], std::array<Vec3, 2>{}).code(), StatusCode::bad_mesh);
  EXPECT_EQ(world.set_triangles({}, {}).code(), StatusCode::stale_handle);
  EXPECT_EQ(world.set_triangles(one[0], {}, {}, static_cast<Sides>(2)).code(), StatusCode::bad_argument);
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  CullOptions options = automatic(-1);
  EXPECT_EQ(culler.cull(world, {&wall.view, 1}, options, {ids}).error().code(), StatusCode::bad_argument);
  options = kAutomatic, options.buffer.scale = 3;
  EXPECT_EQ(culler.cull(world, {&wall.view, 1}, options, {ids}).error().code(), StatusCode::bad_argument);
  options = kAutomatic, options.buffer.coverage = static_cast<Coverage>(2);
  EXPECT_EQ(culler.cull(world, {&wall.view, 1}, options, {ids}).error().code(), StatusCode::bad_argument);
  options = kAutomatic, options.costs.query = INFINITY;
  EXPECT_EQ(culler.cull(world, {&wall.view, 1}, options, {ids}).error().code(), StatusCode::bad_argument);
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin(wall.view.view));
  wall.view.occlusion = &buffer;
  EXPECT_EQ(culler.cull(world, {&wall.view, 1}, kAutomatic, {ids}).error().index(), 0u);
}

}  // namespace
}  // namespace sightline
