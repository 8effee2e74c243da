// Occluders stand to the digit where their placements say, wherever the view's origin and theirs are: judged
// in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/world.hpp>

#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

// How many of these a view about `origin` shows, with every object dear enough that all is tried.
std::size_t shown(const World& world, const View& view, const WorldPoint& origin) {
  const CullView at{.view = {view, origin}};
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  return culler
      .cull(world, {&at, 1}, {.occlusion = Occlusion::automatic, .costs = {.object = 1e6f}}, {.ids = ids})
      ->count;
}

// An object whose box is its occluder, and nothing else: hidden it is only by itself.
TEST(PlacedOccluders, NoWallHidesItself) {
  for (int i = 1; i < 600; ++i) {
    const float depth = 0.1f * static_cast<float>(i % 7 + 1), moved = -4.3f * static_cast<float>(i);
    const bool by_origin = i % 2 == 0;
    Occluder wall;
    wall.positions = {{-1, -1, depth}, {1, -1, depth}, {1, 1, depth}, {-1, 1, depth}};
    wall.indices = {0, 1, 2, 0, 2, 3};
    wall.sides = {Sides::both, Sides::both};
    World world;
    OccluderPlacement placement{*world.add_occluder(wall)};
    if (by_origin)
      placement.origin.z = double{moved};
    else
      placement.transform.m[14] = moved;
    const double z = double{depth} + double{moved};
    const WorldBox box{{-1, -1, z}, {1, 1, z}};
    Handle handle;
    ASSERT_TRUE(world.insert(BoxView(std::span(&box, 1)), std::span(&handle, 1)));
    ASSERT_TRUE(world.set_occluders(std::span(&handle, 1), std::span(&placement, 1)));
    const float away = i % 3 == 0 ? 0.3f : 2;
    const View view = *make_view({.eye = {0, 0, static_cast<float>(z) + away}}, 128, 128);
    ASSERT_EQ(shown(world, view, {}), 1u) << i;
  }
}

// A wall that is moved by less than a millimetre reaches out of its box until its occluder is placed again:
// what stands beside the box is seen.
TEST(PlacedOccluders, WallsThatReachOutOfTheirBoxHideNothing) {
  constexpr double kMoved = 9e-4;
  Occluder wall;
  wall.boxes = {{{-1, -1, -0.1f}, {1, 1, 0.1f}}};
  const View view = *make_view({.eye = {-1 + static_cast<float>(kMoved) / 2, 0, 4},
                                .orthographic_height = 4 * static_cast<float>(kMoved),
                                .near_plane = 0.1f,
                                .far_plane = 5.5f},
                               2048, 1024);
  World world;
  const OccluderPlacement placement{*world.add_occluder(wall)};
  std::vector<WorldBox> boxes{{{-1, -1, -0.1}, {1, 1, 0.1}}};
  for (int i = 0; i < 20; ++i) {
    const double x = -1 + kMoved * (i + 0.5) / 20, e = kMoved / 60;
    boxes.push_back({{x - e, -e, -1 - e}, {x + e, e, -1 + e}});
  }
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(std::span<const WorldBox>(boxes)), handles));
  ASSERT_TRUE(world.set_occluders(std::span(handles).first(1), std::span(&placement, 1)));
  EXPECT_EQ(shown(world, view, {}), 1u);
  boxes[0].min.x += kMoved, boxes[0].max.x += kMoved;
  ASSERT_TRUE(world.move(std::span(handles).first(1), BoxView(std::span<const WorldBox>(boxes).first(1))));
  EXPECT_EQ(shown(world, view, {}), boxes.size());
}

// A ball far from its occluder's origin, brought before the eye by its placement, and specks behind it that
// pixels' rays meet beside it.
TEST(PlacedOccluders, BallsFarFromTheirOriginHideNothingBesideThem) {
  scene::Random random(5);
  for (int round = 0; round < 40; ++round) {
    const float far = 1e4f * static_cast<float>(round + 1), c = std::cos(static_cast<float>(round)),
                s = std::sin(static_cast<float>(round));
    const Sphere ball{{far, 0, random.between(-far, far)}, 5};
    OccluderPlacement placement;
    placement.transform.m = {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1};
    const double turned_x = double{c} * ball.centre.x - double{s} * ball.centre.z,
                 turned_z = double{s} * ball.centre.x + double{c} * ball.centre.z;
    placement.transform.m[12] = static_cast<float>(-turned_x);
    placement.transform.m[14] = static_cast<float>(-20 - turned_z);
    const double x = turned_x + placement.transform.m[12], z = turned_z + placement.transform.m[14];
    World world;
    placement.occluder = *world.add_occluder({}, {&ball, 1});
    std::vector<WorldBox> boxes{{{x - 8, -8, z - 8}, {x + 8, 8, z + 8}}};
    const View view = *make_view({.orthographic_height = 14}, 128, 128);
    for (std::uint32_t pixel = 0; pixel < 128 * 128; ++pixel) {
      const double px = ((pixel % 128 + 0.5) / 64 - 1) * 7, py = (1 - (pixel / 128 + 0.5) / 64) * 7;
      const double apart = std::hypot(px - x, py) - 5;
      if (apart < 0.0011 || apart > 0.1) continue;
      boxes.push_back({{px - 1e-3, py - 1e-3, -60}, {px + 1e-3, py + 1e-3, -60}});
    }
    std::vector<Handle> handles(boxes.size());
    ASSERT_TRUE(world.insert(BoxView(std::span<const WorldBox>(boxes)), handles));
    ASSERT_TRUE(world.set_occluders(std::span(handles).first(1), std::span(&placement, 1)));
    ASSERT_EQ(shown(world, view, {}), boxes.size()) << round;
  }
}

}  // namespace
}  // namespace sightline
