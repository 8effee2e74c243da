// Triangles of every awkward kind, for tests of partitions and of the methods on them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::test {

using Triangle = std::array<Vec3, 3>;

inline Triangle random_triangle(scene::Random& random, const Box& around, float edge) {
  const Vec3 at = random.inside(around);
  Triangle out;
  for (Vec3& corner : out) {
    const Vec3 way = random.direction();
    corner = {at.x + edge * way.x, at.y + edge * way.y, at.z + edge * way.z};
  }
  return out;
}

/// Five triangles an object; every seventh object transparent.
inline Scene scene_of(const std::vector<Triangle>& triangles) {
  Scene scene;
  scene.name = "test";
  for (std::size_t first = 0; first < triangles.size(); first += 5) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (std::size_t t = first; t < std::min(first + 5, triangles.size()); ++t) {
      for (const Vec3& corner : triangles[t]) {
        indices.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(corner);
      }
    }
    const std::vector<Vec3> normals(positions.size(), Vec3{0, 1, 0});
    scene.add_object(scene.add_mesh(positions, normals, indices), {},
                     first / 5 % 7 == 6 ? Surface::transparent : Surface::opaque);
  }
  return scene;
}

struct Awkward {
  std::string name;
  std::vector<Triangle> triangles;
};

/// Small and large ones mixed, all on one plane, points and lines, one as large as the scene, each thrice,
/// all on the planes at which cells are cut, and a single one.
inline std::vector<Awkward> awkward_triangles() {
  scene::Random random(41);
  constexpr Box kRoom{{-50, -20, -50}, {50, 20, 50}};
  std::vector<Awkward> cases(7);
  cases[0].name = "mixed";
  for (int i = 0; i < 1500; ++i)
    cases[0].triangles.push_back(random_triangle(random, kRoom, i % 10 == 0 ? 15.0f : 0.8f));
  cases[1].name = "flat";
  for (int i = 0; i < 800; ++i) {
    Triangle t = random_triangle(random, kRoom, 2);
    for (Vec3& corner : t) corner.y = 3;
    cases[1].triangles.push_back(t);
  }
  cases[2].name = "degenerate";
  for (int i = 0; i < 600; ++i) {
    Triangle t = random_triangle(random, kRoom, 2);
    if (i % 3 == 0) t[1] = t[0], t[2] = t[0];
    if (i % 3 == 1) t[2] = {0.5f * (t[0].x + t[1].x), 0.5f * (t[0].y + t[1].y), 0.5f * (t[0].z + t[1].z)};
    cases[2].triangles.push_back(t);
  }
  cases[3].name = "one_as_large_as_the_scene";
  cases[3].triangles.push_back({Vec3{-50, -20, -50}, Vec3{50, 20, -50}, Vec3{0, 0, 50}});
  for (int i = 0; i < 500; ++i) cases[3].triangles.push_back(random_triangle(random, kRoom, 1));
  cases[4].name = "duplicated";
  for (int i = 0; i < 200; ++i) {
    const Triangle t = random_triangle(random, kRoom, 2);
    cases[4].triangles.insert(cases[4].triangles.end(), 3, t);
  }
  cases[5].name = "on_the_cuts";
  for (int x = -8; x <= 8; ++x) {
    for (int z = -8; z < 8; ++z) {
      const auto at = static_cast<float>(4 * x), side = static_cast<float>(4 * z);
      cases[5].triangles.push_back({Vec3{at, 0, side}, Vec3{at, 4, side}, Vec3{at, 0, side + 4}});
      cases[5].triangles.push_back({Vec3{side, 0, at}, Vec3{side + 4, 0, at}, Vec3{side, 4, at}});
    }
  }
  cases[6].name = "single";
  cases[6].triangles.push_back({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}});
  return cases;
}

}  // namespace sightline::test
