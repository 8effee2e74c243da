// The cases that occlusion culling is known to get wrong, each a small world of its own, against exact rays.
#include <gtest/gtest.h>

#include <sightline/occlusion.hpp>

#include "support/exact_rays.hpp"

namespace sightline {
namespace {

using test::ExactRays;

struct Case {
  std::size_t seen = 0, kept = 0, hidden = 0;

  // One frame: what a pixel centre sees must be kept.
  void frame(const View& view, std::span<const Box> occluders, const Box& object) {
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    const ExactRays rays(view);
    bool visible = false;
    for (std::uint32_t y = 0; y < view.height && !visible; ++y) {
      for (std::uint32_t x = 0; x < view.width && !visible; ++x) {
        const double at = rays.hit(x + 0.5, y + 0.5, object);
        double cover = ExactRays::kMiss;
        for (const Box& box : occluders) cover = std::max(cover, rays.hit(x + 0.5, y + 0.5, box));
        visible = at > cover;
      }
    }
    const bool may = buffer.may_see(object);
    if (visible) ASSERT_TRUE(may);
    seen += visible, kept += may, hidden += !may;
  }
};

View looking(const Camera& camera) {
  return *make_view(camera, 96, 64);
}

TEST(OcclusionCases, AThingSeenThroughAThinGap) {
  Case c;
  for (int i = 0; i < 120; ++i) {
    const float gap = 0.001f * static_cast<float>(i), shift = 0.003f * static_cast<float>(i);
    const std::array occluders{Box{{-20, -20, -1}, {shift, 20, 0}}, Box{{shift + gap, -20, -1}, {20, 20, 0}}};
    c.frame(looking({.eye = {0.05f, 0, 5}}), occluders, {{-1, -1, -9}, {1, 1, -8}});
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(c.seen, 10u);
  EXPECT_GT(c.hidden, 10u);
}

TEST(OcclusionCases, ALargeThingThroughAnOpeningAtTheViewportsEdge) {
  Case c;
  for (int i = 0; i < 100; ++i) {
    // The image is 5.77·1.5 m wide at 5 m; the wall ends about its left edge.
    const float edge = -4.33f - 0.1f + 0.003f * static_cast<float>(i);
    const std::array occluders{Box{{edge, -20, -1}, {20, 20, 0}}};
    c.frame(looking({.eye = {0, 0, 5}}), occluders, {{-200, -150, -90}, {200, 150, -80}});
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(c.seen, 10u);
  EXPECT_GT(c.hidden, 10u);
}

TEST(OcclusionCases, TouchingTilesInAnOrthographicView) {
  Case c;
  for (int i = 0; i < 60; ++i) {
    std::vector<Box> tiles;
    const float shift = 0.0137f * static_cast<float>(i);
    for (int x = -6; x < 6; ++x) {
      for (int z = -6; z < 6; ++z) {
        if (i % 3 == 0 && x == 0 && z == 0) continue;  // a tile is missing
        const float at_x = shift + static_cast<float>(x), at_z = shift + static_cast<float>(z);
        tiles.push_back({{at_x, 0, at_z}, {at_x + 1, 0.2f, at_z + 1}});
      }
    }
    Camera camera{.eye = {0, 10, 0}, .forward = {0, -1, 0}, .up = {0, 0, -1}};
    camera.orthographic_height = 6;
    camera.near_plane = 0;
    camera.far_plane = 64;
    camera.depth = i % 2 ? Depth::reversed : Depth::standard;
    c.frame(looking(camera), tiles, {{0.3f, -2, 0.3f}, {0.6f, -1, 0.6f}});
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(c.seen, 5u);
  EXPECT_GT(c.hidden, 5u);
}

TEST(OcclusionCases, TheEyeCloseToAnOccluderAndInsideOne) {
  Case c;
  const Box object{{-1, -1, -30}, {1, 1, -28}};
  const std::array occluders{Box{{-3, -3, -1}, {3, 3, 1}}};
  for (int i = 0; i < 200; ++i) {
    Camera camera{.eye = {0.1f, 0.1f, 1.5f - 0.01f * static_cast<float>(i)}};
    camera.forward = {0, 0.003f * static_cast<float>(i % 7), -1};
    camera.near_plane = i % 2 ? 0.1f : 0.3f;
    c.frame(looking(camera), occluders, object);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(c.hidden, 10u);  // near, but before it
  EXPECT_GT(c.kept, 50u);    // inside
}

bool seen_beside_mesh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                      const Box& object) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({*make_view(Camera{.near_plane = 0.1f, .far_plane = 2000}, 1280, 720), {}},
                           {Coverage::centres}));
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(positions, indices)));
  return buffer.may_see(object);
}

TEST(OcclusionCases, BeforeALongThinTriangleThatTheNearPlaneCuts) {
  // Its corners lie far behind the eye and before it, so its plane near the eye hangs on their last digits.
  // The boxes are 0.1 % and 1 % nearer than it.
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  const std::array<Vec3, 3> a{Vec3{40.706974f, 33.5703278f, 39.6204681f},
                              Vec3{-20.9666214f, -16.9682941f, -20.7303028f},
                              Vec3{0.80761534f, 1.07009804f, 0.256068408f}};
  EXPECT_TRUE(seen_beside_mesh(
      a, indices,
      {{-0.210826546f, 0.0517381877f, -0.438929707f}, {-0.210825667f, 0.0517390668f, -0.438925326f}}));
  const std::array<Vec3, 3> b{Vec3{206.847321f, 120.47831f, -189.304291f},
                              Vec3{-64.3020096f, -37.5403748f, 58.7040443f},
                              Vec3{-6.78999615f, -7.17136192f, 3.97707176f}};
  EXPECT_TRUE(seen_beside_mesh(
      b, indices,
      {{0.337599933f, -0.0370386653f, -0.530917764f}, {0.337601006f, -0.0370376036f, -0.530912459f}}));
}

TEST(OcclusionCases, BehindWhatTheNearPlaneCutsOffFarFromTheOrigin) {
  // A wall 50 µm nearer than the near plane, or 1 mm farther, seen from 231 m away from the origin.
  const std::array<std::uint32_t, 6> indices{0, 1, 2, 0, 2, 3};
  const Camera camera{.eye = {2.5f, 1.5f, 231.5f}, .forward = {0, 0, -1}, .near_plane = 0.0128f};
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    Camera here = camera;
    here.depth = depth;
    for (const float farther : {-5e-5f, 1e-3f}) {
      const float z = 231.5f - (camera.near_plane + farther);
      const std::array<Vec3, 4> wall{Vec3{1.5f, 0.5f, z}, Vec3{3.5f, 0.5f, z}, Vec3{3.5f, 2.5f, z},
                                     Vec3{1.5f, 2.5f, z}};
      OcclusionBuffer buffer;
      ASSERT_TRUE(buffer.begin({*make_view(here, 160, 120), {}}, {Coverage::centres}));
      ASSERT_TRUE(buffer.draw_mesh(*OccluderMesh::make(wall, indices)));
      EXPECT_EQ(buffer.may_see(Box{{2, 1, 225}, {3, 2, 226}}), farther < 0) << farther;
    }
  }
}

