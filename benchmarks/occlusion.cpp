// Drawing occluders and testing boxes against them: triangles and boxes a second, one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>

#include <sightline/occlusion.hpp>

#include "scene/random.hpp"

namespace sightline {
namespace {

// Houses on a plain, seen from the street and from above it.
std::vector<Box> houses(std::size_t count, float reach) {
  scene::Random random(1);
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    const Vec3 at = random.inside({{-reach, 0, -reach}, {reach, 0, reach}});
    if (std::fabs(at.x) < 8 && std::fabs(at.z) < 8) continue;
    const float w = random.between(1, 6), h = random.between(2, 12), d = random.between(1, 6);
    boxes.push_back({{at.x - w, 0, at.z - d}, {at.x + w, h, at.z + d}});
  }
  return boxes;
}

// All boxes lie in view.
View looking(bool from_above) {
  Camera camera;
  camera.eye = from_above ? Vec3{0, 260, 560} : Vec3{0, 1.7f, 320};
  camera.forward = from_above ? Vec3{0, -0.5f, -1} : Vec3{0, 0, -1};
  camera.vertical_fov = 1;
  return *make_view(camera, 1280, 720);
}

std::vector<Box> in_order(std::vector<Box> boxes, const View& view, bool sorted) {
  if (!sorted) return boxes;
  const Vec3 eye = eye_position(view);
  const auto distance = [&](const Box& b) {
    const float x = 0.5f * (b.min.x + b.max.x) - eye.x, y = 0.5f * (b.min.y + b.max.y) - eye.y,
                z = 0.5f * (b.min.z + b.max.z) - eye.z;
    return x * x + y * y + z * z;
  };
  std::sort(boxes.begin(), boxes.end(),
            [&](const Box& a, const Box& b) { return distance(a) < distance(b); });
  return boxes;
}

void draw(benchmark::State& state, bool from_above, bool sorted) {
  const View view = looking(from_above);
  const std::vector<Box> boxes = in_order(houses(4000, 300), view, sorted);
  OcclusionBuffer buffer;
  for (auto _ : state) {
    if (buffer.begin({view, {}})) std::abort();
    buffer.draw_boxes(boxes);
  }
  std::vector<float> pixels(std::size_t{view.width} * view.height);
  buffer.read_nearness(pixels);
  state.counters["covered"] =
      static_cast<double>(std::count_if(pixels.begin(), pixels.end(), [](float n) { return n > 0; })) /
      static_cast<double>(pixels.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(12 * boxes.size()));
}

void query(benchmark::State& state, bool from_above) {
  const View view = looking(from_above);
  OcclusionBuffer buffer;
  if (buffer.begin({view, {}})) std::abort();
  buffer.draw_boxes(in_order(houses(4000, 300), view, true));
  scene::Random random(2);
  Boxes boxes;
  const Frustum frustum = make_frustum(view, {{-700, -700, -700}, {700, 700, 700}});
  while (boxes.size() < 100'000) {
    const Vec3 at = random.inside({{-300, 0, -300}, {300, 8, 300}}),
               half = random.inside({{0.2f, 0.2f, 0.2f}, {1.5f, 1.5f, 1.5f}});
    const Box box{{at.x - half.x, at.y - half.y, at.z - half.z},
                  {at.x + half.x, at.y + half.y, at.z + half.z}};
    if (overlaps(frustum, box)) boxes.push_back(box);
  }
  std::vector<std::uint8_t> visible(boxes.size());
  for (auto _ : state) {
    buffer.may_see(span_of(boxes), visible);
    benchmark::ClobberMemory();
  }
  state.counters["visible"] =
      std::accumulate(visible.begin(), visible.end(), 0.0) / static_cast<double>(visible.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(boxes.size()));
}

BENCHMARK_CAPTURE(draw, street_sorted, false, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(draw, street_unsorted, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(draw, above_sorted, true, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(draw, above_unsorted, true, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(query, street, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(query, above, true)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline
