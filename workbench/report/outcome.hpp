// What became of each object of one view under one method.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/measure/compare.hpp"

namespace sightline::report {

enum class Outcome : std::uint8_t {
  culled,   ///< dropped, and no pixel shows it
  excess,   ///< kept, though no pixel shows it
  visible,  ///< kept, and seen
  lost,     ///< dropped, though seen
};
inline constexpr std::size_t kOutcomes = 4;

/// One view in full: the truth, and every object's outcome under every method.
struct Snapshot {
  struct Method {
    std::string name;
    std::vector<Outcome> outcomes;  ///< one an object
    std::array<std::size_t, kOutcomes> counts{};
  };
  std::size_t index = 0;  ///< of the camera on its path
  Camera camera;
  View view;  ///< of the picture
  oracle::ItemBuffer truth;
  std::vector<Method> methods;
};

/// Looks through the camera at this place of what was compared. The truth is a picture of the size given; who
/// keeps what is asked in the size that was compared, after some frames, which methods may remember. Throws
/// Error where the camera makes no view.
Snapshot take_snapshot(measure::Bench& bench, const measure::Comparison& comparison, std::size_t index,
                       std::uint32_t width, std::uint32_t height);

}  // namespace sightline::report
