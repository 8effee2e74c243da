#include <sightline/pvs.hpp>

#include <algorithm>

namespace sightline {

std::uint32_t CellPvs::cell_at(const Vec3& p) const noexcept {
  const auto along = [](float at, float low, float high, std::uint32_t count) -> std::uint32_t {
    if (!(at >= low && at <= high)) return kNoCell;
    const double share = high > low ? (double{at} - low) / (double{high} - low) : 0;
    return std::min(count - 1, static_cast<std::uint32_t>(share * count));
  };
  const std::uint32_t x = along(p.x, bounds.min.x, bounds.max.x, counts[0]),
                      y = along(p.y, bounds.min.y, bounds.max.y, counts[1]),
                      z = along(p.z, bounds.min.z, bounds.max.z, counts[2]);
  if (x == kNoCell || y == kNoCell || z == kNoCell) return kNoCell;
  const std::uint32_t cell = (z * counts[1] + y) * counts[0] + x;
  return open[cell] ? cell : kNoCell;
}

Box CellPvs::cell_bounds(std::uint32_t cell) const noexcept {
  const std::uint32_t x = cell % counts[0], y = cell / counts[0] % counts[1],
                      z = cell / counts[0] / counts[1];
  const auto at = [](float low, float high, std::uint32_t i, std::uint32_t count) {
    return i == count ? high : static_cast<float>(low + (double{high} - low) * i / count);
  };
  return {{at(bounds.min.x, bounds.max.x, x, counts[0]), at(bounds.min.y, bounds.max.y, y, counts[1]),
           at(bounds.min.z, bounds.max.z, z, counts[2])},
          {at(bounds.min.x, bounds.max.x, x + 1, counts[0]), at(bounds.min.y, bounds.max.y, y + 1, counts[1]),
           at(bounds.min.z, bounds.max.z, z + 1, counts[2])}};
}

}  // namespace sightline
