// Which edges of others end at triangles' corners, so that drawing knows where the mesh ends beside them.
#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "library/geometry/linear.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

constexpr std::uint32_t kGroup = OccluderTopology::kGroup;

struct CornerEdge {
  std::uint32_t a, b;             // in `positions`
  std::uint32_t triangle, other;  // as RimEdges has them
};

class CornerEdges {
public:
  explicit CornerEdges(const OccluderTopology& mesh) : mesh_(mesh) {
    collect();
    sort_by_vertex();
    first_shared_.resize(mesh.triangles.size() + 1), seen_.resize(mesh.triangles.size());
    asked_.resize(mesh.positions.size());
    for (const auto& shared : mesh.shared) ++first_shared_[shared.triangle + 1];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) first_shared_[t + 1] += first_shared_[t];
  }

  // Of a place: whatever is beyond the edge, pixels that touch it are not the triangle's.
  static constexpr std::uint32_t kEnds = 0x80000000u;

  // The places in edges() of those around triangle t, in order; of too many, some more than kMostAround.
  const std::vector<std::uint32_t>& around(std::uint32_t t) {
    turn_ += 2;
    found_.clear(), farther_.assign(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    ask();
    farther_.clear();
    for (const auto& shared : shared_of(t)) find_ends(shared);
    ask();
    const bool all = found_.size() < kTooMany;
    keep_once(found_);
    for (int corner = 0; all && corner < kFarthest && look_farther(); ++corner) {
    }
    if (all) leave_joined(t);
    std::erase_if(found_, [&](std::uint32_t e) { return edges_[e].triangle == t || edges_[e].other == t; });
    for (std::uint32_t& e : found_) e |= leads_to_others(e) ? kEnds : 0;
    return found_;
  }
  [[nodiscard]] CornerEdge edge(std::uint32_t place) const {
    CornerEdge out = edges_[place & ~kEnds];
    if ((place & kEnds) != 0) out.other = OccluderTopology::kNone;
    return out;
  }

private:
  // Corners of rows that lead from one to the next: pixels hardly reach farther.
  static constexpr int kFarthest = 4;
  // No more than are surely too many: each is found at both its ends, and three may be the triangle's own.
  static constexpr std::size_t kTooMany = 2 * (OccluderTopology::kMostAround + 4);

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

  // Appends to `farther_` the ends of the edges of others that lie on a shared one, but for its own, of which
  // nobody has asked what ends there.
  void find_ends(const OccluderTopology::SharedEdge& shared) {
    const auto& its = mesh_.triangles[shared.triangle];
    for (std::uint32_t i = shared.first; i < shared.end; ++i) {
      const std::uint32_t other = mesh_.others[i] / 4, k = edge_along(other, shared.triangle, shared.edge);
      for (const std::uint32_t end : {k, k + 1}) {
        const std::uint32_t v = mesh_.triangles[other][end % 3];
        if (asked_[v] != turn_ && v != its[shared.edge] && v != its[(shared.edge + 1) % 3])
          farther_.push_back(v);
      }
    }
  }
  void find_ends_at(std::uint32_t place) {
    const std::uint32_t other = edges_[place].other;
    if (other != OccluderTopology::kNone && other >= OccluderTopology::kShared)
      find_ends(mesh_.shared[other - OccluderTopology::kShared]);
  }

  // Asks what ends at the vertices in `farther_`.
  void ask() {
    for (const std::uint32_t v : farther_) {
      if (asked_[v] != turn_) add(v);
      asked_[v] = turn_;
    }
  }

  // Finds what ends at corners of rows (T-junctions) along the edges found so far, unless that is too much. A
  // pixel may reach there across such an edge.
  bool look_farther() {
    farther_.clear();
    for (const std::uint32_t e : found_) find_ends_at(e);
    if (farther_.empty()) return false;
    const std::vector<std::uint32_t> before = found_;
    ask();
    const bool some_left_out = found_.size() >= kTooMany;
    keep_once(found_);
    if (!some_left_out && found_.size() <= OccluderTopology::kMostAround) return true;
    found_ = before;
    for (const std::uint32_t v : farther_) asked_[v] = 0;
    return false;
  }

  // Whether there is more beyond an edge than was asked for.
  [[nodiscard]] bool leads_to_others(std::uint32_t place) {
    farther_.clear();
    find_ends_at(place);
    return !farther_.empty();
  }

  static void keep_once(std::vector<std::uint32_t>& some) {
    std::ranges::sort(some);
    some.erase(std::unique(some.begin(), some.end()), some.end());
  }

  // Leaves the edges of those found that triangle t is joined with, edge by edge. What meets it in a corner
  // alone, another sheet, covers no part of what t and those cover together.
  void leave_joined(std::uint32_t t) {
    mark_near(t);
    for (const std::uint32_t e : found_) {
      mark_near(edges_[e].triangle);
      if (edges_[e].other < OccluderTopology::kShared) mark_near(edges_[e].other);
    }
    joined_.clear();
    join(t);
    for (std::size_t i = 0; i < joined_.size(); ++i) {
      for (const std::uint32_t other : mesh_.neighbours[joined_[i]])
        if (other != OccluderTopology::kNone) join(other);
      for (const auto& shared : shared_of(joined_[i])) {
        for (std::uint32_t o = shared.first; o < shared.end; ++o) join(mesh_.others[o] / 4);
      }
    }
    std::erase_if(found_, [&](std::uint32_t e) { return seen_[edges_[e].triangle] != turn_ + 1; });
  }

  void mark_near(std::uint32_t triangle) { seen_[triangle] = turn_; }
  void join(std::uint32_t triangle) {
    if (seen_[triangle] == turn_) seen_[triangle] = turn_ + 1, joined_.push_back(triangle);
  }

  void add(std::uint32_t vertex) {
    const auto all = std::span(at_vertex_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    const auto some = all.first(std::min(all.size(), kTooMany - found_.size()));
    found_.insert(found_.end(), some.begin(), some.end());
  }

  const OccluderTopology& mesh_;
  std::vector<CornerEdge> edges_;
  std::vector<std::uint32_t> first_, at_vertex_, first_shared_, farther_, found_, joined_;
  std::vector<std::uint64_t> asked_;  // one a vertex: turn_ where it was asked what ends there
  // One a triangle: turn_ where it is near the triangle in question, one more where it is joined with it.
  std::vector<std::uint64_t> seen_;
  std::uint64_t turn_ = 0;
};

// What of a group's triangles are named, each with the bits of those that name it, in order.
struct Named {
  std::uint32_t what, of;
};

void join(std::vector<Named>& named) {
  std::ranges::sort(named, {}, &Named::what);
  std::size_t count = 0;
  for (const Named& n : named) {
    if (count > 0 && named[count - 1].what == n.what)
      named[count - 1].of |= n.of;
    else
      named[count++] = n;
  }
  named.resize(count);
}

void name_triangles(const OccluderTopology& mesh, const CornerEdge& edge, std::uint32_t of,
                    std::vector<Named>& out) {
  out.push_back({edge.triangle, of});
  if (edge.other == OccluderTopology::kNone) return;
  if (edge.other < OccluderTopology::kShared) return out.push_back({edge.other, of});
  const OccluderTopology::SharedEdge& shared = mesh.shared[edge.other - OccluderTopology::kShared];
  for (std::uint32_t o = shared.first; o < shared.end; ++o) out.push_back({mesh.others[o] / 4, of});
}

void store_edge(OccluderTopology& mesh, const CornerEdge& edge, std::uint32_t of, std::size_t place) {
  if (place == 0) mesh.rim.emplace_back();
  OccluderTopology::RimEdges& out = mesh.rim.back();
  out.triangle[place] = static_cast<std::int32_t>(edge.triangle);
  out.other[place] = static_cast<std::int32_t>(edge.other);
  out.a[place] = edge.a, out.b[place] = edge.b;
  out.of[place] = static_cast<std::uint16_t>(of);
  out.of_some |= out.of[place];
}

// Those of the same triangles side by side, so that what is asked for of few lies in few blocks.
void store_rim(OccluderTopology& mesh, const CornerEdges& edges, std::span<const Named> named) {
  std::size_t count = 0;
  for (int i = 0; i < static_cast<int>(kGroup); ++i) {
    for (const Named& n : named) {
      if (std::countr_zero(n.of) == i) store_edge(mesh, edges.edge(n.what), n.of, count++ % kGroup);
    }
  }
}

void store_around(OccluderTopology& mesh, std::span<const Named> named) {
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (i % kGroup == 0) mesh.around.emplace_back();
    mesh.around.back().triangle[i % kGroup] = static_cast<std::int32_t>(named[i].what);
    for (std::uint32_t of = named[i].of; of != 0; of &= of - 1)
      mesh.around.back().beside[static_cast<std::size_t>(std::countr_zero(of))] |=
          static_cast<std::uint16_t>(1u << i % kGroup);
  }
}

