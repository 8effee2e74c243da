// Rectangles of many tiles, which coarser tiles answer for where they can.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sightline/projection.hpp>

#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;

// A view along -z in which a metre is a pixel, from the image's corner at the bottom left on.
struct PixelView {
  std::uint32_t width, height;

  [[nodiscard]] View view() const {
    Camera camera;
    camera.eye = {0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height), 10};
    camera.orthographic_height = static_cast<float>(height);
    return *make_view(camera, width, height);
  }
};

// Eight by eight boxes that overlap by a pixel, some of them left out.
std::vector<Box> wall_with_holes(const PixelView& image, Random& random) {
  const float across = static_cast<float>(image.width) / 8, down = static_cast<float>(image.height) / 8;
  std::vector<Box> boxes;
  for (int i = 0; i < 64; ++i) {
    if (random.between(0, 1) < 0.03f) continue;
    const float x = across * static_cast<float>(i % 8), y = down * static_cast<float>(i / 8),
                z = random.between(-2, 0);
    boxes.push_back({{x - 1, y - 1, z - 1}, {x + across + 1, y + down + 1, z}});
  }
  return boxes;
}

// Around the corners of a square, and nothing between them.
std::vector<Box> corner_posts() {
  std::vector<Box> posts;
  for (const float x : {10.0f, 50.0f}) {
    for (const float y : {10.0f, 50.0f}) posts.push_back({{x - 8, y - 8, 3}, {x + 8, y + 8, 4}});
  }
  return posts;
}

TEST(CoarseTiles, HideWhatTheirTilesHideAndNothingOfAnotherView) {
  Random random(71);
  OcclusionBuffer buffer;
  std::size_t hidden = 0, seen = 0;
  for (int round = 0; round < 300; ++round) {
    const PixelView image{1 + random.below(500), 1 + random.below(300)};
    const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    ASSERT_TRUE(buffer.begin({image.view(), {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_boxes(corner_posts()));
    if (width > 60 && height > 60)
      ASSERT_TRUE(buffer.may_see(Box{{10, 10, -5}, {50, 50, -5}})) << "between posts, round " << round;
    ASSERT_TRUE(buffer.draw_boxes(wall_with_holes(image, random)));
    std::vector<float> drawn(std::size_t{image.width} * image.height);
    ASSERT_TRUE(buffer.read_nearness(drawn));
    for (int i = 0; i < 60; ++i) {
      const float x = random.between(0, width), y = random.between(0, height),
                  right = x + random.between(0, width) * random.between(0, 1),
                  top = y + random.between(0, height) * random.between(0, 1), z = random.between(-4, 0);
      const bool may_see = buffer.may_see(Box{{x, y, z}, {right, top, z}});
      // The least nearness of the pixels whose centres lie in the rectangle, grown by so much.
      const auto least = [&](float by) {
        float out = INFINITY;
        const auto first = [&](float at) { return static_cast<int>(std::max(0.0f, std::ceil(at - 0.5f))); };
        const auto last = [&](float at, float end) {
          return static_cast<int>(std::min(end - 1, std::floor(at - 0.5f)));
        };
        for (int row = first(height - top - by); row <= last(height - y + by, height); ++row) {
          for (int column = first(x - by); column <= last(right + by, width); ++column)
            out = std::min(
                out, drawn[static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column)]);
        }
        return out;
      };
      if (least(-0.05f) < z - 10 - 0.01f) ASSERT_TRUE(may_see) << "round " << round << " box " << i;
      if (least(0.05f) > z - 10 + 0.01f) ASSERT_FALSE(may_see) << "round " << round << " box " << i;
      ++(may_see ? seen : hidden);
    }
  }
  EXPECT_GT(hidden, 3000u);
  EXPECT_GT(seen, 3000u);
}

}  // namespace
}  // namespace sightline
