#include "workbench/reproduce/vertex_chunk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/reproduce/vertex_chunk_pictures.hpp"

namespace sightline::reproduce {

namespace {

// The paper's methods with its contribution test where it has one; then ours.
const std::vector<std::string> kMethods{"none", "vfc-vc?contribution=area",       "roc",
                                        "hroc", "vertex-chunk?contribution=area", "resident-chunk",
                                        "hiz"};
constexpr std::size_t kNone = 0, kVfc = 1, kRoc = 2, kHroc = 3, kChunk = 4;

// vertex-chunk, hroc, roc, vfc-vc, none; 0 where the paper has no figure.
struct Published {
  std::array<double, 5> vertices, cull_ms, culled, fps, far_fps, near_fps;
};
constexpr Published kRegular{
    {2338, 324864, 324864, 9024, 0}, {17, 29, 45, 21, 0}, {7938, 7938, 7938, 5849, 0},
    {193, 172, 97, 78, 12},          {29, 21, 23, 31, 9}, {220, 192, 108, 88, 12}};
constexpr Published kIrregular{
    {2703, 229832, 324864, 9024, 0}, {21, 26, 55, 31, 0}, {8127, 8127, 8127, 6048, 0},
    {203, 178, 91, 62, 11},          {37, 33, 31, 36, 9}, {223, 182, 92, 83, 12}};
constexpr std::array<std::size_t, 5> kPaperOrder{kChunk, kHroc, kRoc, kVfc, kNone};

double cull_ms(const report::MethodSummary& s) {
  return s.cpu_ms + s.gpu_ms;
}

// "12.3 (1.00 / 1.00)": ours, and both as ratios to vertex-chunk.
template <class Value>
std::vector<std::string> line(std::string name, const std::vector<report::MethodSummary>& ours,
                              const std::array<double, 5>& published, Value value, bool whole) {
  std::vector<std::string> cells{std::move(name)};
  const double base = value(ours[kChunk]);
  const auto ratio = [](double a, double b) {
    return b > 0 ? fmt::format("{:.2f}", a / b) : std::string("–");
  };
  for (std::size_t i = 0; i < kPaperOrder.size(); ++i) {
    const double v = value(ours[kPaperOrder[i]]);
    cells.push_back(fmt::format("{} ({} / {})", whole ? report::format_count(v) : report::format_ms(v),
                                ratio(v, base), published[i] > 0 ? ratio(published[i], published[0]) : "–"));
  }
  for (std::size_t m = kChunk + 1; m < ours.size(); ++m) {
    const double v = value(ours[m]);
    cells.push_back(
        fmt::format("{} ({})", whole ? report::format_count(v) : report::format_ms(v), ratio(v, base)));
  }
  return cells;
}

report::Table table_of(std::string title) {
  return {
      {std::move(title), "vertex-chunk", "hroc", "roc", "vfc-vc", "none", "resident-chunk", "hiz"}, {}, 1};
}

std::vector<report::Table> make_tables(const VertexChunkWorld& world, const Published& published) {
  const std::vector<report::MethodSummary> near = report::summarise(world.near),
                                           far = report::summarise(world.far),
                                           rising = report::summarise(world.rising);
  const double objects = static_cast<double>(world.near.rows.front().stats.objects);
  const auto fps = [](const report::MethodSummary& s) { return s.fps(); };
  std::vector<report::Table> out;
  out.push_back(table_of("1: vertices into the culling pass"));
  out.back().rows.push_back(line(
      "near view", near, published.vertices, [](const auto& s) { return s.cull_vertices; }, true));
  out.push_back(table_of("2: culling time, ms"));
  out.back().rows.push_back(line("near view", near, published.cull_ms, cull_ms, false));
  out.push_back(table_of("3: objects culled"));
  out.back().rows.push_back(line(
      "near view", near, published.culled, [&](const auto& s) { return objects - s.kept; }, true));
  out.push_back(table_of("4: frames/s"));
  out.back().rows.push_back(line("rising camera", rising, published.fps, fps, false));
  out.push_back(table_of("5: frames/s by view"));
  out.back().rows.push_back(line("far view", far, published.far_fps, fps, false));
  out.back().rows.push_back(line("near view", near, published.near_fps, fps, false));
  return out;
}

report::Table rising_table(const measure::Comparison& rising) {
  report::Table table;
  table.header = {"frames/s at scene number"};
  for (const std::string& method : rising.methods) table.header.push_back(method.substr(0, method.find('?')));
  for (std::size_t view = 0; view < rising.cameras.size(); ++view) {
    std::vector<std::string> cells{fmt::format("{}", view + 1)};
    for (const measure::Row& row : rising.rows) {
      if (row.view == view)
        cells.push_back(report::format_ms(row.frame->median > 0 ? 1000 / row.frame->median : 0));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

camera::CameraPath rising_path(const Scene& scene, std::size_t views) {
  const Camera low = vertex_chunk_near(scene), high = vertex_chunk_far(scene);
  camera::CameraPath path{"rising", {}};
  for (std::size_t i = 0; i < views; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(views - 1);
    const auto mix = [&](const Vec3& a, const Vec3& b) {
      return Vec3{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
    };
    Camera camera = low;
    camera.eye = mix(low.eye, high.eye);
    camera.forward = mix(low.forward, high.forward);
    path.cameras.push_back(camera);
  }
  return path;
}

}  // namespace

Scene vertex_chunk_scene(const std::string& world, bool quick) {
  return generate_world(fmt::format("{}?detail={}", world, quick ? 2 : 3));
}

Camera vertex_chunk_near(const Scene& scene) {
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

Camera vertex_chunk_far(const Scene& scene) {
  Camera camera;
  for (const Viewpoint& viewpoint : scene.viewpoints) {
    if (viewpoint.name != "far") continue;
    camera.eye = viewpoint.eye;
    camera.forward = viewpoint.forward;
  }
  return camera;
}

VertexChunkWorld reproduce_vertex_chunk(device::Device& device, const std::string& name,
                                        const VertexChunkOptions& options, const Progress& progress) {
  Scene scene = vertex_chunk_scene(name, options.quick);
  measure::Bench bench(scene, kMethods, &device);
  measure::MeasureOptions measure;
  measure.width = options.quick ? 640 : 1280;
  measure.height = options.quick ? 360 : 720;
  measure.repeats = measure.timed_passes = 15;
  VertexChunkWorld world;
  world.name = name;
  world.near = measure::compare(bench, {"near", {vertex_chunk_near(scene)}}, measure);
  // The camera rises from where it is; after a change of view it takes two frames until what was marked in
  // vain is gone.
  measure.warm_up = 2;
  measure.repeats = 1, measure.timed_passes = 0;
  world.rising = measure::compare(bench, rising_path(scene, options.quick ? 5 : 12), measure, progress);
  measure.repeats = options.quick ? 7 : 5, measure.timed_passes = 3;
  world.far = measure::compare(bench, {"far", {vertex_chunk_far(scene)}}, measure);
  world.tables = make_tables(world, name == "regular" ? kRegular : kIrregular);
  world.rising_fps = rising_table(world.rising);
  if (options.pictures) {
    const View near = or_throw(make_view(world.near.cameras.front(), measure.width, measure.height));
    world.pictures = take_vertex_chunk_pictures(bench, name, near, bench.subjects()[kChunk]);
  }
  return world;
}

}  // namespace sightline::reproduce
