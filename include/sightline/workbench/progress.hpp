// How work that takes long reports its progress.
#pragma once

#include <cstddef>
#include <functional>

namespace sightline {

/// Told after each step how many are done, of how many.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

}  // namespace sightline
