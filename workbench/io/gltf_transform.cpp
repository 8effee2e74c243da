#include "workbench/io/gltf_transform.hpp"

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace sightline::io::gltf {

Parts rounded(Parts parts) noexcept {
  for (auto& v : parts.translation) v = static_cast<float>(v);
  for (auto& v : parts.rotation) v = static_cast<float>(v);
  for (auto& v : parts.scale) v = static_cast<float>(v);
  return parts;
}

Transform compose(const Parts& parts) noexcept {
  const auto& [x, y, z, w] = parts.rotation;
  const glm::dquat rotation = glm::normalize(glm::dquat(w, x, y, z));
  const glm::dmat4 moved = glm::translate(glm::dmat4(1), glm::make_vec3(parts.translation.data()));
  return glm::scale(moved * glm::mat4_cast(rotation), glm::make_vec3(parts.scale.data()));
}

bool decompose(const Affine& affine, Parts& parts) noexcept {
  const auto& rows = affine.rows;
  const glm::dmat3 linear(rows[0].x, rows[1].x, rows[2].x, rows[0].y, rows[1].y, rows[2].y, rows[0].z,
                          rows[1].z, rows[2].z);
  glm::dvec3 scale(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
  const double largest = glm::max(scale.x, glm::max(scale.y, scale.z));
  if (!glm::all(glm::greaterThan(scale, glm::dvec3(1e-12)))) return false;
  if (glm::determinant(linear) < 0) scale.x = -scale.x;  // a mirror
  const glm::dquat turn =
      glm::quat_cast(glm::dmat3(linear[0] / scale.x, linear[1] / scale.y, linear[2] / scale.z));
  parts.translation = {rows[0].w, rows[1].w, rows[2].w};
  parts.rotation = {turn.x, turn.y, turn.z, turn.w};
  parts.scale = {scale.x, scale.y, scale.z};
  const glm::dmat3 again(compose(rounded(parts)));
  for (int c = 0; c < 3; ++c) {
    if (!glm::all(glm::lessThanEqual(glm::abs(again[c] - linear[c]), glm::dvec3(1e-6 * largest))))
      return false;
  }
  return true;
}

Affine to_affine(const Transform& transform) noexcept {
  Affine out;
  for (int r = 0; r < 3; ++r) {
    const glm::vec4 row(glm::row(transform, r));
    out.rows[static_cast<std::size_t>(r)] = {row.x, row.y, row.z, row.w};
  }
  return out;
}

}  // namespace sightline::io::gltf
