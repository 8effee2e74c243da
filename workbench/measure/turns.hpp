// In which order those that are compared take their turns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "workbench/scene/random.hpp"

namespace sightline::measure {

/// An order drawn anew each round: in one that only rotates, each would forever run in the caches that the
/// same other one left behind.
class Turns {
public:
  /// Of so many, in orders that the seed alone says.
  Turns(std::size_t count, std::uint64_t seed);

  /// The next round: 0 … count - 1, each once. Good until the next call.
  std::span<const std::size_t> next();

private:
  std::vector<std::size_t> order_;
  scene::Random random_;
};

}  // namespace sightline::measure