// The groups whose facings decide where the mesh ends around group g's triangles.
void store_ring(OccluderTopology& mesh, std::uint32_t g, std::span<const Named> around) {
  OccluderTopology::Group& group = mesh.groups[g];
  group.first_ring = static_cast<std::uint32_t>(mesh.rings.size());
  for (const Named& n : around) mesh.rings.push_back(n.what / kGroup);
  for (std::uint32_t i = group.first_beside; i < group.end_beside; ++i) mesh.rings.push_back(mesh.beside[i]);
  const auto end = std::min<std::size_t>((g + 1) * std::size_t{kGroup}, mesh.triangles.size());
  for (std::size_t t = std::size_t{g} * kGroup; t < end; ++t) {
    for (const std::uint32_t other : mesh.neighbours[t])
      if (other != OccluderTopology::kNone) mesh.rings.push_back(other / kGroup);
  }
  const auto first = mesh.rings.begin() + group.first_ring;
  std::sort(first, mesh.rings.end());
  mesh.rings.erase(std::unique(first, mesh.rings.end()), mesh.rings.end());
  mesh.rings.erase(std::remove(first, mesh.rings.end(), g), mesh.rings.end());
  group.end_ring = static_cast<std::uint32_t>(mesh.rings.size());
}

}  // namespace

