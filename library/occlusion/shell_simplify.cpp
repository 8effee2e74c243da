#include <algorithm>
#include <cmath>
#include <queue>

#include "library/occlusion/shell.hpp"

namespace sightline::occlusion {

namespace {

// The sum of squared distances to planes, by area: x·Ax + 2 b·x + c.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, c = 0;
  glm::dvec3 b{0};

  void add_plane(const glm::dvec3& n, double at, double weight) {
    xx += weight * n.x * n.x, xy += weight * n.x * n.y, xz += weight * n.x * n.z;
    yy += weight * n.y * n.y, yz += weight * n.y * n.z, zz += weight * n.z * n.z;
    b -= weight * at * n, c += weight * at * at;
  }
  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz, c += o.c, b += o.b;
    return *this;
  }
  [[nodiscard]] double at(const glm::dvec3& p) const {
    const glm::dvec3 a(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                       xz * p.x + yz * p.y + zz * p.z);
    return std::max(0.0, glm::dot(a + 2.0 * b, p) + c);
  }
  // Where it is least, pulled a little towards `near`, which decides where many places are as good.
  [[nodiscard]] glm::dvec3 least(const glm::dvec3& near) const {
    const double pull = 1e-3 * (xx + yy + zz);
    const glm::dmat3 m(xx + pull, xy, xz, xy, yy + pull, yz, xz, yz, zz + pull);
    const double det = glm::determinant(m);
    return det > 1e-30 ? glm::inverse(m) * (pull * near - b) : near;
  }
};

struct Collapse {
  double cost;
  std::uint32_t a, b, stamp, attempt;
  bool operator<(const Collapse& o) const {  // the queue's first is the largest
    return cost != o.cost ? cost > o.cost : a != o.a ? a > o.a : b != o.b ? b > o.b : attempt > o.attempt;
  }
};

class Simplifier {
public:
  Simplifier(const Solid& solid, double step, Shell& shell);
  void collapse_down_to(std::size_t most);
  void widen();
  void pack();

private:
  static constexpr std::uint32_t kAttempts = 5;
  static constexpr std::uint32_t kNobody = ~0u;
  static constexpr double kTurn = 0.1;  // cosine: how far a triangle may turn at once

  [[nodiscard]] bool is_corner(std::uint32_t t, std::uint32_t v) const {
    return shell_.triangles[t][0] == v || shell_.triangles[t][1] == v || shell_.triangles[t][2] == v;
  }
  [[nodiscard]] glm::dvec3 normal(std::uint32_t t) const {
    const Corners3 c = shell_.corners(t);
    return glm::cross(c[1] - c[0], c[2] - c[0]);
  }
  [[nodiscard]] glm::dvec3 outwards(std::uint32_t v) const {
    glm::dvec3 sum(0);
    for (const std::uint32_t t : around_[v]) sum += normal(t);
    return sum;
  }
  [[nodiscard]] glm::dvec3 place_of(const Collapse& c) const;
  [[nodiscard]] double cost_of(const Collapse& c, const glm::dvec3& at) const;
  [[nodiscard]] bool stays_inside(std::uint32_t v, std::uint32_t without, const glm::dvec3& at) const;
  [[nodiscard]] bool keeps_surface(std::uint32_t a, std::uint32_t b) const;
  void push(std::uint32_t a, std::uint32_t b, std::uint32_t attempt);
  void push_around(std::uint32_t v);
  void apply(const Collapse& c, const glm::dvec3& at);
  [[nodiscard]] std::vector<std::uint32_t> beside(std::uint32_t v) const;

  const Solid& solid_;
  double step_;
  Shell& shell_;
  std::vector<Quadric> quadric_;
  std::vector<std::vector<std::uint32_t>> around_;  // triangles of each point
  std::vector<std::uint32_t> stamp_;
  std::vector<std::uint8_t> alive_;
  std::size_t left_;
  std::priority_queue<Collapse> queue_;
};

Simplifier::Simplifier(const Solid& solid, double step, Shell& shell)
    : solid_(solid),
      step_(step),
      shell_(shell),
      quadric_(shell.points.size()),
      around_(shell.points.size()),
      stamp_(shell.points.size(), 0),
      alive_(shell.triangles.size(), 1),
      left_(shell.triangles.size()) {
  for (std::uint32_t t = 0; t < shell_.triangles.size(); ++t) {
    const glm::dvec3 n = normal(t);
    const double length = glm::length(n);
    for (const std::uint32_t v : shell_.triangles[t]) {
      around_[v].push_back(t);
      if (length > 0) quadric_[v].add_plane(n / length, glm::dot(n / length, shell_.points[v]), length);
    }
  }
  for (std::uint32_t v = 0; v < shell_.points.size(); ++v) {
    for (const std::uint32_t w : beside(v)) {
      if (v < w) push(v, w, 0);
    }
  }
}

