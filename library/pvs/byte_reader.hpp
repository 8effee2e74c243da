// Reading numbers out of bytes that nobody vouches for.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace sightline::pvs {

static_assert(std::endian::native == std::endian::little, "the file formats read here are little-endian");

using Bytes = std::span<const std::byte>;

/// The number at `offset`; the caller has checked that it lies within.
template <class T>
T read_at(Bytes bytes, std::size_t offset) noexcept {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Whether [offset, offset + length) lies within `size`, for any values.
constexpr bool fits(std::uint64_t offset, std::uint64_t length, std::uint64_t size) noexcept {
  return offset <= size && length <= size - offset;
}

}  // namespace sightline::pvs
