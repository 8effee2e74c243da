// A rasteriser snaps corners to a grid of 1/256 pixel: next to an outline an occluder must hold nothing that
// a picture might show, and what is asked for must reach to where a picture might show it. Pixels are metres
// here.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sightline {
namespace {

constexpr std::uint32_t kSide = 64;

WorldView flat_view() {
  const Camera camera{.eye = {32, 32, 100}, .orthographic_height = kSide, .far_plane = 200};
  return {*make_view(camera, kSide, kSide), {}};
}

// Up to that x, over all rows, between two depths.
Box up_to(float x, float back, float front) {
  return {{-100, -100, back}, {x, 200, front}};
}

TEST(OutlineRims, HoldNoPixelCentreThatARasteriserMayMiss) {
  OcclusionBuffer buffer;
  std::vector<float> nearness(kSide * kSide);
  for (const float within : {1.0f / 1024, 1.0f / 300, 1.0f / 64}) {
    ASSERT_TRUE(buffer.begin(flat_view(), {Coverage::centres}));
    const std::array wall{up_to(20.5f + within, 0, 1)};
    ASSERT_TRUE(buffer.draw_boxes(wall));
    ASSERT_TRUE(buffer.read_nearness(nearness));
    const float* row = &nearness[std::size_t{kSide} * 30];
    EXPECT_GT(row[19], row[40]) << "drawn up to there";
    EXPECT_EQ(row[20] > row[40], within > 1.0f / 128) << within;
  }
}

TEST(OutlineRims, ReachEveryPixelCentreThatARasteriserMayFill) {
  OcclusionBuffer buffer;
  for (const float before : {1.0f / 1024, 1.0f / 300, 1.0f / 16}) {
    ASSERT_TRUE(buffer.begin(flat_view(), {Coverage::centres}));
    const std::array wall{up_to(20.3f, 0, 1)};
    ASSERT_TRUE(buffer.draw_boxes(wall));
    const std::array asked{Box{{5, 10, -20}, {20.5f - before, 50, -10}}};
    std::array<std::uint8_t, 1> seen{};
    ASSERT_TRUE(buffer.may_see(asked, seen));
    EXPECT_EQ(seen[0] != 0, before < 1.0f / 128) << before;
  }
}

}  // namespace
}  // namespace sightline
