// Node transforms of glTF in double precision, so that a deep hierarchy does not add up rounding.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include <sightline/workbench/scene.hpp>

namespace sightline::io::gltf {

using Transform = glm::dmat4;

struct Parts {
  std::array<double, 3> translation{0, 0, 0};
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
  std::array<double, 3> scale{1, 1, 1};
};

/// As floats have them.
Parts rounded(Parts parts) noexcept;

/// Attributes of instances that write_glb adds where the parts alone would not give the same bits: the rows
/// of each transform.
inline constexpr std::array<const char*, 3> kRowAttributes{"_ROW_X", "_ROW_Y", "_ROW_Z"};

/// translation · rotation · scale; a quaternion of any length but zero (which turns nothing).
Transform compose(const Parts& parts) noexcept;

/// The parts of a transform, if it is made of such: false for a shear, a collapsed axis, or where composing
/// the parts in single precision again would move it by more than rounding.
bool decompose(const Affine& affine, Parts& parts) noexcept;

Affine to_affine(const Transform& transform) noexcept;

}  // namespace sightline::io::gltf
