#include "workbench/camera/navigation_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <queue>

#include "workbench/scene/level_space.hpp"

namespace sightline::camera {
namespace {

constexpr std::size_t kNeighbours = 24;   ///< joined to each place
constexpr float kClearance = 0.15f;       ///< metres
constexpr std::size_t kMaxLeaves = 6000;  ///< that are places; each place is held against every other
constexpr std::uint32_t kNowhere = 0xffffffffu;

float distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

Vec3 middle(const Box& b) {
  return {0.5f * (b.min.x + b.max.x), 0.5f * (b.min.y + b.max.y), 0.5f * (b.min.z + b.max.z)};
}

}  // namespace

std::vector<Vec3> thinned(const std::vector<Vec3>& places, std::size_t most) {
  const std::size_t step = 1 + places.size() / most;
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < places.size(); i += step) kept.push_back(places[i]);
  return kept;
}

std::vector<Vec3> eyes_of(const Scene& scene) {
  std::vector<Vec3> eyes;
  for (const Viewpoint& viewpoint : scene.viewpoints) eyes.push_back(viewpoint.eye);
  return eyes;
}

bool is_clear(const LevelPvs& level, const Vec3& a, const Vec3& b) {
  if (scene::solid_length(level, a, b) > 0) return false;
  const std::array<Vec3, 4> shifts{Vec3{kClearance, 0, kClearance},
                                   {-kClearance, 0, -kClearance},
                                   {kClearance, 0, -kClearance},
                                   {0, kClearance, 0}};
  return std::none_of(shifts.begin(), shifts.end(), [&](const Vec3& s) {
    return scene::solid_length(level, {a.x + s.x, a.y + s.y, a.z + s.z}, {b.x + s.x, b.y + s.y, b.z + s.z}) >
           0.3;
  });
}

NavigationGraph::NavigationGraph(const Scene& scene) : level_(*scene.level) {
  std::vector<Vec3> middles;
  for (const std::uint32_t leaf : scene::open_leaves(level_))
    middles.push_back(middle(level_.leaves[leaf].bounds));
  for (const std::vector<Vec3>& some : {thinned(eyes_of(scene), kMaxStops),
                                        thinned(scene.waypoints, kMaxStops), thinned(middles, kMaxLeaves)}) {
    std::ranges::copy_if(some, std::back_inserter(places_),
                         [&](const Vec3& place) { return scene::is_open(level_, place); });
  }
  edges_.resize(places_.size());
  for (std::uint32_t p = 0; p < places_.size(); ++p) {
    for (const Edge& edge : neighbours_of(places_[p], p)) {
      edges_[p].push_back(edge);
      edges_[edge.to].push_back({p, edge.length});
    }
  }
}

std::vector<NavigationGraph::Edge> NavigationGraph::neighbours_of(const Vec3& point,
                                                                  std::uint32_t self) const {
  std::vector<Edge> near;
  near.reserve(places_.size());
  for (std::uint32_t p = 0; p < places_.size(); ++p) {
    if (p != self) near.push_back({p, distance(point, places_[p])});
  }
  const std::size_t count = std::min(kNeighbours, near.size());
  std::partial_sort(
      near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
      [](const Edge& a, const Edge& b) { return a.length != b.length ? a.length < b.length : a.to < b.to; });
  near.resize(count);
  std::erase_if(near, [&](const Edge& edge) { return !is_clear(level_, point, places_[edge.to]); });
  return near;
}

std::vector<Vec3> NavigationGraph::way(const Vec3& a, const Vec3& b) const {
  if (is_clear(level_, a, b)) return {a, b};
  const std::vector<Edge> first = neighbours_of(a, kNowhere), last = neighbours_of(b, kNowhere);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::vector<float> cost(places_.size(), kFar), home(places_.size(), kFar);
  std::vector<std::uint32_t> from(places_.size(), kNowhere);
  for (const Edge& edge : last) home[edge.to] = edge.length;
  using Item = std::pair<float, std::uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  for (const Edge& edge : first) {
    cost[edge.to] = edge.length;
    open.push({edge.length, edge.to});
  }
  float best = kFar;
  std::uint32_t arrived = kNowhere;
  while (!open.empty()) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (so_far > cost[at]) continue;
    if (so_far >= best) break;
    if (so_far + home[at] < best) best = so_far + home[at], arrived = at;
    for (const Edge& edge : edges_[at]) {
      const float total = so_far + edge.length;
      if (total >= cost[edge.to]) continue;
      cost[edge.to] = total, from[edge.to] = at;
      open.push({total, edge.to});
    }
  }
  if (arrived == kNowhere) return {};
  std::vector<Vec3> corners{b};
  for (std::uint32_t at = arrived; at != kNowhere; at = from[at]) corners.push_back(places_[at]);
  corners.push_back(a);
  std::reverse(corners.begin(), corners.end());
  return pulled_tight(corners);
}

// From each corner straight to the farthest one that can be reached.
std::vector<Vec3> NavigationGraph::pulled_tight(const std::vector<Vec3>& corners) const {
  std::vector<Vec3> tight{corners.front()};
  for (std::size_t at = 0; at + 1 < corners.size();) {
    std::size_t next = corners.size() - 1;
    while (next > at + 1 && !is_clear(level_, corners[at], corners[next])) --next;
    tight.push_back(corners[next]);
    at = next;
  }
  return tight;
}

}  // namespace sightline::camera
