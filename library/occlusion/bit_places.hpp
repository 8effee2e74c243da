// The places of set bits, looked up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sightline::occlusion {

/// Of each byte the places of its bits, from the lowest, and how many there are.
struct BitPlaces {
  std::array<std::array<std::uint8_t, 8>, 256> of{};
  std::array<std::uint8_t, 256> count{};

  constexpr BitPlaces() {
    for (std::size_t byte = 0; byte < of.size(); ++byte) {
      for (std::uint8_t place = 0; place < 8; ++place) {
        if (byte >> place & 1) of[byte][count[byte]++] = place;
      }
    }
  }
};
inline constexpr BitPlaces kBitPlaces;

}  // namespace sightline::occlusion
