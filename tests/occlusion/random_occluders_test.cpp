// Occluders made of random meshes, wherever they lie: what one covers its mesh covers, by rays in double
// precision to points of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <sightline/occluder.hpp>

#include "support/random_shapes.hpp"

namespace sightline {
namespace {

using glm::dvec3;

struct RandomMesh {
  scene::Shape shape;
  std::vector<Sides> sides;  // one a triangle
};

// Closed about an axis, or open at its ends: tubes, domes, bowls.
scene::Shape about_axis(scene::Random& random) {
  const bool closed = random.below(2) == 0;
  const std::uint32_t rows = 2 + random.below(12);
  const float waves = random.between(0, 6), swell = random.between(0, 0.5f), height = random.between(0.3f, 3);
  std::vector<Vec3> profile;
  for (std::uint32_t row = 0; row <= rows; ++row) {
    const float v = static_cast<float>(row) / static_cast<float>(rows);
    const bool pole = closed && (row == 0 || row == rows);
    profile.push_back({pole ? 0 : 1 + swell * std::sin(waves * v), height * v, 0});
  }
  return test::turned(3 + random.below(20), profile);
}

scene::Shape some_shape(scene::Random& random) {
  switch (random.below(4)) {
    case 0:
      return about_axis(random);
    case 1: {
      const std::vector<test::NamedMesh> open = test::open_meshes();
      return open[random.below(static_cast<std::uint32_t>(open.size()))].shape;
    }
    default:
      return test::any_shape(random);
  }
}

// A few shapes beside and within one another; some triangles lost, turned over and doubled; of any size, and
// any distance from 0.
RandomMesh some_mesh(scene::Random& random) {
  RandomMesh out;
  for (std::uint32_t left = 1 + random.below(3); left > 0; --left) {
    const Vec3 at = random.inside({{-2, -2, -2}, {2, 2, 2}});
    out.shape.append(test::moved(some_shape(random), [&](const Vec3& p) { return test::along(p, 1, at); }));
  }
  std::vector<std::uint32_t>& indices = out.shape.indices;
  const auto triangles = [&] { return static_cast<std::uint32_t>(indices.size() / 3); };
  const std::uint32_t harm = random.below(6);
  for (std::uint32_t left = 1 + random.below(4); left > 0 && harm < 3 && triangles() > 1; --left) {
    const auto from = indices.begin() + 3 * random.below(triangles());
    if (harm == 0) indices.erase(from, from + 3);
    if (harm == 1) std::swap(from[0], from[1]);
    if (harm == 2) indices.insert(indices.end(), {from[2], from[1], from[0]});
  }
  const float scale = random.below(3) == 0 ? std::pow(10.0f, random.between(-6, 6)) : 1;
  const float away = random.below(3) == 0 ? scale * std::pow(10.0f, random.between(0, 4)) : 0;
  out.shape = test::moved(std::move(out.shape), [&](const Vec3& p) {
    return Vec3{scale * p.x + away, scale * p.y, scale * p.z - away / 3};
  });
  const std::uint32_t fronts = random.below(3);
  for (std::uint32_t i = 0; i < triangles(); ++i)
    out.sides.push_back(fronts > random.below(2) ? Sides::front : Sides::both);
  return out;
}

struct Face {
  dvec3 a, b, c;
  bool both;

  [[nodiscard]] dvec3 normal() const { return glm::cross(b - a, c - a); }
  [[nodiscard]] bool shows(const dvec3& way) const { return both || glm::dot(normal(), way) < 0; }
};

std::vector<Face> faces_of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                           std::span<const Sides> sides) {
  std::vector<Face> out;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto at = [&](std::size_t k) { return geometry::to_double(positions[indices[3 * i + k]]); };
    out.push_back({at(0), at(1), at(2), sides[i] == Sides::both});
  }
  return out;
}

std::vector<Face> faces_of(const Occluder& made) {
  std::vector<Face> out = faces_of(made.positions, made.indices, made.sides);
  for (const Box& box : made.boxes) {
    const scene::Shape shape = test::fine_box(box, 1);
    const std::vector<Sides> front(shape.indices.size() / 3, Sides::front);
    for (const Face& t : faces_of(shape.positions, shape.indices, front)) out.push_back(t);
  }
  return out;
}

// How far along `way` the triangle lies, from the eye on.
double hit(const Face& t, const dvec3& eye, const dvec3& way) {
  constexpr double kOutside = 1e-9;
  const dvec3 u = t.b - t.a, v = t.c - t.a, h = glm::cross(way, v), from = eye - t.a, q = glm::cross(from, u);
  const double det = glm::dot(u, h), x = glm::dot(from, h) / det, y = glm::dot(way, q) / det,
               at = glm::dot(v, q) / det;
  const bool in = x >= -kOutside && y >= -kOutside && x + y <= 1 + kOutside && at > 0;
  return in ? at : std::numeric_limits<double>::infinity();
}

