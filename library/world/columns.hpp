// What objects have besides their boxes, and what a group of chunks knows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sightline/world.hpp>

namespace sightline::world {

/// One element an id; a column is empty until somebody sets one.
struct Columns {
  std::vector<std::uint32_t> layers, values;
  std::vector<DistanceRange> distances;
  bool has_layers = false, has_values = false, has_distances = false;

  /// Of an id that is new or used again, takes away what its last object had.
  void forget(ObjectId id);
  /// Whether there is one that says who is seen.
  [[nodiscard]] bool any() const noexcept { return has_layers || has_distances; }
};

/// What a group knows of the columns of its 32 chunks: rows of 32 numbers, a chunk each. Of layers, those
/// that some of the chunk's objects are in and those that all are in; of distances, the least and the
/// greatest `min` and the least and the greatest `max`.
struct LayerRows {
  static constexpr std::size_t kSize = 2 * 32, kSome = 0, kEvery = 32;
};
struct DistanceRows {
  static constexpr std::size_t kSize = 4 * 32, kFirstMin = 0, kLastMin = 32, kFirstMax = 64, kLastMax = 96;
};

}  // namespace sightline::world
