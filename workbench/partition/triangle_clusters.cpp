// Clusters of triangles that lie together and face alike: meshoptimizer's meshlets, under a tree of bounds.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <meshoptimizer.h>

#include "library/geometry/linear.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::partition {

namespace {

// Blocks of at most so many triangles are divided by facing; larger ones in space, where the frustum cuts.
constexpr std::size_t kBlockSize = 1024;
// How much facing counts beside nearness while a meshlet grows.
constexpr float kConeWeight = 0.5f;

struct Place {
  Vec3 centre;
  std::uint32_t triangle, facing;
};

// In how many steps a side of the cube that normals point through is divided: as finely as a block's
// triangles fill such clusters. None: clusters so large gain nothing by facing.
std::uint32_t steps_for(std::uint32_t size) noexcept {
  return size <= 32 ? 3 : size <= 128 ? 2 : size <= 512 ? 1 : 0;
}

/// Where the normal leaves a cube: walls, floors and ceilings in the middle of its sides.
std::uint32_t facing_of(const std::array<Vec3, 3>& corners, std::uint32_t steps) noexcept {
  const glm::dvec3 a = geometry::to_double(corners[0]);
  const glm::dvec3 normal =
      glm::cross(geometry::to_double(corners[1]) - a, geometry::to_double(corners[2]) - a);
  const glm::dvec3 reach = glm::abs(normal);
  const int axis = reach.x >= reach.y && reach.x >= reach.z ? 0 : reach.y >= reach.z ? 1 : 2;
  if (steps == 0 || !(reach[axis] > 0)) return 0;
  const auto step = [&](double along) {
    const double share = 0.5 * along / reach[axis] + 0.5;
    return std::min(steps - 1, static_cast<std::uint32_t>(share * steps));
  };
  const std::uint32_t side = 2 * static_cast<std::uint32_t>(axis) + (normal[axis] > 0 ? 0 : 1);
  return (side * steps + step(normal[(axis + 1) % 3])) * steps + step(normal[(axis + 2) % 3]);
}

using Corners = std::array<std::uint32_t, 3>;

/// The same whichever corner comes first.
Corners turned(std::uint32_t a, std::uint32_t b, std::uint32_t c) noexcept {
  return std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}});
}

/// Orders triangles meshlet by meshlet; the lengths of the meshlets.
class MeshletMaker {
public:
  MeshletMaker(const TriangleSpan& all, std::uint32_t size)
      : all_(all), size_(size / 4 * 4), vertices_(std::min<std::size_t>(3 * size_, 255)) {}  // its limits

  std::span<const std::uint32_t> make(std::span<Place> places) {
    gather(places);
    const std::size_t most = meshopt_buildMeshletsBound(corners_.size(), vertices_, size_);
    meshlets_.resize(most), meshlet_vertices_.resize(most * vertices_),
        meshlet_corners_.resize(most * size_ * 3);
    meshlets_.resize(meshopt_buildMeshlets(
        meshlets_.data(), meshlet_vertices_.data(), meshlet_corners_.data(), indices_.data(), indices_.size(),
        &corners_[0].x, corners_.size(), sizeof(Vec3), vertices_, size_, kConeWeight));
    // meshoptimizer tells corners, not triangles: find them again, each of several alike once.
    taken_.assign(places.size(), false);
    counts_.clear(), ordered_.clear();
    for (const meshopt_Meshlet& meshlet : meshlets_) {
      const unsigned int* vertex = &meshlet_vertices_[meshlet.vertex_offset];
      for (std::size_t t = 0; t < meshlet.triangle_count; ++t) {
        const unsigned char* corner = &meshlet_corners_[meshlet.triangle_offset + 3 * t];
        ordered_.push_back(places[take(turned(vertex[corner[0]], vertex[corner[1]], vertex[corner[2]]))]);
      }
      counts_.push_back(meshlet.triangle_count);
    }
    std::ranges::copy(ordered_, places.begin());
    return counts_;
  }

private:
  // Corners at the same place are one.
  void gather(std::span<const Place> places) {
    corners_.clear();
    for (const Place& place : places) {
      const auto triangle = all_[place.triangle];
      corners_.insert(corners_.end(), triangle.begin(), triangle.end());
    }
    indices_.resize(corners_.size());
    meshopt_generateVertexRemap(indices_.data(), nullptr, corners_.size(), corners_.data(), corners_.size(),
                                sizeof(Vec3));
    meshopt_remapVertexBuffer(corners_.data(), corners_.data(), corners_.size(), sizeof(Vec3),
                              indices_.data());
    known_.clear();
    for (std::uint32_t i = 0; i < places.size(); ++i)
      known_.push_back({turned(indices_[3 * i], indices_[3 * i + 1], indices_[3 * i + 2]), i});
    std::ranges::sort(known_);
  }

