// Clusters of triangles that lie together and face alike: meshoptimizer's meshlets, under a tree of bounds.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <meshoptimizer.h>

#include "library/geometry/linear.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::partition {

namespace {

// Where no triangle continues a meshlet, it goes on with the nearest, whichever way that faces: so triangles
// are shared out first by the side of a cube that they face. Only for small clusters: large ones would reach
// too far.
constexpr std::uint32_t kSides = 6;
constexpr std::uint32_t kSidesSize = 32;
// Larger clusters are made of several meshlets, small ones, so that their bounds do not reach far into each
// other.
constexpr std::uint32_t kMostTriangles = 128, kPartTriangles = 32;
// How much facing counts beside nearness while a meshlet grows.
constexpr float kConeWeight = 0.5f;
// Nodes of at most so many triangles keep meshlets that face one side together, so that their draws merge.
constexpr std::size_t kFacingSize = 1024;

struct Meshlet {
  std::uint32_t first, count;  ///< of the list of triangles
  std::uint32_t side;
  Box bounds;
};

struct Meshlets {
  std::vector<std::uint32_t> triangles;
  std::vector<Meshlet> all;
};

std::uint32_t side_of(const std::array<Vec3, 3>& corners) {
  const glm::dvec3 a = geometry::to_double(corners[0]);
  const glm::dvec3 normal =
      glm::cross(geometry::to_double(corners[1]) - a, geometry::to_double(corners[2]) - a);
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * static_cast<std::uint32_t>(axis) + (normal[axis] > 0 ? 0 : 1);
}

using Corners = std::array<std::uint32_t, 3>;

/// The same whichever corner comes first.
Corners turned(std::uint32_t a, std::uint32_t b, std::uint32_t c) noexcept {
  return std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}});
}

/// Finds triangles again by their corners; each of several alike once.
class Numbers {
public:
  Numbers(std::span<const std::uint32_t> indices, std::span<const std::uint32_t> triangles) {
    entries_.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
      entries_.push_back({turned(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]), triangles[i]});
    std::ranges::sort(entries_, [](const Entry& a, const Entry& b) {
      return a.corners != b.corners ? a.corners < b.corners : a.triangle < b.triangle;
    });
    next_.resize(entries_.size());
    std::iota(next_.begin(), next_.end(), 0u);
  }
  [[nodiscard]] std::uint32_t take(const Corners& corners) {
    const auto found = std::ranges::lower_bound(entries_, corners, {}, &Entry::corners);
    return entries_[next_[static_cast<std::size_t>(found - entries_.begin())]++].triangle;
  }

private:
  struct Entry {
    Corners corners;
    std::uint32_t triangle;
  };
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> next_;  // of the first entry of some corners: the one to take
};

/// Positions of which each stands once, and where each corner's is among them.
struct Places {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> of;

  explicit Places(std::span<const Vec3> all) : of(all.size()) {
    const std::size_t count =
        meshopt_generateVertexRemap(of.data(), nullptr, all.size(), all.data(), all.size(), sizeof(Vec3));
    positions.resize(count);
    meshopt_remapVertexBuffer(positions.data(), all.data(), all.size(), sizeof(Vec3), of.data());
  }
};

void add_meshlets(const TriangleSpan& all, std::span<const std::uint32_t> triangles, const Places& places,
                  std::uint32_t side, std::size_t size, Meshlets& out) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * triangles.size());
  for (const std::uint32_t triangle : triangles) {
    for (std::size_t c = 0; c < 3; ++c) indices.push_back(places.of[all.indices[3 * triangle + c]]);
  }
  const std::size_t reach = std::min<std::size_t>(3 * size, 255);  // vertices; meshoptimizer's limit
  const std::size_t most = meshopt_buildMeshletsBound(indices.size(), reach, size);
  std::vector<meshopt_Meshlet> meshlets(most);
  std::vector<unsigned int> vertices(most * reach);
  std::vector<unsigned char> corners(most * size * 3);
  meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), indices.data(),
                                        indices.size(), &places.positions[0].x, places.positions.size(),
                                        sizeof(Vec3), reach, size, kConeWeight));
  Numbers numbers(indices, triangles);
  for (const meshopt_Meshlet& meshlet : meshlets) {
    const unsigned int* vertex = &vertices[meshlet.vertex_offset];
    Meshlet& made = out.all.emplace_back(
        Meshlet{static_cast<std::uint32_t>(out.triangles.size()), meshlet.triangle_count, side, {}});
    for (std::size_t t = 0; t < meshlet.triangle_count; ++t) {
      const unsigned char* corner = &corners[meshlet.triangle_offset + 3 * t];
      const std::uint32_t triangle =
          numbers.take(turned(vertex[corner[0]], vertex[corner[1]], vertex[corner[2]]));
      const Box box = bounds_of(all[triangle]);
      made.bounds = t == 0 ? box : united(made.bounds, box);
      out.triangles.push_back(triangle);
    }
  }
}

