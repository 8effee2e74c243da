// The checksum of the files of baked visibility: FNV-1a.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sightline::pvs {

inline std::uint64_t checksum(std::span<const std::byte> bytes,
                              std::uint64_t seed = 0xcbf29ce484222325u) noexcept {
  for (const std::byte byte : bytes) seed = (seed ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  return seed;
}

}  // namespace sightline::pvs
