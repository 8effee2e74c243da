#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <sightline/workbench/error.hpp>

#include "workbench/scene/shapes.hpp"

namespace sightline::methods {

namespace {

constexpr std::size_t kManyTriangles = 160;
constexpr std::size_t kMostWork = 20'000'000;  // vertices × triangles
constexpr double kRound = 0.8;                 // inner radius / outer radius: a sphere stands for the mesh

glm::dvec3 in_double(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 to_single(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// A mesh whose vertices at one place are one, without the triangles that have no corners apart.
struct JoinedMesh {
  std::vector<glm::dvec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  JoinedMesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices);
  /// Whether each edge has two triangles.
  [[nodiscard]] bool closed() const;
};

JoinedMesh::JoinedMesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices) {
  std::map<std::array<float, 3>, std::uint32_t> joined;
  const auto join = [&](std::uint32_t index) {
    const Vec3& v = vertices[index];
    const auto [at, added] =
        joined.try_emplace({v.x, v.y, v.z}, static_cast<std::uint32_t>(positions.size()));
    if (added) positions.push_back(in_double(v));
    return at->second;
  };
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    const std::span<const std::uint32_t> its = indices.subspan(i, 3);
    if (*std::max_element(its.begin(), its.end()) >= vertices.size()) continue;
    const std::array<std::uint32_t, 3> t{join(its[0]), join(its[1]), join(its[2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
}

bool JoinedMesh::closed() const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
    if (i + 2 < edges.size() && edges[i] == edges[i + 2]) return false;
  }
  return true;
}

// The middle of a closed mesh that no vertex of its own stands out of, how far its vertices reach from there,
// and how deep it lies below the nearest triangle's plane. Nothing where the mesh is not so, or where a
// triangle whose back is not drawn looks inwards: from outside it is not there.
struct ConvexMiddle {
  glm::dvec3 middle;
  double reach, depth;
};

std::optional<ConvexMiddle> convex_middle(const JoinedMesh& mesh, Sides sides) {
  if (mesh.positions.size() * mesh.triangles.size() > kMostWork || !mesh.closed()) return {};
  ConvexMiddle out{glm::dvec3(0), 0, 0};
  for (const glm::dvec3& p : mesh.positions) out.middle += p;
  out.middle /= static_cast<double>(mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions) out.reach = std::max(out.reach, glm::length(p - out.middle));
  const double tolerance = 1e-5 * out.reach;
  out.depth = out.reach;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3& p = mesh.positions[a];
    glm::dvec3 normal = glm::cross(mesh.positions[b] - p, mesh.positions[c] - p);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;
    const bool inwards = glm::dot(normal, out.middle - p) > 0;
    if (inwards && sides == Sides::front) return {};
    normal /= inwards ? -length : length;
    for (const glm::dvec3& v : mesh.positions) {
      if (glm::dot(normal, v - p) > tolerance) return {};
    }
    out.depth = std::min(out.depth, glm::dot(normal, p - out.middle) - tolerance);
  }
  return out.depth > 0 ? std::optional(out) : std::nullopt;
}

}  // namespace

std::optional<OccluderMesh> occluder_proxy(std::span<const Vec3> positions,
                                           std::span<const std::uint32_t> indices, Sides sides) {
  const JoinedMesh mesh(positions, indices);
  if (mesh.triangles.size() < kManyTriangles) return {};
  const std::optional<ConvexMiddle> convex = convex_middle(mesh, sides);
  if (!convex) return {};
  // The mesh's own outermost points in the directions of a coarse sphere, a little inwards.
  scene::Shape proxy = scene::sphere(1);
  for (Vec3& corner : proxy.positions) {
    const glm::dvec3 direction = in_double(corner);
    const auto outermost =
        std::max_element(mesh.positions.begin(), mesh.positions.end(),
                         [&](const auto& a, const auto& b) { return dot(direction, a) < dot(direction, b); });
    corner = to_single(convex->middle + (*outermost - convex->middle) * (1 - 1e-4));
  }
  return or_throw(OccluderMesh::make(proxy.positions, proxy.indices));
}

std::optional<Sphere> inner_sphere(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                                   Sides sides) {
  const JoinedMesh mesh(positions, indices);
  if (mesh.triangles.size() < 8) return {};
  const std::optional<ConvexMiddle> convex = convex_middle(mesh, sides);
  if (!convex || !(convex->depth > kRound * convex->reach)) return {};
  // The centre is rounded, and so is what a transform makes of it.
  const double rounding = 1e-6 * (convex->reach + glm::length(convex->middle));
  return Sphere{to_single(convex->middle), static_cast<float>(convex->depth - rounding)};
}

Sphere sphere_inside(const Affine& transform, const Sphere& sphere) noexcept {
  const auto dot_of_columns = [&](int a, int b) {
    float sum = 0;
    for (const Vec4& row : transform.rows) {
      const float columns[3] = {row.x, row.y, row.z};
      sum += columns[a] * columns[b];
    }
    return sum;
  };
  // The square of how much shorter a direction may become, by Gershgorin's discs, rounded downwards.
  float least = dot_of_columns(0, 0);
  for (int a = 0; a < 3; ++a) {
    const float off = std::fabs(dot_of_columns(a, (a + 1) % 3)) + std::fabs(dot_of_columns(a, (a + 2) % 3));
    least = std::min(least, dot_of_columns(a, a) - off);
  }
  const float shrinks = least > 0 ? std::sqrt(least) * (1 - 1e-5f) : 0;
  return {transform_point(transform, sphere.centre), sphere.radius * shrinks};
}

}  // namespace sightline::methods
