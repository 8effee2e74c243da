// native_rays VIEWS SIDE TRIANGLES FILE: the five models of strata of about so many triangles each (0: a
// hundredth of the paper's), and what SIDE × SIDE rays meet there from VIEWS viewpoints, the paper's first:
// what web/test/rays.test.mjs holds the package to. Little-endian numbers, in the order they are written
// below.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/worlds.hpp>

#include "library/geometry/elementary.hpp"
#include "library/rays/ray_grid.hpp"
#include "web/test/writer.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"

namespace {

using namespace sightline;

// Around the origin at the paper's distance; every other one from above, every third from within the model.
View view_from(std::uint32_t number) {
  const double around = 0.7 * number, up = number % 2 == 1 ? 0.6 : 0.0;
  const double far = number % 3 == 2 ? 5000 : 40000;
  const Vec3 eye{static_cast<float>(far * portable::cos(up) * portable::cos(around)),
                 static_cast<float>(far * portable::sin(up)),
                 static_cast<float>(far * portable::cos(up) * portable::sin(around))};
  const auto view = make_view({.eye = eye,
                               .forward = {-eye.x, -eye.y, -eye.z},
                               .vertical_fov = 0.8f,
                               .near_plane = 10,
                               .far_plane = 1e5f},
                              1280, 720);
  if (!view) std::fprintf(stderr, "%s\n", view.error().message()), std::exit(1);
  return *view;
}

void write_model(int number, const char* triangles, std::uint32_t views, std::uint32_t side,
                 web::Writer& out) {
  const Scene scene = generate_world("strata?model=" + std::to_string(number) + "&triangles=" + triangles);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < scene.size(); ++i) boxes.push_back(scene.bounds[i]);
  out.one(static_cast<std::uint32_t>(boxes.size()));
  out.all(boxes);
  rays::RayGrid grid;
  rays::RayHits hits;
  for (std::uint32_t v = 0; v < views; ++v) {
    const View view = view_from(v);
    grid.make(view, side, side);
    methods::cast_at_all_boxes(scene.bounds, grid.prepared, hits);
    out.one(view.world_to_eye.m), out.one(view.eye_to_clip.m);
    out.all(hits.object), out.all(hits.distance);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) return std::fprintf(stderr, "usage: native_rays VIEWS SIDE TRIANGLES FILE\n"), 2;
  std::FILE* file = std::fopen(arguments[4], "wb");
  if (!file) return std::perror(arguments[4]), 2;
  web::Writer out(file);
  const auto views = static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10));
  const auto side = static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 10));
  out.one(views), out.one(side);
  for (int model = 1; model <= 5; ++model) write_model(model, arguments[3], views, side, out);
  return std::fclose(file) == 0 && out.good() ? 0 : 1;
}
