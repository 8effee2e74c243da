// Clusters of triangles that lie together and face alike.
#include <algorithm>
#include <cmath>

#include "library/geometry/linear.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::partition {

namespace {

// Six coordinates a triangle: the centre in metres, and the unit normal.
constexpr std::size_t kDimensions = 6;
// Nodes of at most so many triangles are divided by facing where normals differ by more than so much along an
// axis; larger ones always in space, where the frustum cuts.
constexpr std::size_t kFacingSize = 1024;
constexpr float kFacingSpread = 0.5f;

struct Place {
  std::array<float, kDimensions> at;
  std::uint32_t triangle;
};

}  // namespace

struct TrianglePartition::ClusterBuilder {
  TrianglePartition& out;
  const TriangleSpan& all;
  std::uint32_t size;

  Box node(std::span<Place> places) {
    const std::size_t self = out.nodes_.size();
    out.nodes_.push_back({{}, 0, out.cells(), 0});
    if (places.size() <= size) {
      out.nodes_[self].bounds = cluster(places);
    } else {
      const std::size_t axis = widest(places);
      const auto middle = axis < 3 ? halve(places, axis) : part_by_facing(places, axis);
      const Box low = node({places.begin(), middle});
      const Box high = node({middle, places.end()});
      out.nodes_[self].bounds = united(low, high);
    }
    out.nodes_[self].next = static_cast<std::uint32_t>(out.nodes_.size());
    out.nodes_[self].last_cell = out.cells();
    return out.nodes_[self].bounds;
  }

  static std::span<Place>::iterator halve(std::span<Place> places, std::size_t axis) {
    const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    // Ids decide between equals: the same clusters whatever the library's algorithm.
    std::nth_element(places.begin(), middle, places.end(), [axis](const Place& a, const Place& b) {
      return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.triangle < b.triangle;
    });
    return middle;
  }

  // At the middle of the normals' range, not at their median: walls, floors and ceilings come apart whole.
  static std::span<Place>::iterator part_by_facing(std::span<Place> places, std::size_t axis) {
    const auto [low, high] = std::ranges::minmax(places, {}, [axis](const Place& p) { return p.at[axis]; });
    const float cut = 0.5f * (low.at[axis] + high.at[axis]);
    const auto rest =
        std::ranges::stable_partition(places, [&](const Place& p) { return p.at[axis] <= cut; });
    return rest.begin() == places.end() || rest.begin() == places.begin() ? halve(places, axis)
                                                                          : rest.begin();
  }

  static std::size_t widest(std::span<const Place> places) {
    std::array<float, kDimensions> low = places.front().at, high = low;
    for (const Place& place : places) {
      for (std::size_t d = 0; d < kDimensions; ++d) {
        low[d] = std::min(low[d], place.at[d]), high[d] = std::max(high[d], place.at[d]);
      }
    }
    std::size_t best = 0;
    for (std::size_t d = 1; d < 3; ++d) best = high[d] - low[d] > high[best] - low[best] ? d : best;
    if (places.size() > kFacingSize) return best;
    const float spread = high[best] - low[best];
    std::size_t facing = 3;
    for (std::size_t d = 4; d < kDimensions; ++d)
      facing = high[d] - low[d] > high[facing] - low[facing] ? d : facing;
    return high[facing] - low[facing] > kFacingSpread || spread == 0 ? facing : best;
  }

  Box cluster(std::span<Place> places) {
    std::ranges::sort(places, {}, &Place::triangle);
    Box bounds = bounds_of(all[places.front().triangle]);
    for (const Place& place : places) {
      bounds = united(bounds, bounds_of(all[place.triangle]));
      out.triangles_.push_back(place.triangle);
    }
    out.cell_start_.push_back(static_cast<std::uint32_t>(out.triangles_.size()));
    out.cell_bounds_.push_back(bounds);
    out.cell_regions_.push_back(bounds);
    return bounds;
  }
};

void TrianglePartition::build_clusters(const TriangleSpan& all, std::span<const std::uint32_t> triangles,
                                       std::uint32_t size) {
  *this = {};
  if (triangles.empty()) return;
  std::vector<Place> places;
  places.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) {
    const auto corners = all[triangle];
    const glm::dvec3 a = geometry::to_double(corners[0]), b = geometry::to_double(corners[1]),
                     c = geometry::to_double(corners[2]);
    const glm::dvec3 centre = (a + b + c) / 3.0, across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    const glm::dvec3 normal = length > 0 ? across / length : glm::dvec3(0);
    places.push_back(
        {{static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z),
          static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)},
         triangle});
  }
  triangles_.reserve(triangles.size());
  ClusterBuilder{*this, all, size}.node(places);
}

}  // namespace sightline::partition
