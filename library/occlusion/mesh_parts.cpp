#include "library/occlusion/mesh_parts.hpp"

#include <algorithm>
#include <numeric>

#include "library/geometry/linear.hpp"

namespace sightline::occlusion {

using geometry::to_double;

namespace {

// The edge of triangle half / 3 from corner half % 3 on, by its ends, the lower one above.
struct Edge {
  std::uint64_t ends;
  std::uint32_t half;
  bool turned;  // it runs from the higher end to the lower
};

// Where each position's like stands among those that are kept, which are appended to `kept`.
std::vector<std::uint32_t> join(std::span<const Vec3> positions, std::vector<Vec3>& kept) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](const Vec3& a, const Vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  std::ranges::stable_sort(order, before, [&](std::uint32_t i) { return positions[i]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3& p = positions[order[i]];
    if (i == 0 || before(kept.back(), p)) kept.push_back(p);
    place[order[i]] = static_cast<std::uint32_t>(kept.size() - 1);
  }
  return place;
}

std::vector<Edge> edges_of(const MeshParts& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), 3 * i + k, a > b});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.half < b.half;
  });
  return edges;
}

// Triangles that hang together, as a forest: each knows one before it.
struct Forest {
  std::vector<std::uint32_t> before;
  explicit Forest(std::size_t count) : before(count) { std::iota(before.begin(), before.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (before[i] != i) i = before[i] = before[before[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    before[std::max(a, b)] = std::min(a, b);
  }
};

// What all edges of a part agree on.
struct Seams {
  bool balanced = true, even = true;
};

template <class Visit>
void for_each_run(const std::vector<Edge>& edges, Visit visit) {
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t end = first + 1;
    while (end < edges.size() && edges[end].ends == edges[first].ends) ++end;
    visit(std::span(edges).subspan(first, end - first));
    first = end;
  }
}

void find_parts(MeshParts& mesh) {
  constexpr std::uint32_t kNone = MeshParts::kNone;
  const std::vector<Edge> edges = edges_of(mesh);
  Forest forest(mesh.triangles.size());
  mesh.neighbours.assign(mesh.triangles.size(), {kNone, kNone, kNone});
  for_each_run(edges, [&](std::span<const Edge> run) {
    for (const Edge& e : run.subspan(1)) forest.unite(run[0].half / 3, e.half / 3);
    if (run.size() != 2 || run[0].turned == run[1].turned) return;
    mesh.neighbours[run[0].half / 3][run[0].half % 3] = run[1].half / 3;
    mesh.neighbours[run[1].half / 3][run[1].half % 3] = run[0].half / 3;
  });
  std::vector<Seams> seams(mesh.triangles.size());
  for_each_run(edges, [&](std::span<const Edge> run) {
    Seams& its = seams[forest.root(run[0].half / 3)];
    const auto turned = static_cast<std::size_t>(std::ranges::count(run, true, &Edge::turned));
    its.balanced = its.balanced && 2 * turned == run.size();
    its.even = its.even && run.size() % 2 == 0;
  });
  std::vector<std::uint32_t> part(mesh.triangles.size(), kNone);
  std::vector<std::uint8_t> some_front;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t root = forest.root(i);
    if (root == i) {
      part[i] = static_cast<std::uint32_t>(mesh.parts.size());
      mesh.parts.emplace_back(), some_front.push_back(0);
    }
    MeshPart& its = mesh.parts[part[root]];
    its.triangles.push_back(i);
    some_front[part[root]] |= mesh.one_sided[i];
    for (const std::uint32_t v : mesh.triangles[i]) {
      its.low = glm::min(its.low, to_double(mesh.positions[v]));
      its.high = glm::max(its.high, to_double(mesh.positions[v]));
    }
  }
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    const Seams& its = seams[mesh.parts[p].triangles[0]];
    if (its.balanced) mesh.parts[p].inside = some_front[p] ? Inside::turned_out : Inside::turned;
    if (!its.balanced && its.even && !some_front[p]) mesh.parts[p].inside = Inside::odd_crossings;
  }
  std::ranges::stable_sort(mesh.parts,
                           [](const MeshPart& a, const MeshPart& b) { return a.size() > b.size(); });
}

}  // namespace

MeshParts parts_of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                   std::span<const Sides> sides) {
  MeshParts mesh;
  const std::vector<std::uint32_t> place = join(positions, mesh.positions);
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{place[indices[i]], place[indices[i + 1]], place[indices[i + 2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    mesh.triangles.push_back(t);
    mesh.one_sided.push_back(!sides.empty() && sides[sides.size() == 1 ? 0 : i / 3] == Sides::front);
  }
  find_parts(mesh);
  return mesh;
}

}  // namespace sightline::occlusion
