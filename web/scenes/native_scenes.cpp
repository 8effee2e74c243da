// native_scenes VIEWS FILE WORLD…: generated worlds with the occluders that the library makes of their
// meshes, and who is visible in truth from random views: objects that a ray through some pixel's centre meets
// first, in double precision too. What web/test/scenes.test.mjs holds the package's occlusion to.
// Little-endian numbers, in the order they are written below.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/view.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "web/test/writer.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"
#include "workbench/oracle/embree_judge.hpp"

namespace {

using namespace sightline;

constexpr std::uint32_t kWidth = 256, kHeight = 144;

template <class T>
void write_counted(const std::vector<T>& values, web::Writer& out) {
  out.one(static_cast<std::uint32_t>(values.size()));
  out.all(values);
}

// As an occluder of the package: a round mesh by the sphere inside it. False where it makes none.
bool write_occluder(const Scene& scene, const Mesh& mesh, Sides sides, web::Writer& out) {
  const auto positions = std::span(scene.positions).subspan(mesh.first_vertex, mesh.vertex_count);
  const auto indices = std::span(scene.indices).subspan(mesh.first_index, mesh.index_count);
  Occluder made;
  std::vector<Sphere> spheres;
  if (const auto sphere = methods::inner_sphere(positions, indices, sides)) {
    spheres.push_back(*sphere);
  } else {
    made = or_throw(make_occluder(positions, indices, {&sides, 1}));
  }
  write_counted(made.positions, out), write_counted(made.indices, out), write_counted(made.sides, out);
  out.one(static_cast<std::uint32_t>(made.solid_triangles));
  write_counted(made.boxes, out), write_counted(spheres, out);
  return !spheres.empty() || !made.indices.empty() || !made.boxes.empty();
}

// Two a mesh, by its sides; then which of them each object carries, and where.
void write_occluders(const Scene& scene, web::Writer& out) {
  std::vector<std::uint8_t> hides;
  out.one(static_cast<std::uint32_t>(2 * scene.meshes.size()));
  for (const Mesh& mesh : scene.meshes) {
    for (const Sides sides : {Sides::both, Sides::front})
      hides.push_back(write_occluder(scene, mesh, sides, out));
  }
  std::vector<ObjectId> carriers;
  std::vector<std::uint32_t> occluders;
  std::vector<Mat4> transforms;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const std::uint32_t occluder = 2 * scene.mesh[o] + (scene.sides[o] == Sides::front);
    if (scene.surface[o] != Surface::opaque || !hides[occluder]) continue;
    carriers.push_back(o), occluders.push_back(occluder);
    transforms.push_back(to_matrix(scene.transform[o]));
  }
  write_counted(carriers, out);
  out.all(occluders), out.all(transforms);
}

void write_views(const Scene& scene, std::uint32_t count, web::Writer& out) {
  const oracle::EmbreeJudge judge(scene);
  out.one(count);
  for (const Camera& camera : camera::random_cameras(scene, count, 1)) {
    const View view = or_throw(make_view(camera, kWidth, kHeight));
    const oracle::ItemBuffer truth = judge.render(view);
    std::vector<ObjectId> seen, sure;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      if (truth.sees(o)) seen.push_back(o);
    }
    const std::vector<std::uint32_t> pixels = judge.confirmed_pixels(view, truth, seen);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (pixels[i] > 0) sure.push_back(seen[i]);
    }
    out.one(WorldView{view, {}});
    write_counted(sure, out);
  }
}

void write_scene(const char* name, std::uint32_t views, web::Writer& out) {
  const Scene scene = generate_world(name);
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < scene.size(); ++o) boxes.push_back(scene.bounds[o]);
  write_counted(boxes, out);
  write_occluders(scene, out);
  write_views(scene, views, out);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) return std::fprintf(stderr, "usage: native_scenes VIEWS FILE WORLD...\n"), 2;
  std::FILE* file = std::fopen(arguments[2], "wb");
  if (!file) return std::perror(arguments[2]), 2;
  web::Writer out(file);
  const auto views = static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10));
  out.one(static_cast<std::uint32_t>(count - 3));
  try {
    for (int i = 3; i < count; ++i) write_scene(arguments[i], views, out);
  } catch (const Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
  return std::fclose(file) == 0 && out.good() ? 0 : 1;
}