double distance(const Face& t, const dvec3& p) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : {std::pair(t.a, t.b), {t.b, t.c}, {t.c, t.a}}) {
    const dvec3 edge = b - a;
    const double length2 = glm::dot(edge, edge),
                 along = length2 > 0 ? std::clamp(glm::dot(p - a, edge) / length2, 0.0, 1.0) : 0;
    out = std::min(out, glm::distance(p, a + along * edge));
  }
  const dvec3 n = t.normal();
  if (n == dvec3(0)) return out;
  const double off = glm::dot(p - t.a, glm::normalize(n));
  return hit(t, p + n, -2.0 * n) < 1 ? std::min(out, std::fabs(off)) : out;
}

struct Extent {
  dvec3 middle;
  double radius, largest;  // coordinate
};

Extent extent_of(const scene::Shape& shape) {
  dvec3 low(1e300), high(-1e300);
  for (const std::uint32_t i : shape.indices) {
    const dvec3 p = geometry::to_double(shape.positions[i]);
    low = glm::min(low, p), high = glm::max(high, p);
  }
  const dvec3 most = glm::max(glm::abs(low), glm::abs(high));
  return {(low + high) / 2.0, glm::distance(low, high) / 2, std::max({most.x, most.y, most.z})};
}

// A point of a triangle, as often as not next to an edge.
dvec3 some_point(scene::Random& random, const Face& t) {
  double u = random.between(0.001f, 0.998f), v = random.between(0.001f, 0.998f);
  if (u + v > 0.999) u = 0.999 - u, v = 0.999 - v;
  if (random.below(2) == 0) u = 0.001;
  return t.a + std::max(u, 0.0) * (t.b - t.a) + std::max(v, 0.0) * (t.c - t.a);
}

// Rounded positions lie so far beside the places that were meant, of the largest coordinate.
constexpr double kRounding = 4.5e-7;

struct Seen {
  std::size_t rays = 0, solid = 0, flat = 0, boxes = 0;
};

void look(scene::Random& random, Seen& seen) {
  const RandomMesh mesh = some_mesh(random);
  OccluderOptions options;
  if (random.below(3) == 0) options = {4u << random.below(5), random.below(9)};
  if (random.below(2) == 0) options.most_triangles = 4096;  // mostly whole, which takes less time
  const auto made = make_occluder(mesh.shape.positions, mesh.shape.indices, mesh.sides, options);
  ASSERT_TRUE(made) << made.error().message();
  seen.solid += made->solid_triangles > 0, seen.boxes += !made->boxes.empty();
  seen.flat += made->sides.size() > made->solid_triangles;
  const std::vector<Face> occluder = faces_of(*made),
                          truth = faces_of(mesh.shape.positions, mesh.shape.indices, mesh.sides);
  if (occluder.empty()) return;
  const Extent extent = extent_of(mesh.shape);
  for (int ray = 0; ray < 60; ++ray) {
    const Face& t = occluder[random.below(static_cast<std::uint32_t>(occluder.size()))];
    const dvec3 p = some_point(random, t),
                eye = extent.middle + geometry::to_double(random.direction()) *
                                          (extent.radius * double{random.between(1.01f, 6)}),
                way = p - eye;
    const double sine = std::fabs(glm::dot(t.normal(), way)) / (glm::length(t.normal()) * glm::length(way));
    if (!t.shows(way) || !(sine > 1e-3)) continue;
    ++seen.rays;
    const auto least = [&](const auto& of) {
      double out = std::numeric_limits<double>::infinity();
      for (const Face& other : truth)
        if (other.shows(way)) out = std::min(out, of(other));
      return out;
    };
    const double slack = (2e-6 * extent.largest + 1e-6 * extent.radius) / (sine * glm::length(way));
    if (least([&](const Face& other) { return hit(other, eye, way); }) <= 1 + slack) continue;
    const double beside = least([&](const Face& other) { return distance(other, p); }) / extent.largest;
    ASSERT_LE(beside, kRounding) << "covers what is not the mesh so far away, of its largest coordinate";
  }
}

TEST(RandomOccluders, CoverNothingButTheirMeshes) {
  Seen seen;
  const auto meshes = test::for_random_scenes(20, [&](scene::Random& random) { look(random, seen); });
  if (meshes < 20) return;
  EXPECT_GT(seen.rays, 20 * meshes);
  EXPECT_GT(seen.solid, meshes / 10);
  EXPECT_GT(seen.flat, meshes / 3);
  EXPECT_GT(seen.boxes, meshes / 20);
}

}  // namespace
}  // namespace sightline
