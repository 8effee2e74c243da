#include "library/occlusion/solid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "library/geometry/linear.hpp"
#include "library/occlusion/lid.hpp"
#include "library/occlusion/separation.hpp"

namespace sightline::occlusion {

using geometry::to_double;

namespace {

constexpr std::size_t kLeaf = 4;
constexpr double kMargin = 5e-5;
constexpr double kFloat = 6.0e-8;     // half a unit in the last place of a float, of its value
constexpr double kMostMargin = 0.01;  // beyond it the mesh's own vertices say too little
constexpr double kBehind = 1e-9;      // a plane, at least
constexpr double kThinnest = 1e-4;    // of the longest side
constexpr double kOnAnEdge = 1e-13;   // twice the area of a triangle whose corners cannot be told from a line

// Twice the area of the triangle of two points and the line, seen along it.
double area_about(const glm::dvec3& line, const glm::dvec3& p, const glm::dvec3& q, int b, int c) {
  return (p[b] - line[b]) * (q[c] - line[c]) - (p[c] - line[c]) * (q[b] - line[b]);
}

double squared_distance(const glm::dvec3& p, const Bounds3& box) {
  const glm::dvec3 d = glm::max(glm::max(box.low - p, p - box.high), glm::dvec3(0));
  return glm::dot(d, d);
}

double squared_distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length = glm::dot(along, along);
  const double t = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0.0;
  const glm::dvec3 to = a + t * along - p;
  return glm::dot(to, to);
}

double squared_distance(const glm::dvec3& p, const Corners3& t) {
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double area = glm::dot(normal, normal);
  bool above = area > 0;
  double best = 1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
    if (glm::dot(glm::cross(b - a, p - a), normal) < 0) above = false;
    best = std::min(best, squared_distance_to_segment(p, a, b));
  }
  const double height = glm::dot(p - t[0], normal);
  return above ? height * height / area : best;
}

}  // namespace

Solid::Solid(const MeshParts& mesh, const MeshPart& part) : rule_(part.inside) {
  low_ = part.low, extent_ = part.high - part.low;
  const double longest = std::max({extent_.x, extent_.y, extent_.z});
  margin_ = kMargin;
  for (int a = 0; a < 3; ++a) {
    if (!(extent_[a] > kThinnest * longest)) thin_ = true;
    margin_ =
        std::max(margin_, kMargin + 2 * kFloat * std::max(std::fabs(part.low[a]), std::fabs(part.high[a])) /
                                        extent_[a]);
  }
  thin_ = thin_ || !(margin_ <= kMostMargin);
  std::vector<Corners3> corners;
  if (!thin_ && rule_ == Inside::never) add_lid(mesh, part, corners);
  if (thin_) return;
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t t : part.triangles) {
    Corners3& its = corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      vertices.push_back(mesh.triangles[t][k]);
      its[k] = to_solid(to_double(mesh.positions[vertices.back()]));
    }
  }
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t v : vertices) points_.push_back(to_solid(to_double(mesh.positions[v])));
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0u);
  build(order, 0, order.size(), corners);
  for (const std::uint32_t i : order) triangles_.push_back(corners[i]);
}

void Solid::add_lid(const MeshParts& mesh, const MeshPart& part, std::vector<Corners3>& corners) {
  const Lid lid = lid_of(mesh, part);
  thin_ = lid.triangles.empty();
  for (const glm::dvec3& p : lid.points) lid_.push_back(to_solid(p));
  for (const auto& [a, b, c] : lid.triangles) corners.push_back({lid_[a], lid_[b], lid_[c]});
  const bool some_front =
      std::ranges::any_of(part.triangles, [&](std::uint32_t t) { return mesh.one_sided[t] != 0; });
  rule_ = some_front ? Inside::turned_out : Inside::turned;
}

void Solid::build(std::vector<std::uint32_t>& order, std::size_t first, std::size_t end,
                  const std::vector<Corners3>& corners) {
  const std::size_t node = nodes_.size();
  Bounds3 box, middles;
  for (std::size_t i = first; i < end; ++i) {
    const Corners3& its = corners[order[i]];
    for (const glm::dvec3& p : its) box.add(p);
    middles.add(its[0] + its[1] + its[2]);
  }
  nodes_.push_back({box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first)});
  if (end - first <= kLeaf) return;
  const glm::dvec3 size = middles.high - middles.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto key = [&](std::uint32_t i) {
    return corners[i][0][axis] + corners[i][1][axis] + corners[i][2][axis];
  };
  const std::size_t middle = first + (end - first) / 2;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  build(order, first, middle, corners);
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size()), nodes_[node].count = 0;
  build(order, middle, end, corners);
}

