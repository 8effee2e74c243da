// Counting in the masks of several views, a byte an object.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace sightline::world {

/// The sum of count(eight masks) over all, of fewer than eight with zeros behind.
template <class Count>
std::uint64_t sum_of_masks(std::span<const std::uint8_t> masks, const Count& count) noexcept {
  std::uint64_t sum = 0, eight = 0;
  for (; masks.size() >= sizeof eight; masks = masks.subspan(sizeof eight)) {
    std::memcpy(&eight, masks.data(), sizeof eight);
    sum += count(eight);
  }
  eight = 0;
  if (!masks.empty()) std::memcpy(&eight, masks.data(), masks.size());
  return sum + count(eight);
}

/// How many bits are set: objects, once for each view that sees them.
inline std::uint64_t count_bits(std::span<const std::uint8_t> masks) noexcept {
  // In parallel, as not every processor that the library serves has an instruction for it.
  return sum_of_masks(masks, [](std::uint64_t eight) {
    eight -= eight >> 1 & 0x5555555555555555u;
    eight = (eight & 0x3333333333333333u) + (eight >> 2 & 0x3333333333333333u);
    return ((eight + (eight >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56;
  });
}

/// How many masks have some of these bits: objects that some of those views see.
inline std::uint64_t count_with(std::span<const std::uint8_t> masks, std::uint8_t bits) noexcept {
  return sum_of_masks(masks, [bits](std::uint64_t eight) {
    constexpr std::uint64_t kLow = 0x7f7f7f7f7f7f7f7fu;
    eight &= bits * 0x0101010101010101u;
    return ((((eight & kLow) + kLow) | eight) >> 7 & 0x0101010101010101u) * 0x0101010101010101u >> 56;
  });
}

}  // namespace sightline::world
