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
    ASSERT_FALSE(buffer.begin({view, {}}));
    buffer.draw_boxes(occluders);
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
