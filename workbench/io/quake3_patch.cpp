#include "workbench/io/quake3_patch.hpp"

#include <array>

namespace sightline::io::quake3 {

namespace {

struct Surfel64 {
  std::array<double, 8> v;
};

/// The three Bernstein weights at i / level. Built from integers so that i and level - i mirror each other
/// exactly.
std::array<double, 3> weights(std::uint32_t i, std::uint32_t level) {
  const double t = i, u = level - i, squared = double{t + u} * (t + u);
  return {u * u / squared, 2 * t * u / squared, t * t / squared};
}

Surfel64 blend(const Surfel64& a, const Surfel64& b, const Surfel64& c, const std::array<double, 3>& w) {
  Surfel64 out;
  // The ends are added first: the sum is then the same with a and c swapped.
  for (std::size_t k = 0; k < out.v.size(); ++k) out.v[k] = (w[0] * a.v[k] + w[2] * c.v[k]) + w[1] * b.v[k];
  return out;
}

}  // namespace

PatchGrid tessellate(std::span<const Surfel> control, std::uint32_t width, std::uint32_t height,
                     std::uint32_t level) {
  const auto point = [&](std::uint32_t column, std::uint32_t row) {
    const Surfel& s = control[std::size_t{row} * width + column];
    return Surfel64{{s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z,
                     s.texture.u, s.texture.v}};
  };
  const std::uint32_t columns = (width - 1) / 2 * level + 1, rows = (height - 1) / 2 * level + 1;
  PatchGrid grid;
  grid.vertices.reserve(std::size_t{columns} * rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::uint32_t top = row == rows - 1 ? height - 3 : row / level * 2;
    const std::array<double, 3> down = weights(row - top / 2 * level, level);
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t left = column == columns - 1 ? width - 3 : column / level * 2;
      const std::array<double, 3> across = weights(column - left / 2 * level, level);
      std::array<Surfel64, 3> line;
      for (std::uint32_t k = 0; k < 3; ++k) {
        line[k] = blend(point(left, top + k), point(left + 1, top + k), point(left + 2, top + k), across);
      }
      const auto v = blend(line[0], line[1], line[2], down).v;
      const auto f = [&](std::size_t k) { return static_cast<float>(v[k]); };
      grid.vertices.push_back({{f(0), f(1), f(2)}, {f(3), f(4), f(5)}, {f(6), f(7)}});
    }
  }
  grid.indices.reserve(std::size_t{columns - 1} * (rows - 1) * 6);
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      grid.indices.insert(grid.indices.end(), {a, c, b, b, c, d});
    }
  }
  return grid;
}

}  // namespace sightline::io::quake3
