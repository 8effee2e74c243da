// A pixel belongs to the triangles that are joined in it, edge by edge: what ends on one of their seams, or
// meets them in a corner alone, takes nothing from them. Pixels are metres here.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "workbench/scene/shapes.hpp"

namespace sightline {
namespace {

constexpr std::uint32_t kPixels = 64;

// Counter-clockwise from its front.
void add_fan(scene::Shape& shape, std::initializer_list<Vec3> corners) {
  const auto first = static_cast<std::uint32_t>(shape.positions.size());
  shape.positions.insert(shape.positions.end(), corners);
  for (std::uint32_t k = 2; k < corners.size(); ++k)
    shape.indices.insert(shape.indices.end(), {first, first + k - 1, first + k});
}

// Of a wall's pixels, two from its outline, those that hold nothing at any place of them.
std::size_t open_pixels(const scene::Shape& shape, TJunctions junctions) {
  const Camera camera{.eye = {32, 32, 100}, .orthographic_height = kPixels, .far_plane = 200};
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({*make_view(camera, kPixels, kPixels), {}}, {Coverage::area}));
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(shape.positions, shape.indices, Sides::both, junctions)));
  std::vector<float> nearness(kPixels * kPixels);
  EXPECT_TRUE(buffer.read_nearness(nearness));
  const float nothing = nearness[0];
  std::size_t open = 0;
  for (std::size_t y = 6; y < kPixels - 6; ++y)
    open += static_cast<std::size_t>(
        std::count(&nearness[y * kPixels + 6], &nearness[y * kPixels + kPixels - 6], nothing));
  return open;
}

TEST(JoinedEdges, WhatEndsOnASeamOfOthersLeavesItClosed) {
  scene::Shape wall;
  add_fan(wall, {{4, 4, 0}, {60, 4, 0}, {60, 30.3f, 0}, {4, 30.3f, 0}});
  add_fan(wall, {{4, 30.3f, 0}, {60, 30.3f, 0}, {60, 60, 0}, {4, 60, 0}});
  EXPECT_EQ(open_pixels(wall, TJunctions::closed), 0u);
  add_fan(wall, {{4, 30.3f, 0}, {40, 30.3f, 0}, {40, 34, 6}, {4, 34, 6}});
  EXPECT_EQ(open_pixels(wall, TJunctions::closed), 0u);
  const auto closed = *OccluderMesh::make(wall.positions, wall.indices, Sides::both, TJunctions::closed);
  EXPECT_EQ(closed.open_edges(), 6u + 3u);
}

TEST(JoinedEdges, WhatMeetsThemInACornerAloneIsAnothersOutline) {
  scene::Shape wall;
  for (const float x : {4.0f, 30.3f}) {
    for (const float y : {4.0f, 30.3f}) {
      const float right = x < 10 ? 30.3f : 60, top = y < 10 ? 30.3f : 60;
      add_fan(wall, {{x, y, 0}, {right, y, 0}, {right, top, 0}, {x, top, 0}});
    }
  }
  EXPECT_EQ(open_pixels(wall, TJunctions::open), 0u);
  add_fan(wall, {{30.3f, 30.3f, 0}, {50, 30.8f, 5}, {50, 40, 5}});
  EXPECT_EQ(open_pixels(wall, TJunctions::open), 0u);
}

// A fan about (32.5, 32.2), and on its lower side two that leave a wedge whose tip is next to its middle: a
// pixel of the fan's middle triangle reaches the wedge across the edge of another.
scene::Shape fan_above_a_wedge() {
  const Vec3 middle{32.5f, 32.2f, 0}, left{4, 32.2f, 0}, right{60, 32.2f, 0}, tip{32.45f, 32.2f, 0};
  scene::Shape shape;
  for (const auto& [a, b] :
       {std::pair{right, Vec3{45, 60, 0}}, {Vec3{45, 60, 0}, Vec3{20, 60, 0}}, {Vec3{20, 60, 0}, left}})
    add_fan(shape, {middle, a, b});
  add_fan(shape, {tip, {60, 4, 0}, right});
  add_fan(shape, {tip, left, {4, 4, 0}});
  return shape;
}

