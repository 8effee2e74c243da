// Keys in 64 bits, sorted by their upper part.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace sightline::geometry {

/// Sorts by the bits from `first_bit` on, a multiple of 8, and keeps the order of keys that agree there.
/// Least significant byte first; std::sort would take four times as long. `scratch` is room, reused.
inline void sort_by_high_bits(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch,
                              int first_bit) {
  scratch.resize(keys.size());
  for (int shift = first_bit; shift < 64; shift += 8) {
    std::array<std::uint32_t, 256> start{};
    for (const std::uint64_t key : keys) ++start[key >> shift & 255];
    std::uint32_t sum = 0;
    for (std::uint32_t& bucket : start) sum += std::exchange(bucket, sum);
    for (const std::uint64_t key : keys) scratch[start[key >> shift & 255]++] = key;
    keys.swap(scratch);
  }
}

}  // namespace sightline::geometry
