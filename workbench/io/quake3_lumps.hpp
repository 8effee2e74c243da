// The parts of a Quake 3 level's file, by the directory in its header.
#pragma once

#include <cstring>

#include <fmt/format.h>

#include "workbench/io/quake3_format.hpp"

namespace sightline::io::quake3 {

class Level {
public:
  explicit Level(Bytes bytes) : bytes_(bytes) {
    if (bytes.size() < kHeaderSize) {
      throw Error(fmt::format("is {} bytes long, expected a header of {} bytes", bytes.size(), kHeaderSize));
    }
    if (std::memcmp(bytes.data(), "IBSP", 4) != 0)
      throw Error("does not begin with 'IBSP', expected a Quake 3 level");
    const auto version = read_at<std::uint32_t>(bytes, 4);
    if (version != 46) throw Error(fmt::format("has IBSP version {}, expected 46 (Quake 3)", version));
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(LumpId::count); ++i) {
      const auto offset = read_at<std::uint32_t>(bytes, 8 + 8 * i),
                 length = read_at<std::uint32_t>(bytes, 12 + 8 * i);
      if (!fits(offset, length, bytes.size())) {
        throw Error(fmt::format("has lump {} at bytes {} … +{}, but the file ends at {}", i, offset, length,
                                bytes.size()));
      }
    }
  }

  [[nodiscard]] Bytes lump(LumpId id) const {
    const std::size_t at = 8 + 8 * static_cast<std::size_t>(id);
    return bytes_.subspan(read_at<std::uint32_t>(bytes_, at), read_at<std::uint32_t>(bytes_, at + 4));
  }

private:
  static constexpr std::size_t kHeaderSize = 8 + 8 * static_cast<std::size_t>(LumpId::count);
  Bytes bytes_;
};

}  // namespace sightline::io::quake3