void find_corner_edges(OccluderTopology& mesh) {
  CornerEdges edges(mesh);
  std::vector<Named> rim, around;
  for (std::uint32_t g = 0; g < mesh.groups.size(); ++g) {
    OccluderTopology::Group& group = mesh.groups[g];
    rim.clear(), around.clear();
    const auto end = std::min<std::size_t>((g + 1) * std::size_t{kGroup}, mesh.triangles.size());
    for (std::uint32_t t = g * kGroup; t < end; ++t) {
      const std::vector<std::uint32_t>& places = edges.around(t);
      const std::uint32_t bit = 1u << t % kGroup;
      if (places.size() > OccluderTopology::kMostAround) {
        group.alone |= bit;
        continue;
      }
      for (const std::uint32_t place : places) {
        rim.push_back({place, bit});
        name_triangles(mesh, edges.edge(place), bit, around);
      }
    }
    join(rim), join(around);
    group.first_rim = static_cast<std::uint32_t>(mesh.rim.size());
    group.first_around = static_cast<std::uint32_t>(mesh.around.size());
    store_rim(mesh, edges, rim), store_around(mesh, around);
    group.end_rim = static_cast<std::uint32_t>(mesh.rim.size());
    group.end_around = static_cast<std::uint32_t>(mesh.around.size());
    store_ring(mesh, g, around);
  }
}

}  // namespace sightline::occlusion
