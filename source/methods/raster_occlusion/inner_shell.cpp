#include "methods/raster_occlusion/inner_shell.hpp"

#include <algorithm>
#include <cmath>

#include "culling/depth_tiles.hpp"
#include "geometry/linear.hpp"
#include "scene/shapes.hpp"

namespace sightline::methods {

namespace {

using geometry::to_double;

constexpr std::size_t kManyTriangles = 160;
constexpr std::size_t kMostWork = 20'000'000;  // vertices × triangles

glm::dvec3 middle_of(std::span<const Vec3> points) {
  glm::dvec3 sum(0);
  for (const Vec3& p : points) sum += to_double(p);
  return sum / static_cast<double>(points.size());
}

double reach_of(std::span<const Vec3> points, const glm::dvec3& middle) {
  double reach = 0;
  for (const Vec3& p : points) reach = std::max(reach, glm::length(to_double(p) - middle));
  return reach;
}

// Each edge between two triangles, and no vertex beyond any triangle's plane.
bool closed_and_convex(const culling::OccluderTopology& mesh, const glm::dvec3& middle, double reach) {
  const double tolerance = 1e-5 * reach;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t other : mesh.neighbours[t]) {
      if (other == culling::OccluderTopology::kNone) return false;
    }
    const auto& [a, b, c] = mesh.triangles[t];
    const glm::dvec3 p = to_double(mesh.positions[a]);
    glm::dvec3 normal = glm::cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;
    normal /= glm::dot(normal, middle - p) > 0 ? -length : length;
    for (const Vec3& v : mesh.positions) {
      if (glm::dot(normal, to_double(v) - p) > tolerance) return false;
    }
  }
  return true;
}

}  // namespace

OccluderMesh simple_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
  OccluderMesh mesh(positions, indices);
  const auto& all = mesh.topology().positions;
  if (mesh.triangles() < kManyTriangles || all.size() * mesh.triangles() > kMostWork) return mesh;
  const glm::dvec3 middle = middle_of(all);
  const double reach = reach_of(all, middle);
  if (!closed_and_convex(mesh.topology(), middle, reach)) return mesh;

  // The mesh's own outermost points in the directions of a coarse sphere, a little inwards.
  scene::Shape shell = scene::sphere(1);
  for (Vec3& corner : shell.positions) {
    const glm::dvec3 direction = to_double(corner);
    const auto outermost = std::max_element(all.begin(), all.end(), [&](const Vec3& a, const Vec3& b) {
      return glm::dot(direction, to_double(a)) < glm::dot(direction, to_double(b));
    });
    corner = geometry::to_vec3(middle + (to_double(*outermost) - middle) * (1 - 1e-4));
  }
  return OccluderMesh(shell.positions, shell.indices);
}

}  // namespace sightline::methods