template <class Passes, class At>
bool Solid::any(Passes passes, At at) const {
  std::array<std::uint32_t, 64> waiting;  // halves at every level: no deeper than 32
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t n = waiting[--count];
    const Node& node = nodes_[n];
    if (!passes(node.box)) continue;
    if (node.count == 0) {
      waiting[count++] = node.first, waiting[count++] = n + 1;
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (at(triangles_[node.first + i])) return true;
    }
  }
  return false;
}

bool Solid::touches(const Corners3& triangle) const {
  if (thin_) return true;
  const TriangleSides sides(triangle);
  return any([&](const Bounds3& box) { return !sides.beyond(box, margin_); },
             [&](const Corners3& other) { return !are_apart(triangle, other, margin_); });
}

bool Solid::touches(const Bounds3& box) const {
  if (thin_) return true;
  const Bounds3 grown{box.low - margin_, box.high + margin_};
  return any(
      [&](const Bounds3& node) {
        return glm::all(glm::lessThanEqual(node.low, grown.high)) &&
               glm::all(glm::lessThanEqual(grown.low, node.high));
      },
      [&](const Corners3& triangle) { return !TriangleSides(triangle).beyond(grown, 0); });
}

bool Solid::inside_by(int turns, std::size_t crossed) const noexcept {
  switch (rule_) {
    case Inside::never:
      return false;
    case Inside::turned:
      return turns != 0;
    case Inside::turned_out:
      return turns > 0;
    case Inside::odd_crossings:
      return crossed % 2 == 1;
  }
  return false;
}

bool Solid::crossings(const glm::dvec3& point, int axis, std::vector<Crossing>& out) const {
  out.clear();
  if (thin_) return false;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const bool unsure = any(
      [&](const Bounds3& box) {
        return box.low[b] <= point[b] && point[b] <= box.high[b] && box.low[c] <= point[c] &&
               point[c] <= box.high[c];
      },
      [&](const Corners3& t) {
        const double o[3] = {area_about(point, t[1], t[2], b, c), area_about(point, t[2], t[0], b, c),
                             area_about(point, t[0], t[1], b, c)};
        const auto [least, most] = std::minmax({o[0], o[1], o[2]});
        if (least < -kOnAnEdge && most > kOnAnEdge) return false;       // beside it
        if (!(least > kOnAnEdge) && !(most < -kOnAnEdge)) return true;  // too close to an edge
        const double at = (o[0] * t[0][axis] + o[1] * t[1][axis] + o[2] * t[2][axis]) / (o[0] + o[1] + o[2]);
        out.push_back({at, least > 0 ? 1 : -1});
        return false;
      });
  std::ranges::sort(out, {}, &Crossing::at);
  return !unsure;
}

bool Solid::holds(const glm::dvec3& point) const {
  std::vector<Crossing> met;
  for (int axis = 0; axis < 3; ++axis) {
    if (!crossings(point, axis, met)) continue;
    int turns = 0;
    std::size_t crossed = 0;
    for (const Crossing& c : met) {
      if (c.at > point[axis]) turns += c.turn, ++crossed;
    }
    return inside_by(turns, crossed);
  }
  return false;
}

bool Solid::holds(const Corners3& t) const {
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double ahead = kBehind * glm::length(normal);
  if (std::ranges::any_of(lid_, [&](const glm::dvec3& p) { return glm::dot(normal, p - t[0]) > -ahead; }))
    return false;
  if (touches(t)) return false;
  // Another point of it where lines through the first pass an edge.
  return holds((t[0] + t[1] + t[2]) / 3.0) || holds(0.22 * t[0] + 0.33 * t[1] + 0.45 * t[2]);
}

bool Solid::holds(const Bounds3& box) const {
  const glm::dvec3 size = box.high - box.low;
  return !touches(box) &&
         (holds(box.low + 0.5 * size) || holds(box.low + glm::dvec3(0.21, 0.34, 0.55) * size));
}

double Solid::distance_to_lid(const glm::dvec3& point) const {
  double best = 1e300;
  for (const glm::dvec3& p : lid_) best = std::min(best, glm::dot(p - point, p - point));
  return std::sqrt(best);
}

double Solid::distance(const glm::dvec3& point, double most) const {
  double best = most * most;
  any([&](const Bounds3& box) { return squared_distance(point, box) < best; },
      [&](const Corners3& t) {
        best = std::min(best, squared_distance(point, t));
        return false;
      });
  return std::sqrt(best);
}

}  // namespace sightline::occlusion
