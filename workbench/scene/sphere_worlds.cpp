// The two worlds of Lee & Shin 2023, section 4: 9,024 spheres, evenly and unevenly laid out.
#include <algorithm>
#include <array>
#include <cmath>

#include <sightline/workbench/error.hpp>

#include "library/geometry/elementary.hpp"
#include "workbench/scene/random.hpp"
#include "workbench/scene/shapes.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr float kEyeHeight = 1.6f;

constexpr ParameterInfo kDetail{"detail", "subdivisions of each sphere: 20·4^detail triangles", "3", 0, 6,
                                true};
constexpr ParameterInfo kSeed{"seed", "of the random numbers", "1", 0, 4294967295.0, true};

constexpr const char *kColumns = "94", *kRows = "96";
constexpr const char* kByRows = "columns x rows";
constexpr std::array kRegularParameters{
    ParameterInfo{"spheres", "how many, in a square whose last row may be short; without columns and rows",
                  kByRows, 1, 4000000, true},
    ParameterInfo{"columns", "spheres along x", kColumns, 1, 4096, true},
    ParameterInfo{"rows", "spheres along z", kRows, 1, 4096, true},
    ParameterInfo{"spacing", "metres between centres; the radius is 1", "2.5", 0.1, 1000},
    kDetail,
};

constexpr std::array kIrregularParameters{
    ParameterInfo{"spheres", "how many", "9024", 1, 4000000, true},
    ParameterInfo{"size", "metres, the side of the square they stand on", "240", 10, 100000},
    kDetail,
    kSeed,
};

std::uint32_t add_sphere_mesh(Scene& scene, const Parameters& parameters) {
  const Shape shape = sphere(parameters.count("detail"));
  return scene.add_mesh(shape.positions, shape.normals, shape.indices);
}

// The paper's two cameras: near the ground before the spheres, and far above, looking down on all of them.
void add_viewpoints(Scene& scene) {
  const Box all = extent(scene);
  const float x = 0.5f * (all.min.x + all.max.x), z = 0.5f * (all.min.z + all.max.z);
  const float width = std::fmax(all.max.x - all.min.x, all.max.z - all.min.z);
  scene.viewpoints.push_back({"near", {x, kEyeHeight, all.max.z + 0.02f * width}, {0.05f, 0, -1}});
  scene.viewpoints.push_back({"far", {x, 0.75f * width, z + 0.9f * width}, {0, -0.75f, -0.9f}});
}

struct RegularGrid {
  std::uint32_t columns, rows, spheres;
};

RegularGrid regular_grid(const Parameters& parameters) {
  const std::uint32_t columns = parameters.count("columns"), rows = parameters.count("rows");
  if (parameters.word("spheres") == kByRows) return {columns, rows, columns * rows};
  if (parameters.word("columns") != kColumns || parameters.word("rows") != kRows) {
    throw Error("world 'regular': 'spheres' goes without 'columns' and 'rows', expected one or the others");
  }
  const std::uint32_t spheres = parameters.count("spheres");
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(spheres)));
  return {side, (spheres + side - 1) / side, spheres};
}

Scene make_regular(const Parameters& parameters) {
  const auto [columns, rows, spheres] = regular_grid(parameters);
  const float spacing = static_cast<float>(parameters.number("spacing"));
  Scene scene;
  const std::uint32_t mesh = add_sphere_mesh(scene, parameters);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const float x = spacing * (static_cast<float>(column) - 0.5f * static_cast<float>(columns - 1));
      const float z = spacing * (static_cast<float>(row) - 0.5f * static_cast<float>(rows - 1));
      if (scene.size() < spheres) scene.add_object(mesh, place({x, 1, z}, 1));
    }
  }
  add_viewpoints(scene);
  return scene;
}

// Shapes of overlapping spheres, walls and mounds, with loners strewn between them.
Scene make_irregular(const Parameters& parameters) {
  const std::uint32_t count = parameters.count("spheres");
  const float size = static_cast<float>(parameters.number("size")), half = 0.5f * size;
  Random random(parameters.count("seed"));
  Scene scene;
  const std::uint32_t mesh = add_sphere_mesh(scene, parameters);
  const Box ground{{-half, 0, -half}, {half, 0, half}};
  while (scene.size() < count) {
    const auto left = static_cast<std::uint32_t>(count - scene.size());
    const std::uint32_t kind = random.below(4);
    const Vec3 start = random.inside(ground);
    if (kind == 0) {
      const float radius = portable::exp(random.between(portable::log(0.15f), portable::log(2.5f)));
      scene.add_object(mesh, place({start.x, radius, start.z}, radius));
      continue;
    }
    const std::uint32_t members = std::min(left, 20 + random.below(180));
    const float heading = random.between(0, 2 * std::numbers::pi_v<float>);
    const float reach = random.between(2, 12), height = random.between(2, 10);
    for (std::uint32_t i = 0; i < members; ++i) {
      const float radius = random.between(0.3f, 1.6f);
      const float along = random.between(-reach, reach), up = random.unit();
      const float across = kind == 1 ? random.between(-0.5f, 0.5f)                // a wall
                                     : random.between(-reach, reach) * (1 - up);  // a mound
      const float narrowed = kind == 1 ? along : along * (1 - up);
      const Vec3 at{start.x + narrowed * portable::cos(heading) - across * portable::sin(heading),
                    radius + up * height,
                    start.z + narrowed * portable::sin(heading) + across * portable::cos(heading)};
      scene.add_object(mesh, place(at, radius));
    }
  }
  add_viewpoints(scene);
  return scene;
}

}  // namespace

const WorldInfo kRegularWorld{"regular", "equal spheres, evenly spaced (Lee & Shin 2023)", kRegularParameters,
                              make_regular};
const WorldInfo kIrregularWorld{"irregular",
                                "spheres of uneven size and density, overlapping (Lee & Shin 2023)",
                                kIrregularParameters, make_irregular};

}  // namespace sightline::scene