Meshlets make_meshlets(const TriangleSpan& all, std::span<const std::uint32_t> triangles,
                       std::uint32_t size) {
  const Places places(all.positions);
  std::array<std::vector<std::uint32_t>, kSides> by_side;
  for (const std::uint32_t triangle : triangles)
    by_side[size <= kSidesSize ? side_of(all[triangle]) : 0].push_back(triangle);
  // meshoptimizer wants a multiple of four.
  const std::size_t fours = (size > kMostTriangles ? kPartTriangles : size) / 4 * 4;
  Meshlets out;
  out.triangles.reserve(triangles.size());
  for (std::uint32_t side = 0; side < kSides; ++side) {
    if (!by_side[side].empty()) add_meshlets(all, by_side[side], places, side, fours, out);
  }
  return out;
}

float middle_of(const Meshlet& meshlet, float Vec3::*axis) noexcept {
  return 0.5f * meshlet.bounds.min.*axis + 0.5f * meshlet.bounds.max.*axis;
}

}  // namespace

struct TrianglePartition::ClusterBuilder {
  TrianglePartition& out;
  Meshlets& meshlets;
  std::size_t size;

  Box node(std::span<Meshlet> some, bool sorted) {
    const std::size_t self = out.nodes_.size();
    out.nodes_.push_back({{}, 0, out.cells(), 0});
    std::size_t held = 0;
    for (const Meshlet& meshlet : some) held += meshlet.count;
    if (some.size() == 1 || (size > kMostTriangles && held <= size)) {
      out.nodes_[self].bounds = cluster(some);
    } else {
      if (!sorted && size <= kSidesSize && held <= kFacingSize) {
        std::ranges::stable_sort(some, {}, &Meshlet::side);
        sorted = true;
      }
      if (!sorted) halve(some);
      const Box low = node(some.first(some.size() / 2), sorted);
      const Box high = node(some.subspan(some.size() / 2), sorted);
      out.nodes_[self].bounds = united(low, high);
    }
    out.nodes_[self].next = static_cast<std::uint32_t>(out.nodes_.size());
    out.nodes_[self].last_cell = out.cells();
    return out.nodes_[self].bounds;
  }

  // At the median along the axis on which they are spread widest.
  static void halve(std::span<Meshlet> some) {
    float Vec3::*widest = &Vec3::x;
    float most = -1;
    for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const auto at = [axis](const Meshlet& meshlet) { return middle_of(meshlet, axis); };
      const auto [low, high] = std::ranges::minmax(some, {}, at);
      if (const float spread = at(high) - at(low); spread > most) most = spread, widest = axis;
    }
    // Numbers decide between equals: the same clusters whatever the standard library's algorithm.
    std::ranges::nth_element(some, some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2), {},
                             [widest](const Meshlet& m) { return std::pair(middle_of(m, widest), m.first); });
  }

  Box cluster(std::span<const Meshlet> some) {
    Box bounds = some.front().bounds;
    const std::size_t first = out.triangles_.size();
    for (const Meshlet& meshlet : some) {
      bounds = united(bounds, meshlet.bounds);
      const auto triangles = std::span(meshlets.triangles).subspan(meshlet.first, meshlet.count);
      out.triangles_.insert(out.triangles_.end(), triangles.begin(), triangles.end());
    }
    std::ranges::sort(std::span(out.triangles_).subspan(first));
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
  Meshlets meshlets = make_meshlets(all, triangles, size);
  triangles_.reserve(triangles.size());
  ClusterBuilder{*this, meshlets, size}.node(meshlets.all, false);
}

}  // namespace sightline::partition
