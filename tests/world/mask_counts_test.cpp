#include "library/world/mask_counts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

TEST(MaskCounts, AreThoseOfBytesOneByOne) {
  scene::Random random(5);
  for (std::size_t size = 0; size < 70; ++size) {
    std::vector<std::uint8_t> masks(size);
    for (int turn = 0; turn < 20; ++turn) {
      for (std::uint8_t& mask : masks) mask = static_cast<std::uint8_t>(random.below(256));
      if (turn == 0) std::ranges::fill(masks, std::uint8_t{0xff});
      std::uint64_t set = 0;
      for (const std::uint8_t mask : masks) set += static_cast<std::uint64_t>(std::popcount(mask));
      EXPECT_EQ(world::count_bits(masks), set);
      for (const std::uint8_t bits : {0x00, 0x01, 0x80, 0x24, 0xff}) {
        const auto some = std::ranges::count_if(masks, [&](std::uint8_t mask) { return (mask & bits) != 0; });
        EXPECT_EQ(world::count_with(masks, bits), static_cast<std::uint64_t>(some)) << int{bits};
      }
    }
  }
}

}  // namespace
}  // namespace sightline
