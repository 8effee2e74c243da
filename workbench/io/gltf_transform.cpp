#include "workbench/io/gltf_transform.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::io::gltf {

Transform operator*(const Transform& a, const Transform& b) noexcept {
  Transform out;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      out.rows[r][c] = a.rows[r][0] * b.rows[0][c] + a.rows[r][1] * b.rows[1][c] +
                       a.rows[r][2] * b.rows[2][c] + (c == 3 ? a.rows[r][3] : 0);
    }
  }
  return out;
}

Transform compose(const Parts& parts) noexcept {
  auto [x, y, z, w] = parts.rotation;
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if (length > 0) {
    x /= length, y /= length, z /= length, w /= length;
  } else {
    w = 1;
  }
  const auto& s = parts.scale;
  const auto& t = parts.translation;
  return {
      {{{s[0] * (1 - 2 * (y * y + z * z)), s[1] * 2 * (x * y - z * w), s[2] * 2 * (x * z + y * w), t[0]},
        {s[0] * 2 * (x * y + z * w), s[1] * (1 - 2 * (x * x + z * z)), s[2] * 2 * (y * z - x * w), t[1]},
        {s[0] * 2 * (x * z - y * w), s[1] * 2 * (y * z + x * w), s[2] * (1 - 2 * (x * x + y * y)), t[2]}}}};
}

bool decompose(const Affine& affine, Parts& parts) noexcept {
  std::array<std::array<double, 3>, 3> m;  // rows of the rotation
  const auto& rows = affine.rows;
  for (std::size_t r = 0; r < 3; ++r) m[r] = {rows[r].x, rows[r].y, rows[r].z};
  parts.translation = {rows[0].w, rows[1].w, rows[2].w};
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  for (std::size_t c = 0; c < 3; ++c) {
    double scale = std::sqrt(m[0][c] * m[0][c] + m[1][c] * m[1][c] + m[2][c] * m[2][c]);
    if (!(scale > 1e-12)) return false;
    if (c == 0 && determinant < 0) scale = -scale;  // a mirror
    parts.scale[c] = scale;
    for (std::size_t r = 0; r < 3; ++r) m[r][c] /= scale;
  }
  // Of the four equivalent formulas the one with the largest divisor (Shepperd 1978).
  const std::array<double, 4> squares{1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
                                      1 - m[0][0] - m[1][1] + m[2][2], 1 + m[0][0] + m[1][1] + m[2][2]};
  const auto largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  if (!(squares[largest] > 0)) return false;
  const double d = 2 * std::sqrt(squares[largest]);
  const double yz = (m[2][1] - m[1][2]) / d, zx = (m[0][2] - m[2][0]) / d, xy = (m[1][0] - m[0][1]) / d;
  const double sum_xy = (m[0][1] + m[1][0]) / d, sum_xz = (m[0][2] + m[2][0]) / d,
               sum_yz = (m[1][2] + m[2][1]) / d;
  switch (largest) {
    case 0:
      parts.rotation = {d / 4, sum_xy, sum_xz, yz};
      break;
    case 1:
      parts.rotation = {sum_xy, d / 4, sum_yz, zx};
      break;
    case 2:
      parts.rotation = {sum_xz, sum_yz, d / 4, xy};
      break;
    default:
      parts.rotation = {yz, zx, xy, d / 4};
      break;
  }
  Parts rounded = parts;
  for (auto& v : rounded.rotation) v = static_cast<float>(v);
  for (auto& v : rounded.scale) v = static_cast<float>(v);
  const Transform again = compose(rounded);
  const double tolerance = 1e-6 * std::max({std::abs(parts.scale[0]), parts.scale[1], parts.scale[2]});
  for (std::size_t r = 0; r < 3; ++r) {
    const std::array<double, 3> row{rows[r].x, rows[r].y, rows[r].z};
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(std::abs(again.rows[r][c] - row[c]) <= tolerance)) return false;
    }
  }
  return true;
}

Affine to_affine(const Transform& transform) noexcept {
  Affine out;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto& row = transform.rows[r];
    out.rows[r] = {static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2]),
                   static_cast<float>(row[3])};
  }
  return out;
}

}  // namespace sightline::io::gltf
