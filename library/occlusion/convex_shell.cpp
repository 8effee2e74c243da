// A convex hull that grows point by point, the outermost first (Barber, Dobkin & Huhdanpaa 1996), and stops
// early.
#include <algorithm>
#include <map>

#include "library/occlusion/shell.hpp"

namespace sightline::occlusion {

namespace {

constexpr double kNoFarther = 1e-3;  // of the cube: closer points are as good as on the hull
constexpr double kSmaller = 1e-3;

struct Face {
  std::array<std::uint32_t, 3> corners;
  glm::dvec3 normal;
  double at;
  std::vector<std::uint32_t> beyond;  // points outside it, that no other face has
  std::uint32_t outermost = 0;
  double farthest = 0;
};

class Hull {
public:
  explicit Hull(const std::vector<glm::dvec3>& points) : p_(points) {
    if (!begin()) faces_.clear();
  }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  // Takes the farthest point in; false where none is left that matters, or it would need too many triangles.
  bool grow(std::size_t most) {
    const auto face = std::ranges::max_element(faces_, {}, &Face::farthest);
    if (face == faces_.end() || !(face->farthest > kNoFarther)) return false;
    const std::uint32_t point = face->outermost;
    const auto sees = [&](const Face& f) { return glm::dot(f.normal, p_[point]) - f.at > 1e-12; };
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;  // of faces that see the point
    std::size_t seen = 0;
    for (const Face& f : faces_) {
      if (!sees(f)) continue;
      ++seen;
      for (std::size_t k = 0; k < 3; ++k) edges[{f.corners[k], f.corners[(k + 1) % 3]}] = true;
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> rim;
    for (const auto& [edge, there] : edges) {
      if (!edges.contains({edge.second, edge.first})) rim.push_back(edge);
    }
    if (faces_.size() - seen + rim.size() > most) return false;
    std::vector<std::uint32_t> loose;
    for (const Face& f : faces_) {
      if (sees(f)) loose.insert(loose.end(), f.beyond.begin(), f.beyond.end());
    }
    std::erase_if(faces_, sees);
    const std::size_t first = faces_.size();
    for (const auto& [a, b] : rim) add(a, b, point);
    for (const std::uint32_t i : loose) give(i, first);
    return true;
  }

private:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::dvec3 normal = glm::cross(p_[b] - p_[a], p_[c] - p_[a]);
    const double length = glm::length(normal);
    Face f{{a, b, c}, length > 0 ? normal / length : glm::dvec3(0), 0, {}, 0, 0};
    f.at = glm::dot(f.normal, p_[a]);
    faces_.push_back(std::move(f));
  }
  // To the first face, from number `first` on, that the point lies outside of.
  void give(std::uint32_t i, std::size_t first) {
    for (std::size_t f = first; f < faces_.size(); ++f) {
      const double away = glm::dot(faces_[f].normal, p_[i]) - faces_[f].at;
      if (!(away > 1e-12)) continue;
      faces_[f].beyond.push_back(i);
      if (away > faces_[f].farthest) faces_[f].farthest = away, faces_[f].outermost = i;
      return;
    }
  }
  template <class Score>
  [[nodiscard]] std::uint32_t most(Score score) const {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < p_.size(); ++i) {
      if (score(p_[i]) > score(p_[best])) best = i;
    }
    return best;
  }
  // Four points far apart; false where all lie on a plane.
  bool begin() {
    if (p_.size() < 4) return false;
    const std::uint32_t a = most([](const glm::dvec3& p) { return -p.x - 0.3 * p.y - 0.2 * p.z; });
    const std::uint32_t b = most([&](const glm::dvec3& p) { return glm::dot(p - p_[a], p - p_[a]); });
    const auto from_line = [&](const glm::dvec3& p) {
      const glm::dvec3 n = glm::cross(p - p_[a], p_[b] - p_[a]);
      return glm::dot(n, n);
    };
    std::uint32_t c = most(from_line);
    const glm::dvec3 normal = glm::cross(p_[b] - p_[a], p_[c] - p_[a]);
    const std::uint32_t d = most([&](const glm::dvec3& p) { return std::abs(glm::dot(normal, p - p_[a])); });
    const double volume = glm::dot(normal, p_[d] - p_[a]);
    if (!(std::abs(volume) > 1e-6)) return false;
    const std::uint32_t e = volume > 0 ? c : b;  // the corner that goes first, so that d lies behind
    c = volume > 0 ? b : c;
    add(a, e, c), add(e, a, d), add(c, e, d), add(a, c, d);
    for (std::uint32_t i = 0; i < p_.size(); ++i) give(i, 0);
    return true;
  }

  const std::vector<glm::dvec3>& p_;
  std::vector<Face> faces_;
};

}  // namespace

Shell convex_shell(const Solid& solid, std::size_t most_triangles, double from_lid) {
  std::vector<glm::dvec3> points = solid.points();
  if (solid.has_lid())
    std::erase_if(points, [&](const glm::dvec3& p) { return solid.distance_to_lid(p) < from_lid; });
  Hull hull(points);
  if (hull.faces().size() > most_triangles) return {};
  while (hull.grow(most_triangles)) {
  }
  Shell out;
  std::map<std::uint32_t, std::uint32_t> place;
  glm::dvec3 middle(0);
  for (const Face& f : hull.faces()) {
    auto& t = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, added] = place.try_emplace(f.corners[k], static_cast<std::uint32_t>(out.points.size()));
      if (added) out.points.push_back(points[f.corners[k]]), middle += out.points.back();
      t[k] = at->second;
    }
  }
  middle /= std::max(1.0, static_cast<double>(out.points.size()));
  for (glm::dvec3& p : out.points) p += kSmaller * (middle - p);
  return out;
}

}  // namespace sightline::occlusion
