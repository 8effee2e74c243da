#include "workbench/reproduce/vertex_chunk/vertex_chunk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "library/world/chunk_map.hpp"
#include "workbench/reproduce/vertex_chunk/vertex_chunk_pictures.hpp"

namespace sightline::reproduce {

namespace {

// One contribution test for all that have one, as in the paper; then ours.
constexpr std::array kCulling{"vfc-vc",
                              "roc",
                              "hroc",
                              "vertex-chunk",
                              "resident-chunk",
                              "hiz",
                              "hroc?leaf=boxes",
                              "ioc",
                              "ihzb",
                              "vertex-chunk?faces=facing"};
constexpr std::size_t kChunk = 4;  // after none

std::vector<std::string> methods() {
  std::vector<std::string> all{"none"};
  for (const std::string name : kCulling)
    all.push_back(name + (name.find('?') != name.npos ? "&" : "?") + "contribution=area");
  return all;
}

Vec3 turned(const Vec3& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {static_cast<float>(c * v.x - s * v.z), v.y, static_cast<float>(s * v.x + c * v.z)};
}

// Near the ground in the middle of the world, where nothing stands close by: a quarter of the world is in
// view, as the paper's figures imply.
Camera near_camera(const Scene& scene) {
  const Box all = extent(scene);
  Camera camera;
  camera.eye = {0.5f * (all.min.x + all.max.x), 1.6f, 0.5f * (all.min.z + all.max.z)};
  camera.forward = {0.05f, 0, -1};
  const auto free = [&](const Vec3& eye) {
    constexpr float kClearance = 0.2f;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      const Sphere s = scene.sphere(o);
      const float x = eye.x - s.centre.x, y = eye.y - s.centre.y, z = eye.z - s.centre.z;
      if (std::sqrt(x * x + y * y + z * z) < s.radius + kClearance) return false;
    }
    return true;
  };
  const Vec3 middle = camera.eye;
  // Outwards on a spiral until there is room.
  for (int step = 0; step < 1000 && !free(camera.eye); ++step) {
    const float angle = 2.4f * static_cast<float>(step), radius = 0.25f * std::sqrt(static_cast<float>(step));
    camera.eye = {middle.x + radius * std::cos(angle), middle.y, middle.z + radius * std::sin(angle)};
  }
  return camera;
}

Camera far_camera(const Scene& scene) {
  Camera camera;
  for (const Viewpoint& viewpoint : scene.viewpoints) {
    if (viewpoint.name != "far") continue;
    camera.eye = viewpoint.eye;
    camera.forward = viewpoint.forward;
  }
  return camera;
}

// Headings a right angle apart from the near view's eye.
camera::CameraPath near_path(const Scene& scene, int views) {
  camera::CameraPath path{"near", {}};
  for (int k = 0; k < views; ++k) {
    Camera camera = near_camera(scene);
    camera.forward = turned(camera.forward, k * std::numbers::pi / 2);
    path.cameras.push_back(camera);
  }
  return path;
}

// The far view from as many sides.
camera::CameraPath far_path(const Scene& scene, int views) {
  const Box all = extent(scene);
  const Vec3 middle{0.5f * (all.min.x + all.max.x), 0, 0.5f * (all.min.z + all.max.z)};
  camera::CameraPath path{"far", {}};
  for (int k = 0; k < views; ++k) {
    const double angle = k * std::numbers::pi / 2;
    Camera camera = far_camera(scene);
    const Vec3 eye = turned({camera.eye.x - middle.x, camera.eye.y, camera.eye.z - middle.z}, angle);
    camera.eye = {eye.x + middle.x, eye.y, eye.z + middle.z};
    camera.forward = turned(camera.forward, angle);
    path.cameras.push_back(camera);
  }
  return path;
}

// Straight up from the near view to the far one's height, the head bowed as far as the far view's.
camera::CameraPath rising_path(const Scene& scene, std::size_t views) {
  const Camera low = near_camera(scene), high = far_camera(scene);
  const double across = std::hypot(high.forward.x, high.forward.z);
  const double bowed = std::atan2(-high.forward.y, across);
  camera::CameraPath path{"rising", {}};
  for (std::size_t i = 0; i < views; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(views - 1);
    Camera camera = low;
    camera.eye.y = static_cast<float>(low.eye.y + t * (high.eye.y - low.eye.y));
    camera.forward.y = static_cast<float>(-std::tan(t * bowed) * std::hypot(low.forward.x, low.forward.z));
    path.cameras.push_back(camera);
  }
  return path;
}

ChunkCounts count_chunks(const Scene& scene) {
  constexpr std::uint32_t kDepth = 3;  // as the paper's
  world::ChunkMap map({extent(scene), kDepth});
  map.insert_all(scene.bounds);
  ChunkCounts counts;
  for (std::uint32_t chunk = 0; chunk < map.chunk_limit(); ++chunk) {
    const std::size_t objects = map.chunk(chunk).count;
    if (objects == 0) continue;
    const bool shared = map.chunk_regions(chunk).shared();
    ++counts.chunks, counts.shared_chunks += shared;
    counts.objects += objects, counts.shared_objects += shared ? objects : 0;
    counts.fullest = std::max(counts.fullest, objects);
  }
  return counts;
}

// Counting takes time, so the methods that count are others than those that are timed.
measure::Comparison count_rays(device::Device& device, Scene& scene, const Camera& near,
                               measure::MeasureOptions options) {
  const std::vector<std::string> counting{"hroc?count=on&contribution=area",
                                          "hroc?leaf=boxes&count=on&contribution=area"};
  measure::Bench bench(scene, counting, &device);
  options.warm_up = 2, options.repeats = 1, options.timed_passes = 0;
  return measure::compare(bench, {"near", {near}}, options);
}

}  // namespace

