#include "library/occlusion/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sightline::occlusion {

namespace {

using Loop = std::vector<std::uint32_t>;

double turn_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How far `p` lies to the left of the line from a to b.
double left_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  const double length = glm::length(b - a);
  return length > 0 ? turn_of(a, b, p) / length : 0;
}

// The edges strung together; nothing where a point begins two of them, or none.
std::vector<Loop> loops_of(const Outline2& outline) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> next(outline.points.size(), kNone);
  for (const auto& [from, to] : outline.edges) {
    if (next[from] != kNone) return {};
    next[from] = to;
  }
  std::vector<Loop> loops;
  for (std::uint32_t start = 0; start < next.size(); ++start) {
    if (next[start] == kNone) continue;
    Loop& loop = loops.emplace_back();
    for (std::uint32_t at = start; next[at] != kNone; at = std::exchange(next[at], kNone)) loop.push_back(at);
    if (loop.size() < 3) return {};
  }
  return loops;
}

// Whether b lies on the edge from a to c: it may stand out of the region by `tolerance`, but into it, and off
// the plane, no farther than rounding may put it. An edge without it would lead beyond the region there.
bool lies_on(const Outline2& outline, std::uint32_t a, std::uint32_t b, std::uint32_t c, double tolerance,
             double rounding) {
  const glm::dvec2 &from = outline.points[a], &at = outline.points[b], &to = outline.points[c];
  const double along = glm::dot(at - from, to - from) / glm::dot(to - from, to - from),
               in = left_of(from, to, at), height = glm::mix(outline.heights[a], outline.heights[c], along);
  return along > 0 && along < 1 && -tolerance <= in && in <= rounding &&
         std::fabs(outline.heights[b] - height) <= rounding;
}

// Leaves out corners on straight edges.
void straighten(const Outline2& outline, double tolerance, double rounding, Loop& loop) {
  const Loop all = loop;
  const auto next = [&](std::size_t i) { return (i + 1) % all.size(); };
  std::vector<std::size_t> kept(all.size());
  std::iota(kept.begin(), kept.end(), 0);
  // An edge in the place of others has to pass all corners of theirs. Until none can be left out: one that
  // stands out keeps those beside it until it is gone itself.
  for (std::size_t i = 0, looked = 0; looked < kept.size() && kept.size() > 3;) {
    i %= kept.size();
    const std::size_t from = kept[(i + kept.size() - 1) % kept.size()], to = kept[(i + 1) % kept.size()];
    std::size_t between = next(from);
    while (between != to && lies_on(outline, all[from], all[between], all[to], tolerance, rounding))
      between = next(between);
    if (between == to)
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i)), looked = 0;
    else
      ++i, ++looked;
  }
  loop.clear();
  for (const std::size_t i : kept) loop.push_back(all[i]);
}

double area_of(const Outline2& outline, const Loop& loop) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    area += turn_of(outline.points[loop[0]], outline.points[loop[i]], outline.points[loop[i + 1]]);
  return area;
}

// Whether the open segments cross, or touch at their insides.
bool cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const double ab_c = turn_of(a, b, c), ab_d = turn_of(a, b, d), cd_a = turn_of(c, d, a),
               cd_b = turn_of(c, d, b);
  return ((ab_c > 0) != (ab_d > 0)) && ((cd_a > 0) != (cd_b > 0));
}

// Opens the hole at the pair of corners that see one another and lie closest, and puts it into the loop.
bool bridge(const Outline2& outline, const std::vector<Loop>& others, Loop hole, Loop& loop) {
  const auto& p = outline.points;
  const auto crossed_by = [&](const Loop& l, std::uint32_t a, std::uint32_t b) {
    for (std::size_t i = 0; i < l.size(); ++i) {
      const std::uint32_t c = l[i], d = l[(i + 1) % l.size()];
      if (a != c && a != d && b != c && b != d && cross(p[a], p[b], p[c], p[d])) return true;
    }
    return false;
  };
  struct Way {
    double length;
    std::size_t from, to;
  };
  std::vector<Way> ways;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    for (std::size_t j = 0; j < hole.size(); ++j)
      ways.push_back({glm::length(p[loop[i]] - p[hole[j]]), i, j});
  }
  std::ranges::stable_sort(ways, {}, &Way::length);
  for (const Way& way : ways) {
    const std::uint32_t a = loop[way.from], b = hole[way.to];
    if (crossed_by(loop, a, b) || crossed_by(hole, a, b)) continue;
    if (std::ranges::any_of(others, [&](const Loop& l) { return crossed_by(l, a, b); })) continue;
    std::ranges::rotate(hole, hole.begin() + static_cast<std::ptrdiff_t>(way.to));
    hole.push_back(b), hole.push_back(a);
    loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(way.from) + 1, hole.begin(), hole.end());
    return true;
  }
  return false;
}

