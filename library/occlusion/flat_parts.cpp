#include "library/occlusion/flat_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "library/geometry/linear.hpp"
#include "library/occlusion/polygon.hpp"

namespace sightline::occlusion {

using geometry::to_double;

namespace {

// Of the largest coordinate: off the plane, and out of a straight edge; and how far apart positions may lie
// on one straight edge that are rounded, each by half a unit in the last place along three axes.
constexpr double kFlat = 1e-6, kRounding = 2.1e-7;
constexpr double kLeastUp = 0.9999;  // the cosine to its plane's normal of a triangle that is not too thin
constexpr std::size_t kMostCorners = 400;  // of an outline: its cost grows with the square

class FlatParts {
public:
  explicit FlatParts(const MeshParts& mesh);
  std::vector<Candidate> take() { return std::move(out_); }

private:
  using Corners = std::array<std::uint32_t, 3>;
  [[nodiscard]] glm::dvec3 point(std::uint32_t v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] glm::dvec3 normal(const Corners& t) const {
    const auto& [a, b, c] = t;
    return glm::cross(point(b) - point(a), point(c) - point(a));
  }
  [[nodiscard]] glm::dvec3 normal(std::uint32_t t) const { return normal(mesh_.triangles[t]); }
  void grow(std::uint32_t seed, std::uint32_t part);
  [[nodiscard]] bool find_outline(const glm::dvec3& normal, Outline2& outline) const;
  void add(const Corners& corners, bool one_sided, std::uint32_t part);

  const MeshParts& mesh_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> region_;     // on one plane
  std::vector<std::uint32_t> of_region_;  // the seed of the region that a triangle lies in
  double reach_ = 0;                      // the largest coordinate
  std::vector<Candidate> out_;
};

FlatParts::FlatParts(const MeshParts& mesh)
    : mesh_(mesh), taken_(mesh.triangles.size(), 0), of_region_(mesh.triangles.size(), MeshParts::kNone) {
  for (const Vec3& p : mesh.positions)
    reach_ = std::max({reach_, std::fabs(double{p.x}), std::fabs(double{p.y}), std::fabs(double{p.z})});
  for (std::uint32_t part = 0; part < mesh.parts.size(); ++part) {
    // Large triangles say best on which plane they lie.
    std::vector<std::pair<double, std::uint32_t>> seeds;
    for (const std::uint32_t t : mesh.parts[part].triangles) seeds.emplace_back(-glm::length(normal(t)), t);
    std::ranges::sort(seeds);
    for (const auto& [area, t] : seeds) {
      if (!taken_[t] && area < 0) grow(t, part);
    }
  }
}

void FlatParts::add(const Corners& corners, bool one_sided, std::uint32_t part) {
  Candidate c;
  for (std::size_t k = 0; k < 3; ++k) c.corners[k] = mesh_.positions[corners[k]];
  c.sides = one_sided ? Sides::front : Sides::both, c.part = part, c.area = triangle_area(c.corners);
  if (c.area > 0) out_.push_back(c);
}

// Takes all triangles on the seed's plane that hang together with it and are drawn from the same sides.
void FlatParts::grow(std::uint32_t seed, std::uint32_t part) {
  const glm::dvec3 up = glm::normalize(normal(seed));
  const double at = glm::dot(up, point(mesh_.triangles[seed][0]));
  const auto on_plane = [&](std::uint32_t t) {
    for (const std::uint32_t v : mesh_.triangles[t]) {
      if (std::fabs(glm::dot(up, point(v)) - at) > kFlat * reach_) return false;
    }
    return glm::dot(normal(t), up) > 0;
  };
  region_.assign(1, seed);
  taken_[seed] = 1, of_region_[seed] = seed;
  for (std::size_t i = 0; i < region_.size(); ++i) {
    for (const std::uint32_t other : mesh_.neighbours[region_[i]]) {
      if (other == MeshParts::kNone || taken_[other] || mesh_.one_sided[other] != mesh_.one_sided[seed])
        continue;
      if (!on_plane(other)) continue;
      taken_[other] = 1, of_region_[other] = seed;
      region_.push_back(other);
    }
  }
  Outline2 outline;
  std::vector<Corners> merged;
  if (region_.size() > 2 && find_outline(up, outline))
    merged = triangulate(outline, kFlat * reach_, kRounding * reach_);
  if (merged.empty() || merged.size() >= region_.size()) {
    for (const std::uint32_t t : region_) add(mesh_.triangles[t], mesh_.one_sided[t], part);
    return;
  }
  for (const Corners& t : merged) {
    const Corners corners{outline.vertex[t[0]], outline.vertex[t[1]], outline.vertex[t[2]]};
    // As thin as its corners lie off the plane it may turn anywhere, and show where the mesh does not.
    const glm::dvec3 its = normal(corners);
    if (glm::dot(its, up) > kLeastUp * glm::length(its)) add(corners, mesh_.one_sided[seed], part);
  }
}

// The edges that bound the region, seen from above it, and its triangles. False where there are too many.
bool FlatParts::find_outline(const glm::dvec3& up, Outline2& outline) const {
  const glm::dvec3 size = glm::abs(up);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  // The third coordinate's sign decides which way round the others are counter-clockwise.
  const auto flat = [&](std::uint32_t v) {
    const glm::dvec3 p = point(v);
    return up[axis] > 0 ? glm::dvec2(p[b], p[c]) : glm::dvec2(p[c], p[b]);
  };
  std::map<std::uint32_t, std::uint32_t> known;
  const auto local = [&](std::uint32_t v) {
    const auto [place, added] = known.try_emplace(v, static_cast<std::uint32_t>(outline.vertex.size()));
    if (added) {
      outline.vertex.push_back(v), outline.points.push_back(flat(v));
      outline.heights.push_back(glm::dot(up, point(v)));
    }
    return place->second;
  };
  for (const std::uint32_t t : region_) {
    const auto& corners = mesh_.triangles[t];
    outline.triangles.push_back({flat(corners[0]), flat(corners[1]), flat(corners[2])});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = mesh_.neighbours[t][k];
      if (other != MeshParts::kNone && of_region_[other] == region_[0]) continue;
      const std::uint32_t from = local(corners[k]);  // numbered first, whatever the compiler
      outline.edges.emplace_back(from, local(corners[(k + 1) % 3]));
      if (outline.edges.size() > kMostCorners) return false;
    }
  }
  return true;
}

}  // namespace

double triangle_area(const std::array<Vec3, 3>& t) {
  const glm::dvec3 p = to_double(t[0]);
  return 0.5 * glm::length(glm::cross(to_double(t[1]) - p, to_double(t[2]) - p));
}

std::vector<Candidate> flat_parts(const MeshParts& mesh) {
  return FlatParts(mesh).take();
}

}  // namespace sightline::occlusion