TEST(OcclusionCases, BesideTheTipOfAFanWhoseFarCornersLieBeyondTheImage) {
  // The middle triangle meets the outline at the tip alone, where two seams bound it; the boxes lie 0.035 and
  // 0.002 pixels outside.
  const std::array<std::uint32_t, 15> indices{0, 1, 1, 2, 3, 3, 0, 1, 4, 1, 2, 4, 2, 3, 4};
  const std::array<Vec3, 5> wide{
      Vec3{90.9346161f, 83.6410446f, -0.186803475f}, Vec3{276.89505f, 214.796402f, -0.177292496f},
      Vec3{326.836761f, 91.5983505f, -0.465546787f}, Vec3{244.41394f, 28.4981594f, -0.1936941f},
      Vec3{-2.83456755f, 0.0742960274f, -13.5402069f}};
  EXPECT_TRUE(seen_beside_mesh(
      wide, indices, {{-6.2826848f, 0.164393857f, -30.0100002f}, {-6.27468491f, 0.172393844f, -30.0f}}));
  const std::array<Vec3, 5> small{
      Vec3{4.95818281f, 14.6525803f, -0.380099952f}, Vec3{4.6761179f, 13.5314951f, -0.195456579f},
      Vec3{7.37944603f, 8.93720436f, -0.131871328f}, Vec3{4.59598446f, 5.3677268f, -0.243035123f},
      Vec3{-3.38174748f, 1.09854162f, -7.65373993f}};
  EXPECT_TRUE(seen_beside_mesh(
      small, indices, {{-13.2590017f, 4.30207109f, -30.0100002f}, {-13.2510014f, 4.31007147f, -30.0f}}));
}

TEST(OcclusionCases, ASlowObjectLeavingCover) {
  Case c;
  const std::array occluders{Box{{-2, -2, -1}, {2, 2, 0}}};
  bool was_hidden = false;
  for (int i = 0; i < 400; ++i) {
    const float x = 1.5f + 0.01f * static_cast<float>(i);
    const std::size_t hidden = c.hidden;
    c.frame(looking({.eye = {0, 0, 5}}), occluders, {{x, -0.2f, -4}, {x + 0.5f, 0.2f, -3.5f}});
    if (HasFatalFailure()) return;
    was_hidden = was_hidden || c.hidden > hidden;
  }
  EXPECT_TRUE(was_hidden);
  EXPECT_GT(c.seen, 100u);
}

}  // namespace
}  // namespace sightline
