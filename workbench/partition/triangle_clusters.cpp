// Clusters of triangles that lie together and face alike: meshoptimizer's meshlets, under a tree of bounds.
#include <algorithm>

#include <meshoptimizer.h>

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
// Places alike in facing become meshlets where they fill at most so many; all hang from one node.
constexpr std::size_t kClustersOfNode = 16;
// A meshlet of triangles that share no corner holds so many at most.
constexpr std::size_t kMeshletSize = 255 / 3;

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
    const Box bounds = places.size() <= size ? cluster(places) : divide(places);
    out.nodes_[self] = {bounds, static_cast<std::uint32_t>(out.nodes_.size()), out.nodes_[self].first_cell,
                        out.cells()};
    return bounds;
  }

  Box divide(std::span<Place> places) {
    const std::size_t axis = widest(places);
    if (axis < 3 && places.size() <= kClustersOfNode * size && size <= kMeshletSize) return meshlets(places);
    const auto middle = axis < 3 ? halve(places, axis) : part_by_facing(places, axis);
    const Box low = node({places.begin(), middle});
    const Box high = node({middle, places.end()});
    return united(low, high);
  }

  // Meshlets grow by the nearest triangle. Each corner is given once for each triangle, so that its number
  // tells the triangle. Filled to three quarters, as halves of halves are on average: full ones keep more.
  Box meshlets(std::span<Place> places) {
    std::ranges::sort(places, {}, &Place::triangle);  // the same whatever the library's algorithm
    const std::vector<Place> given(places.begin(), places.end());
    std::vector<Vec3> corners;
    std::vector<unsigned int> indices;
    for (const Place& place : given) {
      for (const Vec3& corner : all[place.triangle]) {
        indices.push_back(static_cast<unsigned int>(corners.size()));
        corners.push_back(corner);
      }
    }
    const std::size_t most = (3 * size / 4 + 2) / 4 * 4;  // the nearest multiple of four
    std::vector<meshopt_Meshlet> made(meshopt_buildMeshletsBound(indices.size(), 3 * most, most));
    std::vector<unsigned int> vertices(made.size() * 3 * most);
    std::vector<unsigned char> triangles(made.size() * 3 * most);
    made.resize(meshopt_buildMeshlets(made.data(), vertices.data(), triangles.data(), indices.data(),
                                      indices.size(), &corners[0].x, corners.size(), sizeof(Vec3), 3 * most,
                                      most, 0));
    Box bounds = bounds_of(all[given.front().triangle]);
    for (const meshopt_Meshlet& meshlet : made) {
      const auto taken = places.first(meshlet.triangle_count);
      for (std::size_t t = 0; t < taken.size(); ++t) {
        const unsigned char corner = triangles[meshlet.triangle_offset + 3 * t];
        taken[t] = given[vertices[meshlet.vertex_offset + corner] / 3];
      }
      bounds = united(bounds, node(taken));
      places = places.subspan(taken.size());
    }
    return bounds;
  }

  static std::span<Place>::iterator halve(std::span<Place> places, std::size_t axis) {
    const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    // Ids decide between equals: the same clusters whatever the library's algorithm.
    std::ranges::nth_element(
        places, middle, {}, [axis](const Place& place) { return std::pair(place.at[axis], place.triangle); });
    return middle;
  }

  // At the middle of the normals' range, not at their median: walls, floors and ceilings come apart whole.
  static std::span<Place>::iterator part_by_facing(std::span<Place> places, std::size_t axis) {
    const auto [low, high] = std::ranges::minmax(places, {}, [axis](const Place& p) { return p.at[axis]; });
    const float cut = 0.5f * (low.at[axis] + high.at[axis]);
    const auto rest = std::ranges::partition(places, [&](const Place& p) { return p.at[axis] <= cut; });
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
    const auto widest_of = [&](std::size_t first) {
      std::size_t best = first;
      for (std::size_t d = first + 1; d < first + 3; ++d)
        best = high[d] - low[d] > high[best] - low[best] ? d : best;
      return best;
    };
    const std::size_t facing = widest_of(3);
    const bool by_facing = places.size() <= kFacingSize && high[facing] - low[facing] > kFacingSpread;
    return by_facing ? facing : widest_of(0);
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
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    const Vec3 centre = geometry::to_vec3((a + b + c) / 3.0);
    const Vec3 normal = geometry::to_vec3(length > 0 ? across / length : glm::dvec3(0));
    places.push_back({{centre.x, centre.y, centre.z, normal.x, normal.y, normal.z}, triangle});
  }
  triangles_.reserve(triangles.size());
  ClusterBuilder{*this, all, size}.node(places);
}

}  // namespace sightline::partition
