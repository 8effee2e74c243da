// Pairs of triangles that are halves of a flat quad: levels are built of such, and one polygon with four
// edges is drawn in less than the time of two with three.
#include <algorithm>
#include <array>
#include <cmath>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

constexpr std::uint32_t kNone = OccluderTopology::kNone;
constexpr double kLeastTurn = 0.01;

// The shared edge's length where the triangles on either side of edge k of a triangle make a convex quad that
// is flat but for rounding; 0 elsewhere. That planes agree is looked into again when they are drawn.
double diagonal(const OccluderTopology& mesh, std::uint32_t triangle, std::uint32_t k) {
  const std::uint32_t other = mesh.neighbours[triangle][k];
  if (other == kNone || mesh.one_sided[triangle] != mesh.one_sided[other]) return 0;
  const auto& t = mesh.triangles[triangle];
  const auto& sides = mesh.neighbours[other];
  const auto edge = static_cast<std::size_t>(std::ranges::find(sides, triangle) - sides.begin());
  const auto& u = mesh.triangles[other];
  if (u[edge] != t[(k + 1) % 3] || u[(edge + 1) % 3] != t[k]) return 0;  // wound the other way
  const auto corner = [&](std::uint32_t vertex) { return to_double(mesh.positions[vertex]); };
  const glm::dvec3 a = corner(t[k]), b = corner(t[(k + 1) % 3]), c = corner(t[(k + 2) % 3]),
                   d = corner(u[(edge + 2) % 3]);
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double reach = std::max({glm::length(b - a), glm::length(c - a), glm::length(d - a)});
  const bool flat = std::fabs(glm::dot(normal, d - a)) <= 1e-6 * reach * glm::length(normal);
  // By more than rounding makes of it on an image: a corner that turns the other way there is cut off.
  const auto turns = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(from, to), normal) >
           kLeastTurn * glm::length(from) * glm::length(to) * glm::length(normal);
  };
  const bool convex = turns(a - c, d - a) && turns(d - a, b - d) && turns(b - d, c - b);
  return flat && convex ? glm::length(b - a) : 0;
}

void turn(OccluderTopology& mesh, std::uint32_t triangle, std::size_t edge) {
  auto &t = mesh.triangles[triangle], &sides = mesh.neighbours[triangle];
  std::rotate(t.begin(), t.begin() + (edge + 1) % 3, t.end());
  std::rotate(sides.begin(), sides.begin() + (edge + 1) % 3, sides.end());
}

}  // namespace

void pair_up(OccluderTopology& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::uint32_t> partner(count, kNone), order;
  order.reserve(count);
  std::uint32_t single = kNone;  // waits for another
  for (std::uint32_t i = 0; i < count; ++i) {
    if (partner[i] != kNone) continue;
    std::uint32_t best = 0;
    double longest = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t other = mesh.neighbours[i][k];
      if (other == kNone || other < i || partner[other] != kNone) continue;
      const double length = diagonal(mesh, i, k);
      if (length > longest) longest = length, best = k;
    }
    if (longest > 0) {
      const std::uint32_t other = mesh.neighbours[i][best];
      partner[i] = other, partner[other] = i;
      const auto& sides = mesh.neighbours[other];
      turn(mesh, other, static_cast<std::size_t>(std::ranges::find(sides, i) - sides.begin()));
      turn(mesh, i, best);
      order.insert(order.end(), {i, other});
    } else if (single == kNone) {
      single = i;
    } else {
      order.insert(order.end(), {single, i});
      single = kNone;
    }
  }
  if (single != kNone) order.push_back(single);

  std::vector<std::uint32_t> place(count);
  for (std::uint32_t i = 0; i < count; ++i) place[order[i]] = i;
  auto triangles = mesh.triangles;
  auto neighbours = mesh.neighbours;
  auto one_sided = mesh.one_sided;
  mesh.first_half.assign(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    triangles[i] = mesh.triangles[order[i]];
    one_sided[i] = mesh.one_sided[order[i]];
    neighbours[i] = mesh.neighbours[order[i]];
    for (std::uint32_t& other : neighbours[i]) other = other == kNone ? kNone : place[other];
    mesh.first_half[i] = i + 1 < count && partner[order[i]] == order[i + 1] && i % 2 == 0;
  }
  mesh.triangles = std::move(triangles);
  mesh.neighbours = std::move(neighbours);
  mesh.one_sided = std::move(one_sided);
}

}  // namespace sightline::occlusion
