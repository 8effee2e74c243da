// Triangles that together are a flat convex polygon: levels are built of such, and one polygon with some
// edges is drawn in less than the time of its triangles.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include "library/geometry/linear.hpp"
#include "library/geometry/radix_sort.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

constexpr std::uint32_t kNone = OccluderTopology::kNone;
constexpr std::size_t kMostParts = OccluderTopology::kMostParts, kMostSides = OccluderTopology::kMostSides;
// Of the polygon's size. How uneven it is then tells how far behind its plane it is drawn.
constexpr double kMostUneven = 1e-6;
// Sines. Where a corner turns by less, rounding may turn it the other way on an image; and so far it may turn
// the wrong way, as it does where it lies on an edge but for rounding.
constexpr double kLeastTurn = 0.01, kMostBack = 1e-5;

// A polygon's edge, from a triangle's corner `edge` on.
struct Side {
  std::uint32_t triangle, edge;
  bool operator==(const Side&) const = default;
};

// A polygon, counter-clockwise, and its triangles, on the first one's plane.
struct FlatPolygon {
  std::array<Side, kMostSides> side;
  std::array<std::uint32_t, kMostParts> part;
  std::size_t sides = 0, parts = 0;
  double apart = 0;  // so far its corners lie from that plane at most

  [[nodiscard]] std::span<const std::uint32_t> triangles() const { return std::span(part).first(parts); }
  void add(const Side& s) { side[sides++] = s; }
  void add(std::span<const std::uint32_t> triangles) {
    for (const std::uint32_t t : triangles) part[parts++] = t;
  }
  // Adds the other's sides that follow one of them, up to that one.
  void add_around(const FlatPolygon& other, const Side& but) {
    std::size_t at = 0;
    while (other.side[at] != but) ++at;
    for (std::size_t i = 1; i < other.sides; ++i) add(other.side[(at + i) % other.sides]);
  }
};

class FlatPolygons {
public:
  explicit FlatPolygons(const OccluderTopology& mesh)
      : mesh_(mesh), number_(mesh.triangles.size()), polygons_(mesh.triangles.size()) {
    std::iota(number_.begin(), number_.end(), 0u);
    for (std::uint32_t t = 0; t < number_.size(); ++t) {
      for (const std::uint32_t k : {0u, 1u, 2u}) polygons_[t].add(Side{t, k});
      polygons_[t].add(std::span(&t, 1));
    }
  }

  // Across long edges first, which spares drawing the most.
  void join() {
    std::vector<Side> edges;
    std::vector<std::uint64_t> long_first, room;
    for (std::uint32_t t = 0; t < number_.size(); ++t) {
      for (const std::uint32_t k : {0u, 1u, 2u}) {
        const std::uint32_t other = mesh_.neighbours[t][k];
        if (other == kNone || other < t || mesh_.one_sided[t] != mesh_.one_sided[other]) continue;
        if (!(glm::dot(normal(t), normal(other)) > 0)) continue;
        const auto length = static_cast<float>(glm::length(along({t, k})));
        long_first.push_back(std::uint64_t{~std::bit_cast<std::uint32_t>(length)} << 32 | edges.size());
        edges.push_back({t, k});
      }
    }
    sort_by_high_bits(long_first, room, 32);
    for (const std::uint64_t key : long_first) join_across(edges[key & 0xffffffffu]);
  }

  // The polygon that a triangle is of.
  [[nodiscard]] const FlatPolygon& of(std::uint32_t triangle) const { return polygons_[number_[triangle]]; }
  [[nodiscard]] bool together(std::uint32_t triangle, std::uint32_t other) const {
    return other != kNone && number_[triangle] == number_[other];
  }
  [[nodiscard]] bool goes_straight_on(const FlatPolygon& polygon) const {
    bool out = false;
    for_corners(polygon, [&](double sine, double) { out = out || sine <= kLeastTurn; });
    return out;
  }

private:
  [[nodiscard]] glm::dvec3 corner(const Side& side) const {
    return to_double(mesh_.positions[mesh_.triangles[side.triangle][side.edge % 3]]);
  }
  [[nodiscard]] glm::dvec3 along(const Side& side) const {
    return corner({side.triangle, side.edge + 1}) - corner(side);
  }
  [[nodiscard]] glm::dvec3 normal(std::uint32_t triangle) const {
    return glm::cross(along({triangle, 0}), along({triangle, 1}));
  }

  // visit(sine, cosine) of the angle by which the polygon turns at each corner.
  template <class Visit>
  void for_corners(const FlatPolygon& polygon, const Visit& visit) const {
    const glm::dvec3 unit = glm::normalize(normal(polygon.part[0]));
    for (std::size_t i = 0; i < polygon.sides; ++i) {
      const glm::dvec3 in = along(polygon.side[i]), on = along(polygon.side[(i + 1) % polygon.sides]);
      const double lengths = glm::length(in) * glm::length(on);
      visit(glm::dot(glm::cross(in, on), unit) / lengths, glm::dot(in, on) / lengths);
    }
  }
  [[nodiscard]] bool is_convex(const FlatPolygon& polygon) const {
    bool out = true;
    for_corners(polygon, [&](double sine, double cosine) {
      out = out && sine >= -kMostBack && (sine > kMostBack || cosine > 0);
    });
    return out;
  }
  // Finds how far its corners lie from its plane.
  [[nodiscard]] bool is_flat(FlatPolygon& polygon) const {
    const glm::dvec3 from = corner({polygon.part[0], 0}), unit = glm::normalize(normal(polygon.part[0]));
    double reach = 0;
    for (std::size_t i = 0; i < polygon.sides; ++i) {
      const glm::dvec3 to = corner(polygon.side[i]) - from;
      reach = std::max(reach, glm::length(to));
      polygon.apart = std::max(polygon.apart, std::fabs(glm::dot(unit, to)));
    }
    return polygon.apart <= kMostUneven * reach;
  }

