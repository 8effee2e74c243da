// Meshes whose triangles are drawn, and so occlude, from their front alone.
#include <gtest/gtest.h>

#include <sightline/occlusion.hpp>

#include "library/geometry/linear.hpp"
#include "support/exact_rays.hpp"
#include "support/small_scenes.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;
using Triangle = std::array<Vec3, 3>;

const std::array kWall{Vec3{-9, -9, -5}, Vec3{9, -9, -5}, Vec3{9, 9, -5}, Vec3{-9, 9, -5}};
const std::array<std::uint32_t, 6> kFront{0, 1, 2, 0, 2, 3}, kBack{2, 1, 0, 3, 2, 0};
const Box kBehind{{-1, -1, -9}, {1, 1, -8}};

bool hides(const Camera& camera, std::span<const std::uint32_t> indices, std::span<const Sides> sides,
           const Mat4& transform = {}) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({*make_view(camera, 64, 48), {}}, {Coverage::centres}));
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(kWall, indices, sides), transform));
  return !buffer.may_see(kBehind);
}

TEST(SidedMeshes, AWallHidesFromItsFrontAndNotFromBehind) {
  const std::array front{Sides::front}, both{Sides::both};
  const std::array halves{Sides::front, Sides::both};
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    for (const float height : {0.0f, 8.0f}) {
      const Camera camera{.orthographic_height = height, .depth = depth};
      EXPECT_TRUE(hides(camera, kFront, front));
      EXPECT_FALSE(hides(camera, kBack, front));
      EXPECT_TRUE(hides(camera, kBack, both));
      EXPECT_TRUE(hides(camera, kFront, halves));
      EXPECT_FALSE(hides(camera, kBack, halves));
      EXPECT_TRUE(hides(camera, kBack, {}));
    }
  }
}

TEST(SidedMeshes, AMirrorTurnsNothingInsideOut) {
  Mat4 mirror;
  mirror.m[0] = -1;
  const std::array front{Sides::front};
  EXPECT_TRUE(hides({}, kFront, front, mirror));
  EXPECT_FALSE(hides({}, kBack, front, mirror));
}

TEST(SidedMeshes, WhatTheNearPlaneCutsHasSidesToo) {
  // A floor under the eye that begins behind it, and a box beneath.
  const std::array floor{Vec3{-90, -1, 90}, Vec3{90, -1, 90}, Vec3{90, -1, -90}, Vec3{-90, -1, -90}};
  const Box beneath{{-1, -9, -9}, {1, -8, -7}};
  for (const bool from_front : {false, true}) {
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({*make_view(Camera{.forward = {0, -1, -1}}, 64, 48), {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_mesh(*OccluderMesh::make(floor, from_front ? kFront : kBack, Sides::front)));
    EXPECT_EQ(buffer.may_see(beneath), !from_front);
  }
}

TEST(SidedMeshes, EndWhereANeighbourIsSeenFromBehind) {
  // Seen from behind, a metre a pixel; where the two meet lie pixels' centres.
  const std::array corners{Vec3{-20, -20, -5}, Vec3{0.5f, -20, -5}, Vec3{0.5f, 20, -5}, Vec3{20, 0, -5}};
  const std::array<std::uint32_t, 6> indices{2, 1, 0, 1, 2, 3};
  for (const bool alone : {false, true}) {
    const std::array sides{Sides::both, alone ? Sides::front : Sides::both};
    OcclusionBuffer buffer;
    ASSERT_TRUE(
        buffer.begin({*make_view(Camera{.orthographic_height = 64}, 64, 64), {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_mesh(*OccluderMesh::make(corners, indices, sides)));
    std::vector<float> nearness(64 * 64);
    ASSERT_TRUE(buffer.read_nearness(nearness));
    EXPECT_GT(nearness[32 * 64 + 31], ExactRays::kMiss);
    EXPECT_EQ(nearness[32 * 64 + 32] > ExactRays::kMiss, !alone);
    EXPECT_EQ(nearness[32 * 64 + 34] > ExactRays::kMiss, !alone);
  }
}

// Whether the ray through a pixel's centre meets the triangle's front.
bool faces(const View& view, const Triangle& t) {
  using namespace geometry;
  const glm::dvec3 p = to_double(t[0]), normal = glm::cross(to_double(t[1]) - p, to_double(t[2]) - p);
  const glm::dmat4 to_world = glm::inverse(to_double(view.world_to_eye));
  const glm::dvec3 ray = is_orthographic(view) ? -glm::dvec3(to_world[2]) : p - glm::dvec3(to_world[3]);
  return glm::dot(normal, ray) < 0;
}

TEST(SidedMeshes, NeverCoverWhatTheirFrontsDoNot) {
  Random random(19);
  std::size_t covered = 0, open = 0;
  for (int round = 0; round < 60; ++round) {
    const View view = test::small_view(random);
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<Sides> sides;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const Box box = test::box_of(random, 8);
      positions.insert(positions.end(), {box.min, {box.max.x, box.min.y, box.max.z}, box.max});
      indices.insert(indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
      sides.push_back(random.unit() < 0.7f ? Sides::front : Sides::both);
    }
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_mesh(*OccluderMesh::make(positions, indices, sides)));
    std::vector<float> nearness(std::size_t{view.width} * view.height);
    ASSERT_TRUE(buffer.read_nearness(nearness));
    const ExactRays rays(view);
    for (std::size_t pixel = 0; pixel < nearness.size(); ++pixel) {
      double truth = ExactRays::kMiss;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const Triangle t{positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
        if (sides[i] == Sides::front && !faces(view, t)) continue;
        truth = std::max(truth, rays.hit(pixel % view.width + 0.5, pixel / view.width + 0.5, t));
      }
      ASSERT_LE(nearness[pixel], truth) << "round " << round << " pixel " << pixel;
      covered += nearness[pixel] > ExactRays::kMiss;
      open += truth > ExactRays::kMiss && !(nearness[pixel] > ExactRays::kMiss);
    }
  }
  EXPECT_GT(covered, 10 * open);
}

}  // namespace
}  // namespace sightline