Scene vertex_chunk_scene(const std::string& world, bool quick) {
  return generate_world(fmt::format("{}?detail={}", world, quick ? 1 : 3));
}

VertexChunkWorld measure_vertex_chunk(device::Device& device, const std::string& name,
                                      const VertexChunkOptions& options, const Progress& progress) {
  Scene scene = vertex_chunk_scene(name, options.quick);
  measure::Bench bench(scene, methods(), &device);
  measure::MeasureOptions measure;
  measure.width = options.quick ? 640 : 1280;
  measure.height = options.quick ? 360 : 720;
  measure.repeats = measure.timed_passes = 15;
  VertexChunkWorld world;
  world.name = name;
  world.chunks = count_chunks(scene);
  const int views = options.quick ? 2 : 4;
  const camera::CameraPath near = near_path(scene, views);
  world.near = measure::compare(bench, {"near", {near.cameras.front()}}, measure);
  const View view = or_throw(make_view(near.cameras.front(), measure.width, measure.height));
  world.counted = count_rays(device, scene, near.cameras.front(), measure);
  world.passes = bench.run(bench.subjects()[kChunk], view, device::Timed::passes).passes;
  // The camera rises from where it is; after a change of view it takes two frames until what was marked in
  // vain is gone.
  measure.warm_up = 2;
  measure.repeats = 1, measure.timed_passes = 0;
  world.rising = measure::compare(bench, rising_path(scene, options.quick ? 5 : 12), measure, progress);
  measure.repeats = options.quick ? 3 : 7;
  world.near_views = measure::compare(bench, near, measure, progress);
  measure.repeats = 3;  // a far frame takes a second or two: it varies little, and there are many
  world.far_views = measure::compare(bench, far_path(scene, views), measure, progress);
  if (options.pictures)
    world.pictures = take_vertex_chunk_pictures(bench, name, view, bench.subjects()[kChunk]);
  return world;
}

}  // namespace sightline::reproduce
