// Which edges of others end at a triangle's corners, so that drawing knows where the mesh ends beside it.
#include <algorithm>
#include <limits>
#include <span>

#include "library/geometry/linear.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

using CornerEdge = OccluderTopology::CornerEdge;

class CornerEdges {
public:
  explicit CornerEdges(const OccluderTopology& mesh) : mesh_(mesh) {
    collect();
    sort_by_vertex();
    first_shared_.resize(mesh.triangles.size() + 1);
    for (const auto& shared : mesh.shared) ++first_shared_[shared.triangle + 1];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) first_shared_[t + 1] += first_shared_[t];
  }

  // The places in edges() of those around triangle t, in order.
  const std::vector<std::uint32_t>& around(std::uint32_t t) {
    found_.clear();
    for (const std::uint32_t vertex : mesh_.triangles[t]) add(vertex);
    for (const auto& shared : shared_of(t)) {
      for (std::uint32_t i = shared.first; i < shared.end; ++i) {
        const std::uint32_t other = mesh_.others[i] / 4, k = edge_along(other, t, shared.edge);
        add(mesh_.triangles[other][k]), add(mesh_.triangles[other][(k + 1) % 3]);
      }
    }
    std::ranges::sort(found_);
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    std::erase_if(found_, [&](std::uint32_t e) { return edges_[e].triangle == t || edges_[e].other == t; });
    return found_;
  }
  [[nodiscard]] const CornerEdge& edge(std::uint32_t place) const { return edges_[place]; }

private:
  // Each edge once; one without a neighbour once a triangle.
  void collect() {
    std::size_t shared = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t other = mesh_.neighbours[t][k];
        if (shared < mesh_.shared.size() && mesh_.shared[shared].triangle == t &&
            mesh_.shared[shared].edge == k)
          other = OccluderTopology::kShared + static_cast<std::uint32_t>(shared++);
        if (other < t) continue;
        edges_.push_back({mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3], t, other});
      }
    }
  }

  void sort_by_vertex() {
    first_.assign(mesh_.positions.size() + 2, 0);
    for (const CornerEdge& e : edges_) ++first_[e.a + 2], ++first_[e.b + 2];
    for (std::size_t v = 2; v < first_.size(); ++v) first_[v] += first_[v - 1];
    at_vertex_.resize(2 * edges_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      at_vertex_[first_[edges_[e].a + 1]++] = e, at_vertex_[first_[edges_[e].b + 1]++] = e;
  }

  [[nodiscard]] std::span<const OccluderTopology::SharedEdge> shared_of(std::uint32_t t) const {
    return std::span(mesh_.shared).subspan(first_shared_[t], first_shared_[t + 1] - first_shared_[t]);
  }

  // Which edge of `other` lies on edge k of t.
  [[nodiscard]] std::uint32_t edge_along(std::uint32_t other, std::uint32_t t, std::uint32_t k) const {
    const auto corner = [&](std::uint32_t of, std::uint32_t i) {
      return to_double(mesh_.positions[mesh_.triangles[of][i % 3]]);
    };
    const glm::dvec3 a = corner(t, k), along = glm::normalize(corner(t, k + 1) - a);
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const double off = std::max(glm::length(glm::cross(along, corner(other, i) - a)),
                                  glm::length(glm::cross(along, corner(other, i + 1) - a)));
      if (off < least) least = off, best = i;
    }
    return best;
  }

  void add(std::uint32_t vertex) {
    found_.insert(found_.end(), at_vertex_.begin() + first_[vertex], at_vertex_.begin() + first_[vertex + 1]);
  }

  const OccluderTopology& mesh_;
  std::vector<CornerEdge> edges_;
  std::vector<std::uint32_t> first_, at_vertex_, first_shared_, found_;
};

}  // namespace

void find_corner_edges(OccluderTopology& mesh) {
  CornerEdges edges(mesh);
  mesh.first_around.assign(1, 0);
  mesh.alone.assign(mesh.triangles.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::vector<std::uint32_t>& places = edges.around(t);
    mesh.alone[t] = places.size() > OccluderTopology::kMostAround;
    if (!mesh.alone[t]) {
      for (const std::uint32_t place : places) mesh.around.push_back(edges.edge(place));
    }
    mesh.first_around.push_back(static_cast<std::uint32_t>(mesh.around.size()));
  }
}

}  // namespace sightline::occlusion