OcclusionBuffer drawn(const scene::Shape& shape) {
  const Camera camera{.eye = {32, 32, 100}, .orthographic_height = kPixels, .far_plane = 3000};
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({*make_view(camera, kPixels, kPixels), {}}, {Coverage::area}));
  const auto mesh = OccluderMesh::make(shape.positions, shape.indices, Sides::both, TJunctions::closed);
  EXPECT_TRUE(buffer.draw_mesh(*mesh));
  return buffer;
}

TEST(JoinedEdges, AHoleIsSeenWhoseTipLiesOnAnEdgeOfANeighbour) {
  const OcclusionBuffer buffer = drawn(fan_above_a_wedge());
  EXPECT_TRUE(buffer.may_see(Box{{32.44f, 32.05f, -10}, {32.46f, 32.1f, -9}}));
  EXPECT_FALSE(buffer.may_see(Box{{32.44f, 36, -10}, {32.46f, 37, -9}}));
  EXPECT_FALSE(buffer.may_see(Box{{50.4f, 30.1f, -10}, {50.5f, 30.2f, -9}}));
}

TEST(JoinedEdges, APitIsDeepWhoseRimHasACornerOnAnEdgeOfANeighbour) {
  scene::Shape shape = fan_above_a_wedge();
  const Vec3 tip{32.45f, 32.2f, 0}, bottom{32, 26, -600};
  add_fan(shape, {tip, {4, 4, 0}, bottom});
  add_fan(shape, {tip, bottom, {60, 4, 0}});
  const OcclusionBuffer buffer = drawn(shape);
  // Where the pit is some 14 m deep, and the box 6 m above it.
  EXPECT_TRUE(buffer.may_see(Box{{32.448f, 32.05f, -8}, {32.452f, 32.08f, -7.9f}}));
}

// How far away other things of the mesh stand does not matter.
TEST(JoinedEdges, ASlitStaysOpenHoweverFarTheMeshReaches) {
  for (const float far : {0.0f, 1e10f, 1e12f}) {
    scene::Shape walls;
    add_fan(walls, {{-28, 0.1f, 0}, {28, 0.1f, 0}, {0, 28, 0}});
    add_fan(walls, {{-28, 0.09f, 0}, {0, -28, 0}, {28, 0.09f, 0}});
    if (far > 0) add_fan(walls, {{far, 0, -5}, {far, 1, -5}, {far, 1, -6}});
    const auto mesh = *OccluderMesh::make(walls.positions, walls.indices, Sides::both, TJunctions::closed);
    EXPECT_EQ(mesh.open_edges(), far > 0 ? 9u : 6u) << far;
  }
}

TEST(JoinedEdges, AGapStaysOpenHoweverLongTheEdge) {
  constexpr float kLong = 1e6f, kHalf = 5e-4f;
  scene::Shape walls;
  add_fan(walls, {{-kLong, 0, 0}, {kLong, 0, 0}, {0, kLong, 0}});
  add_fan(walls, {{-kLong, 0, 0}, {-kHalf, -6, 0}, {-kHalf, 0, 0}});
  add_fan(walls, {{kHalf, 0, 0}, {kHalf, -6, 0}, {kLong, 0, 0}});
  const auto open = [&] {
    return OccluderMesh::make(walls.positions, walls.indices, Sides::both, TJunctions::closed)->open_edges();
  };
  const std::size_t before = open();
  add_fan(walls, {{-kHalf, 0, 0}, {-kHalf, -6, 0}, {kHalf, 0, 0}});
  EXPECT_LT(open(), before);
}

}  // namespace
}  // namespace sightline
