#include "workbench/scene/patterns.hpp"

#include <algorithm>

#include "workbench/scene/random.hpp"

namespace sightline::scene {

AlphaImage leaves_pattern(std::uint32_t side, float share, std::uint64_t seed) {
  AlphaImage image{side, side, std::vector<std::uint8_t>(std::size_t{side} * side, 0)};
  Random random(seed);
  const auto wanted = static_cast<std::size_t>(share * static_cast<float>(image.alpha.size()));
  std::size_t opaque = 0;
  for (std::uint32_t leaf = 0; opaque < wanted && leaf < 64 * side; ++leaf) {
    const auto radius = static_cast<std::int64_t>(1 + side / 24 + random.below(1 + side / 12));
    const std::int64_t x0 = random.below(side), y0 = random.below(side);
    for (std::int64_t dy = -radius; dy <= radius; ++dy) {
      for (std::int64_t dx = -radius; dx <= radius; ++dx) {
        const std::int64_t off = dx * dx + dy * dy, inner = std::max<std::int64_t>(radius - 2, 0);
        if (off > radius * radius) continue;
        const std::uint8_t alpha = off <= inner * inner ? 255 : off <= (radius - 1) * (radius - 1) ? 170 : 85;
        const auto x = static_cast<std::size_t>((x0 + dx + side) % side),
                   y = static_cast<std::size_t>((y0 + dy + side) % side);
        std::uint8_t& texel = image.alpha[y * side + x];
        opaque += texel < 128 && alpha >= 128;
        texel = std::max(texel, alpha);
      }
    }
  }
  return image;
}

AlphaImage grate_pattern(std::uint32_t side, std::uint32_t pitch, std::uint32_t bar) {
  AlphaImage image{side, side, {}};
  image.alpha.reserve(std::size_t{side} * side);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      image.alpha.push_back(x % pitch < bar || y % pitch < bar ? 255 : 0);
    }
  }
  return image;
}

}  // namespace sightline::scene
