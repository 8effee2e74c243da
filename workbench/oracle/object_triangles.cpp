#include "workbench/oracle/object_triangles.hpp"

#include <array>
#include <utility>

namespace sightline::oracle {
namespace {

/// Möller & Trumbore 1997.
std::optional<double> meet_triangle(const PixelRay& ray, const std::array<glm::dvec3, 3>& triangle,
                                    Sides sides) {
  const glm::dvec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const glm::dvec3 p = glm::cross(ray.direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0 || (sides == Sides::front && determinant < 0)) return {};
  const glm::dvec3 from = ray.origin - triangle[0];
  const double u = glm::dot(from, p) / determinant;
  if (!(u >= 0 && u <= 1)) return {};
  const glm::dvec3 q = glm::cross(from, ab);
  const double v = glm::dot(ray.direction, q) / determinant;
  if (!(v >= 0 && u + v <= 1)) return {};
  const double t = glm::dot(ac, q) / determinant;
  if (!(t >= 0 && t <= ray.length)) return {};
  return t;
}

}  // namespace

ObjectTriangles::ObjectTriangles(const Scene& scene, ObjectId object) : sides_(scene.sides[object]) {
  const Mesh& mesh = scene.meshes[scene.mesh[object]];
  corners_.reserve(mesh.index_count);
  for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
    const std::uint32_t v = mesh.first_vertex + scene.indices[mesh.first_index + i];
    const Vec3 p = transform_point(scene.transform[object], scene.positions[v]);
    corners_.emplace_back(p.x, p.y, p.z);
  }
  if (mirrors(scene.transform[object])) {
    for (std::size_t i = 0; i + 2 < corners_.size(); i += 3) std::swap(corners_[i + 1], corners_[i + 2]);
  }
  const Sphere sphere = scene.sphere(object);
  centre_ = {sphere.centre.x, sphere.centre.y, sphere.centre.z};
  radius_ = 1.001 * static_cast<double>(sphere.radius) + 1e-5 * glm::length(centre_);
}

std::optional<double> ObjectTriangles::meet(const PixelRay& ray) const {
  const glm::dvec3 offset = centre_ - ray.origin;
  const glm::dvec3 across = offset - glm::dot(offset, ray.direction) * ray.direction;
  if (glm::dot(across, across) > radius_ * radius_) return {};
  std::optional<double> nearest;
  for (std::size_t i = 0; i + 2 < corners_.size(); i += 3) {
    const auto t = meet_triangle(ray, {corners_[i], corners_[i + 1], corners_[i + 2]}, sides_);
    if (t && (!nearest || *t < *nearest)) nearest = t;
  }
  return nearest;
}

}  // namespace sightline::oracle
