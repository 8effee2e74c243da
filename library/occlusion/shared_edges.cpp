// Edges at which others go on though no single neighbour does: where three and more triangles meet, and where
// the edges of several lie on one (T-junctions).
#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include "library/geometry/linear.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

constexpr std::uint32_t kNoNeighbour = OccluderTopology::kNone;
// Of the coordinates: differences and products of floats are all but exact in double precision.
constexpr double kOnLine = 1e-12;
// So many edges along one line are looked at to either side of one. What is missed is drawn inset.
constexpr std::size_t kLooked = 96;

// A triangle's edge, and where it lies along its line.
struct LineEdge {
  std::uint32_t triangle, edge;
  std::uint64_t line;
  double low, high;
  bool along;  // runs the way in which the line is measured
  bool open;   // has no neighbour
};

double largest(const glm::dvec3& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

// The number of the line through two points, and its direction: the same for all edges on one line, but where
// rounding carries them to different numbers.
std::uint64_t number_of(const glm::dvec3& a, const glm::dvec3& b, double reach, glm::dvec3& direction) {
  direction = glm::normalize(b - a);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::fabs(direction[axis]) < 1e-3) continue;
    if (direction[axis] < 0) direction = -direction;
    break;
  }
  const glm::dvec3 foot = a - direction * glm::dot(a, direction);
  std::uint64_t hash = 0;
  const auto add = [&](double value) {
    hash = (hash ^ static_cast<std::uint64_t>(std::llround(value))) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 31;
  };
  for (int axis = 0; axis < 3; ++axis) add(direction[axis] * 3001.7), add(foot[axis] / reach * 7013.3);
  return hash;
}

// Those without a neighbour; if asked for, the others, too, at which one without may end.
std::vector<LineEdge> edges_by_line(const OccluderTopology& mesh, double reach, bool all) {
  std::vector<LineEdge> out;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const bool open = mesh.neighbours[t][k] == kNoNeighbour;
      if (!open && !all) continue;
      const glm::dvec3 a = to_double(mesh.positions[mesh.triangles[t][k]]),
                       b = to_double(mesh.positions[mesh.triangles[t][(k + 1) % 3]]);
      glm::dvec3 direction;
      const std::uint64_t line = number_of(a, b, reach, direction);
      const double from = glm::dot(a, direction), to = glm::dot(b, direction);
      out.push_back({t, k, line, std::min(from, to), std::max(from, to), from < to, open});
    }
  }
  std::ranges::sort(out, [](const LineEdge& a, const LineEdge& b) {
    if (a.line != b.line) return a.line < b.line;
    if (a.low != b.low) return a.low < b.low;
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.edge < b.edge;
  });
  return out;
}

// Another edge on the same line, and the part of the first that it covers, from 0 to 1.
struct Cover {
  double begin, end;
  std::uint32_t other;  // as OccluderTopology::others has it, not the last
};

class Covers {
public:
  Covers(const OccluderTopology& mesh, bool junctions) : mesh_(mesh), junctions_(junctions) {}

  // Those of edge i of all open ones, which are sorted by line and place.
  const std::vector<Cover>& of(std::span<const LineEdge> edges, std::size_t i) {
    found_.clear();
    const LineEdge& edge = edges[i];
    const std::size_t first = i > kLooked ? i - kLooked : 0, end = std::min(edges.size(), i + kLooked);
    for (std::size_t j = first; j < end; ++j) {
      const LineEdge& other = edges[j];
      if (other.line != edge.line || other.triangle == edge.triangle) continue;
      if (!junctions_ && !same_ends(edge, other)) continue;
      if (other.low < edge.high && other.high > edge.low) add(edge, other);
    }
    return found_;
  }

private:
  bool same_ends(const LineEdge& a, const LineEdge& b) const {
    const auto end = [&](const LineEdge& of, std::uint32_t k) {
      return mesh_.triangles[of.triangle][(of.edge + k) % 3];
    };
    const auto is = [&](std::uint32_t k) { return end(a, 0) == end(b, k) && end(a, 1) == end(b, 1 - k); };
    return is(0) || is(1);
  }

  glm::dvec3 point(const LineEdge& of, std::uint32_t end) const {
    return to_double(mesh_.positions[mesh_.triangles[of.triangle][(of.edge + end) % 3]]);
  }

  void add(const LineEdge& edge, const LineEdge& other) {
    const glm::dvec3 a = point(edge, 0), b = point(edge, 1), along = b - a, from = point(other, 0),
                     to = point(other, 1);
    const double length = glm::dot(along, along);
    // Of these four alone: what stands far away makes nothing here less sharp.
    const double reach = std::max({largest(a), largest(b), largest(from), largest(to)});
    const auto place = [&](const glm::dvec3& p) { return glm::dot(p - a, along) / length; };
    const auto on_line = [&](const glm::dvec3& p) {
      return glm::length(glm::cross(along, p - a)) <= kOnLine * reach * std::sqrt(length);
    };
    if (!on_line(from) || !on_line(to)) return;
    const double s = place(from), t = place(to);
    const Cover cover{std::max(0.0, std::min(s, t)), std::min(1.0, std::max(s, t)),
                      other.triangle * 4 + (edge.along == other.along ? 2u : 0u)};
    if (cover.begin < cover.end) found_.push_back(cover);
  }

  const OccluderTopology& mesh_;
  bool junctions_;
  std::vector<Cover> found_;
};

// Appends the others of every piece; false where a piece has none.
bool append_pieces(const std::vector<Cover>& covers, std::vector<double>& ends,
                   std::vector<std::uint32_t>& others) {
  ends.assign({0, 1});
  for (const Cover& c : covers) ends.insert(ends.end(), {c.begin, c.end});
  std::ranges::sort(ends);
  // Covers that meet in a corner end there to the bit: where one lies along the edge is told by it alone.
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (ends[i + 1] <= ends[i]) continue;
    const std::size_t before = others.size();
    for (const Cover& c : covers) {
      if (c.begin <= ends[i] && c.end >= ends[i + 1]) others.push_back(c.other);
    }
    if (others.size() == before) return false;
    others.back() |= 1;
  }
  return true;
}

}  // namespace

void find_shared_edges(OccluderTopology& mesh, bool close_junctions) {
  double reach = 1e-30;
  for (const Vec3& p : mesh.positions) reach = std::max(reach, largest(to_double(p)));
  const std::vector<LineEdge> edges = edges_by_line(mesh, reach, close_junctions);
  Covers covers(mesh, close_junctions);
  std::vector<double> ends;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!edges[i].open) continue;
    const auto first = static_cast<std::uint32_t>(mesh.others.size());
    if (!append_pieces(covers.of(edges, i), ends, mesh.others)) {
      mesh.others.resize(first);
      continue;
    }
    mesh.shared.push_back(
        {edges[i].triangle, edges[i].edge, first, static_cast<std::uint32_t>(mesh.others.size())});
  }
  std::ranges::sort(mesh.shared, [](const auto& a, const auto& b) {
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.edge < b.edge;
  });
}

}  // namespace sightline::occlusion
