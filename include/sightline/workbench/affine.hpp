// How the workbench places meshes: three rows, as GPUs read them.
#pragma once

#include <array>

#include <sightline/types.hpp>

namespace sightline {

/// Affine transform, three rows of (linear part | translation).
struct Affine {
  std::array<Vec4, 3> rows{Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}};
  bool operator==(const Affine&) const = default;
};

inline Vec3 transform_point(const Affine& affine, const Vec3& p) noexcept {
  const auto row = [&](const Vec4& r) { return r.x * p.x + r.y * p.y + r.z * p.z + r.w; };
  return {row(affine.rows[0]), row(affine.rows[1]), row(affine.rows[2])};
}

/// Of its linear part.
inline double determinant(const Affine& affine) noexcept {
  const auto& [x, y, z] = affine.rows;
  const auto minor = [](double p, double q, double r, double s) { return p * s - q * r; };
  return x.x * minor(y.y, y.z, z.y, z.z) - x.y * minor(y.x, y.z, z.x, z.z) + x.z * minor(y.x, y.y, z.x, z.y);
}
/// Whether it turns triangles the other way.
inline bool mirrors(const Affine& affine) noexcept {
  return determinant(affine) < 0;
}

/// The same as the library takes it, column by column.
inline Mat4 to_matrix(const Affine& affine) noexcept {
  Mat4 out;
  for (std::size_t r = 0; r < 3; ++r) {
    const Vec4& row = affine.rows[r];
    out.m[r] = row.x, out.m[4 + r] = row.y, out.m[8 + r] = row.z, out.m[12 + r] = row.w;
  }
  return out;
}

}  // namespace sightline