  void join_across(const Side& side) {
    const std::uint32_t other = mesh_.neighbours[side.triangle][side.edge], number = number_[side.triangle];
    if (together(side.triangle, other)) return;
    const FlatPolygon &a = polygons_[number], &b = polygons_[number_[other]];
    if (a.parts + b.parts > kMostParts || a.sides + b.sides - 2 > kMostSides) return;
    const auto& across = mesh_.neighbours[other];
    const auto edge = std::ranges::find(across, side.triangle) - across.begin();
    FlatPolygon joined;
    joined.add_around(a, side);
    joined.add_around(b, {other, static_cast<std::uint32_t>(edge)});
    // The largest triangle's plane is the surest.
    const bool a_first = glm::length(normal(a.part[0])) >= glm::length(normal(b.part[0]));
    joined.add((a_first ? a : b).triangles());
    joined.add((a_first ? b : a).triangles());
    if (!is_flat(joined) || !is_convex(joined)) return;
    polygons_[number] = joined;
    for (const std::uint32_t t : joined.triangles()) number_[t] = number;
  }

  const OccluderTopology& mesh_;
  std::vector<std::uint32_t> number_;  // of a triangle's polygon
  std::vector<FlatPolygon> polygons_;  // by number
};

// Triangles in a new order, in which a polygon's lie together within a group. A polygon that does not fit
// waits for the next group; where too many wait, the first comes apart.
class NewOrder {
public:
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint8_t> follows;  // is of the polygon of the one before

  void add(std::span<const std::uint32_t> polygon) {
    waiting_.push_back(polygon);
    place_what_fits();
    constexpr std::size_t kMostWaiting = 16;
    while (waiting_.size() > kMostWaiting) place_first_apart();
  }
  void end() {
    while (!waiting_.empty()) place_first_apart();
  }

private:
  void place(std::uint32_t triangle, bool follows_one) {
    triangles.push_back(triangle), follows.push_back(follows_one);
  }
  void place_what_fits() {
    for (auto at = waiting_.begin(); at != waiting_.end();) {
      if (at->size() > OccluderTopology::kGroup - triangles.size() % OccluderTopology::kGroup) {
        ++at;
        continue;
      }
      for (const std::uint32_t& t : *at) place(t, &t != at->data());
      waiting_.erase(at);
      at = waiting_.begin();
    }
  }
  void place_first_apart() {
    for (const std::uint32_t t : waiting_.front()) place(t, false);
    waiting_.erase(waiting_.begin());
    place_what_fits();
  }

  std::vector<std::span<const std::uint32_t>> waiting_;
};

NewOrder order_of(const FlatPolygons& polygons, std::uint32_t count) {
  NewOrder out;
  std::vector<std::uint8_t> added(count, 0);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (added[t]) continue;
    const std::span<const std::uint32_t> polygon = polygons.of(t).triangles();
    for (const std::uint32_t part : polygon) added[part] = 1;
    out.add(polygon);
  }
  out.end();
  return out;
}

}  // namespace

void join_flat_polygons(OccluderTopology& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  FlatPolygons polygons(mesh);
  polygons.join();
  const NewOrder order = order_of(polygons, count);
  std::vector<std::uint32_t> place(count);
  for (std::uint32_t i = 0; i < count; ++i) place[order.triangles[i]] = i;
  std::vector<std::array<std::uint32_t, 3>> triangles(count), neighbours(count);
  std::vector<std::uint8_t> one_sided(count);
  mesh.parts.assign(count, {});
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t from = order.triangles[i];
    triangles[i] = mesh.triangles[from];
    one_sided[i] = mesh.one_sided[from];
    OccluderTopology::Part& part = mesh.parts[i];
    part.follows = order.follows[i];
    const bool leads = i + 1 < count && order.follows[i + 1] && !part.follows;
    if (leads) {
      part.straight = polygons.goes_straight_on(polygons.of(from));
      part.apart = static_cast<float>(polygons.of(from).apart * (1 + 1e-6));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = mesh.neighbours[from][k];
      neighbours[i][k] = other == kNone ? kNone : place[other];
      const bool inner = (leads || part.follows) && polygons.together(from, other);
      part.inner |= static_cast<std::uint8_t>(inner << k);
    }
  }
  mesh.triangles = std::move(triangles);
  mesh.neighbours = std::move(neighbours);
  mesh.one_sided = std::move(one_sided);
}

}  // namespace sightline::occlusion
