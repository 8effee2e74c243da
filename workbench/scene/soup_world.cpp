// Random triangles, as in Serpa, Serpa & Rodrigues, table 1, gathered into objects of neighbours.
#include <array>
#include <cmath>

#include "library/geometry/elementary.hpp"
#include "workbench/scene/random.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr std::array kSoupParameters{
    ParameterInfo{"triangles", "how many", "100000", 1, 50000000, true},
    ParameterInfo{"per-object", "triangles an object", "100", 1, 1000000, true},
    ParameterInfo{"size", "metres, the side of the cube", "200", 1, 100000},
    ParameterInfo{"edge", "metres, the reach of a triangle's corners from its centre", "1.5", 0.001, 1000},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

Vec3 plus(const Vec3& a, const Vec3& b, float scale) {
  return {a.x + scale * b.x, a.y + scale * b.y, a.z + scale * b.z};
}

Vec3 facing(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  const Vec3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  return length > 0 ? Vec3{n.x / length, n.y / length, n.z / length} : Vec3{0, 1, 0};
}

Scene make_soup(const Parameters& parameters) {
  const std::uint32_t triangles = parameters.count("triangles"), per_object = parameters.count("per-object");
  const float half = 0.5f * static_cast<float>(parameters.number("size"));
  const float edge = static_cast<float>(parameters.number("edge"));
  // Objects as large as their share of the cube, so that together they fill it evenly.
  const float reach =
      half * portable::cbrt(std::fmin(1.0f, static_cast<float>(per_object) / static_cast<float>(triangles)));
  Random random(parameters.count("seed"));
  Scene scene;
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t made = 0; made < triangles;) {
    positions.clear(), normals.clear(), indices.clear();
    const float room = half - reach;
    const Vec3 centre = random.inside({{-room, -room, -room}, {room, room, room}});
    for (std::uint32_t i = 0; i < per_object && made < triangles; ++i, ++made) {
      const Vec3 middle = random.inside({{-reach, -reach, -reach}, {reach, reach, reach}});
      const Vec3 a = plus(middle, random.direction(), edge), b = plus(middle, random.direction(), edge),
                 c = plus(middle, random.direction(), edge);
      const Vec3 normal = facing(a, b, c);
      for (const Vec3& corner : {a, b, c}) {
        indices.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(corner), normals.push_back(normal);
      }
    }
    scene.add_object(scene.add_mesh(positions, normals, indices), place(centre, 1));
  }
  scene.viewpoints.push_back({"near", {0, 0, 0}, {0, 0, -1}});
  scene.viewpoints.push_back({"far", {0, half, 3 * half}, {0, -0.3f, -1}});
  return scene;
}

}  // namespace

const WorldInfo kSoupWorld{"soup", "random triangles in a cube (Serpa et al.)", kSoupParameters, make_soup};

}  // namespace sightline::scene
