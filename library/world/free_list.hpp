// Vectors whose elements are numbered for good: what is freed is used again before the vector grows.
#pragma once

#include <cstdint>
#include <vector>

namespace sightline::world {

/// The number of a free element, left as it was freed, or of a new one.
template <class Elements>
std::uint32_t take_element(Elements& elements, std::vector<std::uint32_t>& free) {
  if (free.empty()) {
    elements.emplace_back();
    return static_cast<std::uint32_t>(elements.size() - 1);
  }
  const std::uint32_t number = free.back();
  free.pop_back();
  return number;
}

}  // namespace sightline::world
