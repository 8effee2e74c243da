#include "workbench/methods/raster_occlusion/inner_shell.hpp"

#include <algorithm>
#include <cmath>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline::methods {

namespace {

using geometry::to_double;

constexpr std::size_t kManyTriangles = 160;
constexpr std::size_t kMostWork = 20'000'000;  // vertices × triangles
constexpr double kRound = 0.8;                 // inner radius / outer radius: a ball stands for the mesh

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

// How deep `middle` lies below the nearest triangle's plane of a closed mesh that no vertex of its own stands
// out of; 0 where the mesh is not so.
double depth_in_convex(const occlusion::OccluderTopology& mesh, const glm::dvec3& middle, double reach) {
  const double tolerance = 1e-5 * reach;
  double depth = reach;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t other : mesh.neighbours[t]) {
      if (other == occlusion::OccluderTopology::kNone) return 0;
    }
    const auto& [a, b, c] = mesh.triangles[t];
    const glm::dvec3 p = to_double(mesh.positions[a]);
    glm::dvec3 normal = glm::cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;
    normal /= glm::dot(normal, middle - p) > 0 ? -length : length;
    for (const Vec3& v : mesh.positions) {
      if (glm::dot(normal, to_double(v) - p) > tolerance) return 0;
    }
    depth = std::min(depth, glm::dot(normal, p - middle) - tolerance);
  }
  return std::max(depth, 0.0);
}

}  // namespace

OccluderMesh simple_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
  OccluderMesh mesh(positions, indices);
  const auto& all = mesh.topology().positions;
  if (mesh.triangles() < kManyTriangles || all.size() * mesh.triangles() > kMostWork) return mesh;
  const glm::dvec3 middle = middle_of(all);
  const double reach = reach_of(all, middle);
  if (depth_in_convex(mesh.topology(), middle, reach) == 0) return mesh;

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

std::optional<Sphere> inner_ball(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
  const OccluderMesh mesh(positions, indices);
  const auto& all = mesh.topology().positions;
  if (mesh.triangles() < 8 || all.size() * mesh.triangles() > kMostWork) return {};
  const glm::dvec3 middle = middle_of(all);
  const double reach = reach_of(all, middle), depth = depth_in_convex(mesh.topology(), middle, reach);
  if (!(depth > kRound * reach)) return {};
  // The centre is rounded, and so is what a transform makes of it.
  const double rounding = 1e-6 * (reach + glm::length(middle));
  return Sphere{geometry::to_vec3(middle), static_cast<float>(depth - rounding)};
}

}  // namespace sightline::methods