  std::uint32_t take(const Corners& corners) {
    auto found = std::ranges::lower_bound(known_, corners, {}, &Known::first);
    while (taken_[found->second]) ++found;
    taken_[found->second] = true;
    return found->second;
  }

  using Known = std::pair<Corners, std::uint32_t>;

  const TriangleSpan& all_;
  std::size_t size_, vertices_;
  std::vector<Vec3> corners_;
  std::vector<std::uint32_t> indices_, counts_;
  std::vector<Known> known_;
  std::vector<bool> taken_;
  std::vector<Place> ordered_;
  std::vector<meshopt_Meshlet> meshlets_;
  std::vector<unsigned int> meshlet_vertices_;
  std::vector<unsigned char> meshlet_corners_;
};

}  // namespace

struct TrianglePartition::ClusterBuilder {
  TrianglePartition& out;
  const TriangleSpan& all;
  std::uint32_t size, steps;
  MeshletMaker meshlets{all, size};

  Box node(std::span<Place> places) {
    const std::size_t block = steps == 0 ? size : std::max<std::size_t>(size, kBlockSize);
    if (places.size() <= block) return divide(places);
    return parent([&] {
      const std::size_t middle = halve(places);
      const Box low = node(places.first(middle)), high = node(places.subspan(middle));
      return united(low, high);
    });
  }

  // A block: clusters of one facing stand side by side, so that their draws merge.
  Box divide(std::span<Place> places) {
    std::ranges::sort(places, {}, [](const Place& place) { return std::pair(place.facing, place.triangle); });
    std::vector<std::uint32_t> counts;
    for (std::size_t at = 0; at < places.size();) {
      const auto end = std::ranges::upper_bound(places.subspan(at), places[at].facing, {}, &Place::facing);
      const auto alike = places.subspan(at, static_cast<std::size_t>(end - places.begin()) - at);
      if (alike.size() <= size) {
        counts.push_back(static_cast<std::uint32_t>(alike.size()));
      } else {
        const auto made = meshlets.make(alike);
        counts.insert(counts.end(), made.begin(), made.end());
      }
      at += alike.size();
    }
    return clusters(places, counts);
  }

  Box clusters(std::span<Place> places, std::span<const std::uint32_t> counts) {
    return parent([&] {
      if (counts.size() == 1) return cluster(places);
      const std::size_t half = counts.size() / 2;
      const std::size_t middle = std::accumulate(counts.begin(), counts.begin() + half, std::size_t{0});
      const Box low = clusters(places.first(middle), counts.first(half));
      const Box high = clusters(places.subspan(middle), counts.subspan(half));
      return united(low, high);
    });
  }

  template <class Children>
  Box parent(const Children& children) {
    const std::size_t self = out.nodes_.size();
    out.nodes_.push_back({{}, 0, out.cells(), 0});
    const Box bounds = children();
    out.nodes_[self] = {bounds, static_cast<std::uint32_t>(out.nodes_.size()), out.nodes_[self].first_cell,
                        out.cells()};
    return bounds;
  }

  // At the median along the axis on which they are spread widest.
  static std::size_t halve(std::span<Place> places) {
    float Vec3::*widest = &Vec3::x;
    float most = -1;
    for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const auto at = [axis](const Place& place) { return place.centre.*axis; };
      const auto [low, high] = std::ranges::minmax(places, {}, at);
      if (const float spread = at(high) - at(low); spread > most) most = spread, widest = axis;
    }
    // Numbers decide between equals: the same clusters whatever the standard library's algorithm.
    const std::size_t middle = places.size() / 2;
    std::ranges::nth_element(places, places.begin() + static_cast<std::ptrdiff_t>(middle), {},
                             [widest](const Place& p) { return std::pair(p.centre.*widest, p.triangle); });
    return middle;
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
  const std::uint32_t steps = steps_for(size);
  std::vector<Place> places;
  places.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) {
    const auto corners = all[triangle];
    const glm::dvec3 sum =
        geometry::to_double(corners[0]) + geometry::to_double(corners[1]) + geometry::to_double(corners[2]);
    places.push_back({geometry::to_vec3(sum / 3.0), triangle, facing_of(corners, steps)});
  }
  triangles_.reserve(triangles.size());
  ClusterBuilder{*this, all, size, steps}.node(places);
}

}  // namespace sightline::partition
