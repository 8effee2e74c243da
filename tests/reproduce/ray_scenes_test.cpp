// Rays against triangles, against the item buffer: what they may lose and what not.
#include "workbench/reproduce/ray_pvs/ray_scenes.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include <sightline/workbench/io.hpp>

#include "workbench/oracle/pixel_coverage.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::reproduce {
namespace {

TEST(Blocks, AreThoseThatASearchOfEveryPlaceFinds) {
  scene::Random random(71);
  for (int round = 0; round < 300; ++round) {
    oracle::ItemBuffer image;
    image.width = 1 + random.below(12), image.height = 1 + random.below(12);
    image.pixels.assign(4, 0);
    for (std::uint32_t p = 0; p < image.width * image.height; ++p) {
      const std::uint32_t id = random.below(10);
      image.ids.push_back(id < 2 ? id : id < 3 ? kNoObject : p % image.width > 5 ? 2 : 3);
    }
    const std::uint32_t width = 1 + random.below(3), height = 1 + random.below(3);
    std::vector<std::uint8_t> expected(4, 0);
    for (std::uint32_t y = 0; y + height <= image.height; ++y) {
      for (std::uint32_t x = 0; x + width <= image.width; ++x) {
        const ObjectId id = image.ids[y * image.width + x];
        bool whole = id != kNoObject;
        for (std::uint32_t dy = 0; dy < height; ++dy) {
          for (std::uint32_t dx = 0; dx < width; ++dx) {
            whole = whole && image.ids[(y + dy) * image.width + x + dx] == id;
          }
        }
        if (whole) expected[id] = 1;
      }
    }
    ASSERT_EQ(oracle::objects_that_cover(image, width, height), expected) << round;
  }
}

// The rays of triangle-pvs stand in the middles of 13 × 7 pixels: whoever covers such a block has one of
// them, and is never lost. guided loses no more than its target in any view.
TEST(RayScenes, LoseNoObjectAsLargeAsTheSpacingAndNoMoreThanTheTarget) {
  std::vector<std::string> scenes{"world:irregular?detail=0"};
  for (const char* model : {"1", "2", "3", "4", "5"}) {
    scenes.push_back(std::string("world:strata?triangles=20000&model=") + model);
  }
  if (std::filesystem::exists("/usr/share/games/openarena/baseoa/pak1-maps.pk3")) {
    scenes.emplace_back("pak1-maps.pk3:maps/oa_dm1.bsp");
  }
  std::uint64_t lost = 0;
  for (const std::string& name : scenes) {
    const RayScene found = measure_ray_scene(load_scene(name), 3);
    EXPECT_EQ(found.views, 3u) << name;
    EXPECT_EQ(found.triangle_covers, 0u) << name;
    EXPECT_EQ(found.guided_over, 0u) << name << ": " << found.guided_worst;
    EXPECT_LT(found.guided_rays, found.pixels) << name;
    lost += found.triangle_lost;
  }
  EXPECT_GT(lost, 100u);  // small objects do fall between the rays
}

}  // namespace
}  // namespace sightline::reproduce
