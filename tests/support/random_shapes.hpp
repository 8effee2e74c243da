// Meshes of every kind, placed anyhow, and how many of them a test that looks at random ones looks at.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sightline/view.hpp>

#include "library/geometry/box_math.hpp"
#include "library/geometry/linear.hpp"
#include "support/occluder_meshes.hpp"
#include "support/rounds.hpp"

namespace sightline::test {

using Corners = std::array<Vec3, 3>;

inline Vec3 along(const Vec3& from, float by, const Vec3& way) {
  return {from.x + by * way.x, from.y + by * way.y, from.z + by * way.z};
}

inline constexpr Box kUnit{{-1, -1, -1}, {1, 1, 1}};

inline Vec3 around(scene::Random& random, const Vec3& middle, float farthest) {
  const Vec3 way = random.direction();
  return along(middle, random.between(0, farthest), way);
}

// A side of a box, cut in two again and again: corners lie on others' edges.
inline void cut_side(scene::Random& random, const Vec3& corner, const Vec3& u, const Vec3& v, int cuts,
                     scene::Shape& out) {
  if (cuts == 0 || random.below(6) == 0) {
    if (random.below(30) == 0) return;  // a hole
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    const Vec3 beside = along(corner, 1, u);
    out.positions.insert(out.positions.end(), {corner, beside, along(beside, 1, v), along(corner, 1, v)});
    for (const std::uint32_t k : {0, 1, 2, 0, 2, 3}) out.indices.push_back(first + k);
    return;
  }
  const float share = random.below(5) == 0 ? random.between(0.001f, 0.02f) : random.between(0.1f, 0.9f);
  const auto part = [](const Vec3& of, float by) { return Vec3{by * of.x, by * of.y, by * of.z}; };
  const bool across = random.below(2) == 0;
  const Vec3& way = across ? u : v;
  const Vec3 less = part(way, share), rest = part(way, 1 - share);
  cut_side(random, corner, across ? less : u, across ? v : less, cuts - 1, out);
  cut_side(random, along(corner, share, way), across ? rest : u, across ? v : rest, cuts - 1, out);
}

inline scene::Shape cut_walls(scene::Random& random, int cuts) {
  scene::Shape out;
  const Vec3 x{random.between(0.5f, 3), 0, 0}, y{0, random.between(0.5f, 3), 0},
      z{0, 0, random.between(0.5f, 3)};
  const Vec3 low{-x.x / 2, -y.y / 2, -z.z / 2}, high{x.x / 2, y.y / 2, z.z / 2};
  const auto back = [](const Vec3& v) { return Vec3{-v.x, -v.y, -v.z}; };
  cut_side(random, low, y, x, cuts, out), cut_side(random, low, z, y, cuts, out);
  cut_side(random, low, x, z, cuts, out), cut_side(random, high, back(x), back(y), cuts, out);
  cut_side(random, high, back(y), back(z), cuts, out), cut_side(random, high, back(z), back(x), cuts, out);
  return out;
}

// Triangles about a corner each, next to flat, some of them blades.
inline scene::Shape fans(scene::Random& random) {
  scene::Shape out;
  for (std::uint32_t fan = 1 + random.below(4); fan > 0; --fan) {
    const Vec3 centre = random.inside(kUnit);
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(centre);
    const float uneven = random.below(2) == 0 ? 0 : std::pow(10.0f, random.between(-7, -1));
    Vec3 u = random.direction(), v = random.direction();
    for (float turn = 0; turn < 5; turn += random.below(2) == 0 ? 0.04f : random.between(0.1f, 0.9f)) {
      const Vec3 flat = along(along(centre, std::cos(turn), u), std::sin(turn), v);
      out.positions.push_back(along(flat, uneven, random.direction()));
    }
    for (std::uint32_t i = first + 1; i + 1 < out.positions.size(); ++i)
      out.indices.insert(out.indices.end(), {first, i, i + 1});
  }
  return out;
}

// Ground with steps, holes and triangles that are turned over.
inline scene::Shape uneven_ground(scene::Random& random) {
  const std::uint32_t steps = 2 + random.below(5);
  const float rise = random.below(2) == 0 ? 0.2f : random.between(0, 3);
  scene::Shape out = surface(steps, steps, false, false, [&](float u, float v) {
    return Vec3{2 * u - 1, random.between(-rise, rise), 1 - 2 * v};
  });
  for (std::size_t i = 0; i < out.indices.size(); i += 3) {
    const std::uint32_t which = random.below(14);
    if (which == 0) std::swap(out.indices[i + 1], out.indices[i + 2]);
    if (which == 1) out.indices[i] = out.indices[i + 1];
  }
  return out;
}

inline scene::Shape loose(scene::Random& random) {
  const std::uint32_t corners = 4 + random.below(24), triangles = 2 + random.below(40);
  return loose_triangles(random, corners, triangles);
}

// Boxes that overlap, touch and share sides.
inline scene::Shape boxes(scene::Random& random) {
  scene::Shape out;
  const auto on_grid = [](float x) { return std::round(4 * x) / 4; };
  for (std::uint32_t box = 1 + random.below(4); box > 0; --box) {
    const Vec3 at = random.inside(kUnit), size = random.inside({{0.3f, 0.3f, 0.3f}, {1, 1, 1}});
    const Vec3 low{on_grid(at.x), on_grid(at.y), on_grid(at.z)};
    out.append(fine_box({low, {low.x + on_grid(size.x), low.y + on_grid(size.y), low.z + on_grid(size.z)}},
                        1 + random.below(2)));
  }
  return out;
}

// A wall of strips, each cut into triangles as if alone, so that corners lie on the edges of others, many
// close together; some triangles lost, some turned over.
inline scene::Shape strips(scene::Random& random) {
  std::vector<float> favourites(6);
  for (float& x : favourites) x = random.between(0.05f, 0.95f);
  const auto row = [&] {
    std::vector<float> out{0, 1};
    for (std::uint32_t left = random.below(7); left > 0; --left) {
      const float near = favourites[random.below(6)], apart = random.between(-0.01f, 0.01f);
      const std::uint32_t kind = random.below(4);
      out.push_back(kind == 0   ? near
                    : kind == 1 ? near + apart
                    : kind == 2 ? near + apart / 10
                                : random.unit());
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  scene::Shape out;
  float low = 0;
  for (std::uint32_t left = 2 + random.below(6); left > 0; --left) {
    const float high = low + (random.below(4) == 0 ? 0.02f : random.between(0.05f, 0.3f));
    const std::vector<float> below = row(), above = row();
    for (std::size_t b = 0, a = 0; b + 1 < below.size() || a + 1 < above.size();) {
      const bool up = b + 1 == below.size() || (a + 1 < above.size() && random.below(2) == 0);
      const Vec3 third = up ? Vec3{above[a + 1], high, 0} : Vec3{below[b + 1], low, 0};
      const auto first = static_cast<std::uint32_t>(out.positions.size());
      out.positions.insert(out.positions.end(), {{below[b], low, 0}, {above[a], high, 0}, third});
      const std::uint32_t harm = random.below(16);
      if (harm > 1) out.indices.insert(out.indices.end(), {first, first + 2, first + 1});
      if (harm == 1) out.indices.insert(out.indices.end(), {first, first + 1, first + 2});
      ++(up ? a : b);
    }
    low = high;
  }
  return out;
}

inline scene::Shape any_shape(scene::Random& random) {
  switch (random.below(6)) {
    case 0:
      return cut_walls(random, 1 + static_cast<int>(random.below(4)));
    case 1:
      return fans(random);
    case 2:
      return uneven_ground(random);
    case 3:
      return loose(random);
    case 4:
      return boxes(random);
    default:
      return scene::sphere(1 + random.below(2));
  }
}

// Turned, stretched, mirrored and moved, if at all.
inline Mat4 any_placement(scene::Random& random) {
  if (random.below(2) == 0) return {};
  const Vec3 p = random.direction(), q = random.direction();
  const glm::dvec3 x(p.x, p.y, p.z), z = glm::normalize(glm::cross(x, glm::dvec3(q.x, q.y, q.z))),
                                     y = glm::cross(z, x);
  const double sx = random.between(0.3f, 3), sy = random.between(0.3f, 3), sz = random.below(3) == 0 ? -1 : 1;
  const Vec3 to = random.inside({{-5, -5, -5}, {5, 5, 5}});
  return geometry::to_mat4(glm::dmat4(glm::dvec4(sx * x, 0), glm::dvec4(sy * y, 0), glm::dvec4(sz * z, 0),
                                      glm::dvec4(to.x, to.y, to.z, 1)));
}

/// A shape's triangles where they stand, rounded once as a world and a buffer round them, counter-clockwise
/// where one sees their fronts.
inline std::vector<Corners> placed(const scene::Shape& shape, const Mat4& placement) {
  const bool in_place = placement == Mat4{};
  const geometry::ExactAffine its = geometry::exact_affine(placement);
  const bool mirrored = glm::determinant(glm::dmat3(geometry::to_double(placement))) < 0;
  std::vector<Corners> out;
  for (std::size_t i = 0; i < shape.indices.size(); i += 3) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = shape.positions[shape.indices[i + k]];
      corners[k] = in_place ? p : geometry::to_vec3(its.linear * geometry::to_double(p) + its.translation);
    }
    if (mirrored) std::swap(corners[1], corners[2]);
    out.push_back(corners);
  }
  return out;
}

inline Box bounds_of(std::span<const Corners> triangles) {
  Box out = geometry::kEmptyBox;
  for (const Corners& corners : triangles)
    for (const Vec3& p : corners) out = geometry::united(out, {p, p});
  return out;
}

/// Whether a view looks at the triangle's front, or along it.
inline bool shows_front(const View& view, const Corners& t) {
  const glm::dvec3 a = geometry::to_double(t[0]),
                   n = glm::cross(geometry::to_double(t[1]) - a, geometry::to_double(t[2]) - a);
  return is_orthographic(view) ? glm::dot(n, geometry::to_double(view_direction(view))) <= 0
                               : glm::dot(n, geometry::eye_of(view) - a) >= 0;
}

/// Looks at random scenes until one fails: how many, unless SIGHTLINE_RANDOM_SCENES says, from
/// SIGHTLINE_RANDOM_SEED on. Returns how many it were to be.
template <class Look>
std::uint64_t for_random_scenes(std::uint64_t usual, const Look& look) {
  const std::uint64_t scenes = number_in("SIGHTLINE_RANDOM_SCENES", usual),
                      first = number_in("SIGHTLINE_RANDOM_SEED", 1);
  for (std::uint64_t seed = first; seed < first + scenes && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    scene::Random random(seed);
    look(random);
  }
  return scenes;
}

}  // namespace sightline::test
