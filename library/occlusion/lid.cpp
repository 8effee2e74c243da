#include "library/occlusion/lid.hpp"

#include <algorithm>
#include <numeric>

#include "library/geometry/linear.hpp"

namespace sightline::occlusion {

namespace {

constexpr std::size_t kFewEdges = 256, kMostOfTriangles = 8;  // 1 in 8: more is more hole than surface

using RimEdge = std::pair<std::uint32_t, std::uint32_t>;

// Edges that the part's triangles use more often one way than the other, so often, that way round.
std::vector<RimEdge> rim_edges(const MeshParts& mesh, const MeshPart& part) {
  struct Use {
    std::uint64_t ends;
    int turn;
  };
  std::vector<Use> uses;
  uses.reserve(3 * part.triangles.size());
  for (const std::uint32_t t : part.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::ranges::sort(uses, {}, &Use::ends);
  std::vector<RimEdge> out;
  for (std::size_t i = 0; i < uses.size();) {
    const std::uint64_t ends = uses[i].ends;
    int turns = 0;
    for (; i < uses.size() && uses[i].ends == ends; ++i) turns += uses[i].turn;
    const auto low = static_cast<std::uint32_t>(ends >> 32), high = static_cast<std::uint32_t>(ends);
    for (; turns > 0; --turns) out.emplace_back(low, high);
    for (; turns < 0; ++turns) out.emplace_back(high, low);
  }
  return out;
}

}  // namespace

Lid lid_of(const MeshParts& mesh, const MeshPart& part) {
  const std::vector<RimEdge> edges = rim_edges(mesh, part);
  if (edges.size() > std::max(kFewEdges, part.triangles.size() / kMostOfTriangles)) return {};
  std::vector<std::uint32_t> vertices;
  for (const auto& [a, b] : edges) vertices.insert(vertices.end(), {a, b});
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto place = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
  };
  // Rings: vertices that edges join.
  std::vector<std::uint32_t> ring(vertices.size());
  std::iota(ring.begin(), ring.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (ring[i] != i) i = ring[i] = ring[ring[i]];
    return i;
  };
  for (const auto& [a, b] : edges) {
    const auto [low, high] = std::minmax({root(place(a)), root(place(b))});
    ring[high] = low;
  }
  Lid out;
  std::vector<std::uint32_t> middle(vertices.size(), 0), count(vertices.size(), 0);
  for (const std::uint32_t v : vertices) out.points.push_back(geometry::to_double(mesh.positions[v]));
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t r = root(i);
    if (count[r]++ == 0)
      middle[r] = static_cast<std::uint32_t>(out.points.size()), out.points.emplace_back(0);
    out.points[middle[r]] += out.points[i];
  }
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (root(i) == i) out.points[middle[i]] /= static_cast<double>(count[i]);
  }
  for (const auto& [a, b] : edges) out.triangles.push_back({place(b), place(a), middle[root(place(a))]});
  return out;
}

}  // namespace sightline::occlusion
