#include "workbench/measure/turns.hpp"

#include <numeric>
#include <utility>

namespace sightline::measure {

Turns::Turns(std::size_t count, std::uint64_t seed) : order_(count), random_(seed) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
}

std::span<const std::size_t> Turns::next() {
  for (std::size_t k = 0; k < order_.size(); ++k)
    std::swap(order_[k], order_[k + random_.below(static_cast<std::uint32_t>(order_.size() - k))]);
  return order_;
}

}  // namespace sightline::measure