std::vector<std::uint32_t> Simplifier::beside(std::uint32_t v) const {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t t : around_[v]) {
    for (const std::uint32_t w : shell_.triangles[t]) {
      if (w != v) out.push_back(w);
    }
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// Where the two points become one: where it costs least, or deeper inside.
glm::dvec3 Simplifier::place_of(const Collapse& c) const {
  Quadric q = quadric_[c.a];
  q += quadric_[c.b];
  const glm::dvec3 middle = 0.5 * (shell_.points[c.a] + shell_.points[c.b]);
  const glm::dvec3 at = q.least(middle);
  if (c.attempt == 0) return at;
  const glm::dvec3 out = outwards(c.a) + outwards(c.b);
  const double length = glm::length(out);
  const double depth = step_ * (0.25 * (1 << c.attempt));
  return length > 0 ? at - depth / length * out : middle;
}

double Simplifier::cost_of(const Collapse& c, const glm::dvec3& at) const {
  // Long edges last where all is flat.
  const glm::dvec3 edge = shell_.points[c.a] - shell_.points[c.b];
  return quadric_[c.a].at(at) + quadric_[c.b].at(at) + 1e-9 * glm::dot(edge, edge);
}

void Simplifier::push(std::uint32_t a, std::uint32_t b, std::uint32_t attempt) {
  Collapse c{0, a, b, stamp_[a] + stamp_[b], attempt};
  c.cost = cost_of(c, place_of(c));
  queue_.push(c);
}

void Simplifier::push_around(std::uint32_t v) {
  for (const std::uint32_t w : beside(v)) push(std::min(v, w), std::max(v, w), 0);
}

// Whether v's triangles, but those of `without`, may have their corner there instead.
bool Simplifier::stays_inside(std::uint32_t v, std::uint32_t without, const glm::dvec3& at) const {
  for (const std::uint32_t t : around_[v]) {
    if (is_corner(t, without)) continue;
    Corners3 moved = shell_.corners(t);
    for (std::size_t k = 0; k < 3; ++k) {
      if (shell_.triangles[t][k] == v) moved[k] = at;
    }
    const glm::dvec3 before = normal(t), after = glm::cross(moved[1] - moved[0], moved[2] - moved[0]);
    if (!(glm::dot(before, after) > kTurn * glm::length(before) * glm::length(after))) return false;
    if (solid_.touches(moved)) return false;
  }
  return true;
}

// An edge may go where the two points share the corners of its two triangles alone: else the surface would
// pinch.
bool Simplifier::keeps_surface(std::uint32_t a, std::uint32_t b) const {
  const auto at_edge = std::ranges::count_if(around_[a], [&](std::uint32_t t) { return is_corner(t, b); });
  if (at_edge != 2) return false;
  const std::vector<std::uint32_t> of_a = beside(a), of_b = beside(b);
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(of_a, of_b, std::back_inserter(both));
  return both.size() == 2 && of_a.size() + of_b.size() > 6;
}

void Simplifier::apply(const Collapse& c, const glm::dvec3& at) {
  for (const std::uint32_t t : around_[c.b]) {
    if (is_corner(t, c.a)) {
      alive_[t] = 0, --left_;
      for (const std::uint32_t v : shell_.triangles[t]) {
        if (v != c.b) std::erase(around_[v], t);
      }
    } else {
      std::ranges::replace(shell_.triangles[t], c.b, c.a);
      around_[c.a].push_back(t);
    }
  }
  around_[c.b].clear();
  quadric_[c.a] += quadric_[c.b];
  shell_.points[c.a] = at;
  // What stands in the queue of either, or of edges beside them, is no longer so.
  ++stamp_[c.b];
  ++stamp_[c.a];
  push_around(c.a);
}

void Simplifier::collapse_down_to(std::size_t most) {
  while (left_ > most && !queue_.empty()) {
    const Collapse c = queue_.top();
    queue_.pop();
    if (c.stamp != stamp_[c.a] + stamp_[c.b] || around_[c.a].empty() || around_[c.b].empty()) continue;
    if (!keeps_surface(c.a, c.b)) continue;
    const glm::dvec3 at = place_of(c);
    if (stays_inside(c.a, c.b, at) && stays_inside(c.b, c.a, at))
      apply(c, at);
    else if (c.attempt + 1 < kAttempts)
      push(c.a, c.b, c.attempt + 1);
  }
}

// Moves points outwards while all of their triangles stay inside.
void Simplifier::widen() {
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint32_t v = 0; v < shell_.points.size(); ++v) {
      if (around_[v].empty()) continue;
      const glm::dvec3 out = outwards(v);
      const double length = glm::length(out);
      if (!(length > 0)) continue;
      glm::dvec3 ways[4] = {out / length, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
      for (int a = 0; a < 3; ++a) ways[1 + a][a] = out[a] > 0 ? 1 : -1;
      for (const glm::dvec3& way : ways) {
        double by = 4 * step_;
        for (int tries = 0; tries < 6; ++tries, by /= 2) {
          const glm::dvec3 at = shell_.points[v] + by * way;
          if (stays_inside(v, kNobody, at)) shell_.points[v] = at;
        }
      }
    }
  }
}

void Simplifier::pack() {
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t t = 0; t < alive_.size(); ++t) {
    if (alive_[t]) kept.push_back(shell_.triangles[t]);
  }
  shell_.triangles = std::move(kept);
}

}  // namespace

void simplify(const Solid& solid, double step, std::size_t most_triangles, Shell& shell) {
  Simplifier simplifier(solid, step, shell);
  simplifier.collapse_down_to(most_triangles);
  simplifier.widen();
  simplifier.pack();
}

}  // namespace sightline::occlusion
