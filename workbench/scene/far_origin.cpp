#include "workbench/scene/far_origin.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::scene {

WorldPoint far_origin(const Box& extent) noexcept {
  const auto middle = [](float low, float high) { return 0.5 * (double{low} + high); };
  const WorldPoint centre{middle(extent.min.x, extent.max.x), middle(extent.min.y, extent.max.y),
                          middle(extent.min.z, extent.max.z)};
  const double size = std::max({double{extent.max.x} - extent.min.x, double{extent.max.y} - extent.min.y,
                                double{extent.max.z} - extent.min.z});
  const double away = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
  const bool is_far = away > 1e5 || (away > 1e3 && away > 16 * size);
  if (!is_far || !(away <= kWorldReach)) return {};
  const auto rounded = [](double v) { return 256 * std::round(v / 256) + 0.0; };  // and no -0
  return {rounded(centre.x), rounded(centre.y), rounded(centre.z)};
}

Vec3 to_scene(const WorldPoint& origin, const WorldPoint& point) noexcept {
  return {static_cast<float>(point.x - origin.x), static_cast<float>(point.y - origin.y),
          static_cast<float>(point.z - origin.z)};
}

WorldPoint to_world(const WorldPoint& origin, const Vec3& point) noexcept {
  return {origin.x + point.x, origin.y + point.y, origin.z + point.z};
}

}  // namespace sightline::scene