// Cuts ears off, the roundest one first, until nothing is left; false where there is none to cut.
bool cut_ears(const Outline2& outline, Loop loop, std::vector<std::array<std::uint32_t, 3>>& out) {
  const auto& p = outline.points;
  while (loop.size() >= 3) {
    std::size_t best = loop.size();
    double roundest = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[(i + loop.size() - 1) % loop.size()], b = loop[i],
                          c = loop[(i + 1) % loop.size()];
      const double area = turn_of(p[a], p[b], p[c]);
      const double round = area / (glm::dot(p[b] - p[a], p[b] - p[a]) + glm::dot(p[c] - p[b], p[c] - p[b]) +
                                   glm::dot(p[a] - p[c], p[a] - p[c]));
      if (!(round > roundest)) continue;
      const bool holds_one = std::ranges::any_of(loop, [&](std::uint32_t v) {
        return v != a && v != b && v != c && turn_of(p[a], p[b], p[v]) >= 0 &&
               turn_of(p[b], p[c], p[v]) >= 0 && turn_of(p[c], p[a], p[v]) >= 0;
      });
      if (!holds_one) best = i, roundest = round;
    }
    if (best == loop.size()) return false;
    out.push_back({loop[(best + loop.size() - 1) % loop.size()], loop[best], loop[(best + 1) % loop.size()]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return true;
}

// Whether part of the segment lies inside the triangle, farther than `tolerance` from its edges.
bool enters(const glm::dvec2& a, const glm::dvec2& b, const std::array<glm::dvec2, 3>& t, double tolerance) {
  double from = 0, to = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at_a = left_of(t[k], t[(k + 1) % 3], a) - tolerance,
                 at_b = left_of(t[k], t[(k + 1) % 3], b) - tolerance;
    if (at_a <= 0 && at_b <= 0) return false;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  return from < to;
}

// A triangle covers nothing but the region where no edge of that leads into it and one point of it is
// covered.
bool covers_region_alone(const Outline2& outline, const std::array<glm::dvec2, 3>& t, double tolerance) {
  for (const auto& [from, to] : outline.edges) {
    if (enters(outline.points[from], outline.points[to], t, tolerance)) return false;
  }
  const glm::dvec2 middle = (t[0] + t[1] + t[2]) / 3.0;
  return std::ranges::any_of(outline.triangles, [&](const auto& its) {
    return turn_of(its[0], its[1], middle) >= 0 && turn_of(its[1], its[2], middle) >= 0 &&
           turn_of(its[2], its[0], middle) >= 0;
  });
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const Outline2& outline, double tolerance,
                                                      double rounding) {
  std::vector<Loop> loops = loops_of(outline);
  for (Loop& loop : loops) straighten(outline, tolerance, rounding, loop);
  // The one around all others, and holes.
  std::ranges::stable_sort(
      loops, [&](const Loop& a, const Loop& b) { return area_of(outline, a) > area_of(outline, b); });
  if (loops.empty() || !(area_of(outline, loops[0]) > 0)) return {};
  if (loops.size() > 1 && area_of(outline, loops[1]) >= 0) return {};
  Loop whole = loops[0];
  while (loops.size() > 1) {
    const Loop hole = loops.back();
    loops.pop_back();
    if (!bridge(outline, {loops.begin() + 1, loops.end()}, hole, whole)) return {};
  }
  std::vector<std::array<std::uint32_t, 3>> out;
  if (!cut_ears(outline, std::move(whole), out)) return {};
  const auto& p = outline.points;
  for (const auto& t : out) {
    if (!covers_region_alone(outline, {p[t[0]], p[t[1]], p[t[2]]}, 2 * rounding)) return {};
  }
  return out;
}

}  // namespace sightline::occlusion
