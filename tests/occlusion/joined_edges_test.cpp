// A pixel belongs to the triangles that are joined in it, edge by edge: what ends on one of their seams, or
// meets them in a corner alone, takes nothing from them. Pixels are metres here.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
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

}  // namespace
}  // namespace sightline
