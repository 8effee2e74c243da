// What objects have besides their boxes, and what a group of chunks knows of it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sightline/world.hpp>

namespace sightline::world {

/// One element an id; a column is empty until somebody sets one.
struct Columns {
  std::vector<std::uint32_t> layers, values;
  std::vector<DistanceRange> distances;
  bool has_layers = false, has_values = false, has_distances = false;

  /// Whether there is one that says who is seen.
  [[nodiscard]] bool any() const noexcept { return has_layers || has_distances; }
};

/// Of each of a group's 32 chunks the layers that some of its objects are in, and those that all are in.
struct alignas(64) LayerSummary {
  std::array<std::uint32_t, 32> some{}, every{};
};

/// Of each chunk the least and the greatest of where its objects begin to be seen, and cease to be.
struct alignas(64) DistanceSummary {
  std::array<float, 32> first_min{}, last_min{}, first_max{}, last_max{};
};

}  // namespace sightline::world
