#include "workbench/measure/timing.hpp"

#include <algorithm>
#include <numeric>

namespace sightline::measure {

Timing timing_of(std::span<double> ms) noexcept {
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  const std::size_t middle = ms.size() / 2;
  const double median = ms.size() % 2 == 1 ? ms[middle] : 0.5 * (ms[middle - 1] + ms[middle]);
  return {median, ms.front(), ms.back()};
}

double typical_of(std::span<double> ms) noexcept {
  if (ms.empty()) return 0;
  std::sort(ms.begin(), ms.end());
  const std::span quicker = ms.first(ms.size() - ms.size() / 5);
  return std::accumulate(quicker.begin(), quicker.end(), 0.0) / static_cast<double>(quicker.size());
}

}  // namespace sightline::measure
