#include "workbench/scene/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "library/geometry/elementary.hpp"

namespace sightline::scene {

namespace {

Vec3 normalised(const Vec3& v) {
  const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}

}  // namespace

void Shape::append(const Shape& other) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  for (std::uint32_t index : other.indices) indices.push_back(first + index);
  if (texture_coordinates.empty() && other.texture_coordinates.empty()) return;
  texture_coordinates.resize(first);
  texture_coordinates.insert(texture_coordinates.end(), other.texture_coordinates.begin(),
                             other.texture_coordinates.end());
  texture_coordinates.resize(positions.size());
}

Shape sphere(std::uint32_t subdivisions) {
  constexpr float a = 1, b = std::numbers::phi_v<float>;
  Shape shape;
  for (const Vec3& v : {Vec3{-a, b, 0},
                        {a, b, 0},
                        {-a, -b, 0},
                        {a, -b, 0},
                        {0, -a, b},
                        {0, a, b},
                        {0, -a, -b},
                        {0, a, -b},
                        {b, 0, -a},
                        {b, 0, a},
                        {-b, 0, -a},
                        {-b, 0, a}}) {
    shape.positions.push_back(normalised(v));
  }
  shape.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                   4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                   6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (std::uint32_t level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [at, added] =
          middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(shape.positions.size()));
      if (added) {
        const Vec3 p = shape.positions[i], q = shape.positions[j];
        shape.positions.push_back(normalised({p.x + q.x, p.y + q.y, p.z + q.z}));
      }
      return at->second;
    };
    std::vector<std::uint32_t> finer;
    finer.reserve(shape.indices.size() * 4);
    for (std::size_t t = 0; t < shape.indices.size(); t += 3) {
      const std::uint32_t i = shape.indices[t], j = shape.indices[t + 1], k = shape.indices[t + 2];
      const std::uint32_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
      for (std::uint32_t v : {i, ij, ki, j, jk, ij, k, ki, jk, ij, jk, ki}) finer.push_back(v);
    }
    shape.indices = std::move(finer);
  }
  shape.normals = shape.positions;
  return shape;
}

Shape cone(float base_radius, float top_radius, float base_y, float top_y, std::uint32_t sides) {
  Shape shape;
  const float rise = top_y - base_y, slope = base_radius - top_radius;
  for (std::uint32_t i = 0; i <= sides; ++i) {
    const float angle =
        2 * std::numbers::pi_v<float> * static_cast<float>(i % sides) / static_cast<float>(sides);
    const float c = portable::cos(angle), s = portable::sin(angle);
    shape.positions.push_back({base_radius * c, base_y, base_radius * s});
    shape.positions.push_back({top_radius * c, top_y, top_radius * s});
    for (int twice = 0; twice < 2; ++twice) shape.normals.push_back(normalised({rise * c, slope, rise * s}));
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t b = 2 * i, t = b + 1, next_b = b + 2, next_t = b + 3;
    for (std::uint32_t v : {b, t, next_b}) shape.indices.push_back(v);
    if (top_radius > 0) {
      for (std::uint32_t v : {t, next_t, next_b}) shape.indices.push_back(v);
    }
  }
  return shape;
}

Shape disc(float radius, float y, std::uint32_t sides, bool faces_up) {
  Shape shape;
  shape.positions.push_back({0, y, 0});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
    shape.positions.push_back({radius * portable::cos(angle), y, radius * portable::sin(angle)});
    const std::uint32_t here = 1 + i, next = 1 + (i + 1) % sides;
    for (std::uint32_t v : {0u, faces_up ? next : here, faces_up ? here : next}) shape.indices.push_back(v);
  }
  shape.normals.assign(shape.positions.size(), {0, faces_up ? 1.0f : -1.0f, 0});
  return shape;
}

Shape box(const Box& extent) {
  const Vec3 &a = extent.min, &b = extent.max;
  Shape shape;
  const auto face = [&](const Vec3& normal, const std::array<Vec3, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(shape.positions.size());
    shape.positions.insert(shape.positions.end(), corners.begin(), corners.end());
    shape.normals.insert(shape.normals.end(), 4, normal);
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) shape.indices.push_back(first + corner);
  };
  face({-1, 0, 0}, {{{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}}});
  face({1, 0, 0}, {{{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}}});
  face({0, -1, 0}, {{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}});
  face({0, 1, 0}, {{{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}});
  face({0, 0, -1}, {{{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}}});
  face({0, 0, 1}, {{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}});
  return shape;
}

Shape card(float width, float height, float across, float up) {
  Shape shape;
  const float half = 0.5f * width;
  shape.positions = {{-half, 0, 0}, {half, 0, 0}, {half, height, 0}, {-half, height, 0}};
  shape.normals.assign(4, {0, 0, 1});
  shape.texture_coordinates = {{0, up}, {across, up}, {across, 0}, {0, 0}};
  shape.indices = {0, 1, 2, 0, 2, 3};
  return shape;
}

}  // namespace sightline::scene
