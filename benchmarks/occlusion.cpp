// Drawing occluders and testing boxes against them: triangles and boxes a second, one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/workbench/error.hpp>

#include "support/exact_rays.hpp"
#include "workbench/scene/random.hpp"

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
    or_throw(buffer.begin({view, {}}, {Coverage::centres}));
    or_throw(buffer.draw_boxes(std::span<const Box>(boxes)));
  }
  std::vector<float> pixels(std::size_t{view.width} * view.height);
  or_throw(buffer.read_nearness(pixels));
  state.counters["covered"] =
      static_cast<double>(std::count_if(pixels.begin(), pixels.end(), [](float n) { return n > 0; })) /
      static_cast<double>(pixels.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(12 * boxes.size()));
}

// The pixels whose centres the box's rectangle holds, in double precision; empty where first > last.
struct Pixels {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  double nearest = 0;  // of the box
};

Pixels exact_pixels(const View& view, const Box& box) {
  using namespace geometry;
  const glm::dmat4 clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
  double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30, least_w = 1e30;
  for (int c = 0; c < 8; ++c) {
    const glm::dvec4 p = clip * glm::dvec4(c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                                           c & 4 ? box.max.z : box.min.z, 1);
    const double x = (p.x / p.w + 1) / 2 * view.width, y = (1 - p.y / p.w) / 2 * view.height;
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    least_w = std::min(least_w, p.w);
  }
  if (least_w <= 0) return {0, 0, static_cast<int>(view.width) - 1, static_cast<int>(view.height) - 1, 1e30};
  const auto first = [](double v) { return static_cast<int>(std::ceil(std::max(v - 0.5, 0.0))); };
  const auto last = [](double v, std::uint32_t size) {
    return static_cast<int>(std::floor(std::min(v - 0.5, size - 1.0)));
  };
  return {first(x0), first(y0), last(x1, view.width), last(y1, view.height), 1 / least_w};
}

// The reference: a full-resolution depth at every pixel centre, and each box's rectangle and nearest depth
// against it. How many boxes it calls visible.
std::size_t reference(const View& view, std::span<const Box> occluders, const Boxes& boxes) {
  const test::ExactRays rays(view);
  std::vector<double> depth(std::size_t{view.width} * view.height, test::ExactRays::kMiss);
  for (const Box& box : occluders) {
    const Pixels p = exact_pixels(view, box);
    for (int y = p.y0; y <= p.y1; ++y) {
      for (int x = p.x0; x <= p.x1; ++x) {
        double& at = depth[static_cast<std::size_t>(y) * view.width + static_cast<std::size_t>(x)];
        at = std::max(at, rays.hit(x + 0.5, y + 0.5, box, true));
      }
    }
  }
  std::size_t visible = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Pixels p = exact_pixels(view, boxes[i]);
    bool seen = false;
    for (int y = p.y0; y <= p.y1 && !seen; ++y) {
      for (int x = p.x0; x <= p.x1 && !seen; ++x) {
        seen = depth[static_cast<std::size_t>(y) * view.width + static_cast<std::size_t>(x)] <= p.nearest;
      }
    }
    visible += seen;
  }
  return visible;
}

void query(benchmark::State& state, bool from_above) {
  const View view = looking(from_above);
  OcclusionBuffer buffer;
  or_throw(buffer.begin({view, {}}, {Coverage::centres}));
  const std::vector<Box> occluders = in_order(houses(4000, 300), view, true);
  or_throw(buffer.draw_boxes(std::span<const Box>(occluders)));
  scene::Random random(2);
  Boxes boxes;
  const Frustum frustum = make_frustum(view);
  while (boxes.size() < 100'000) {
    const Vec3 at = random.inside({{-300, 0, -300}, {300, 8, 300}}),
               half = random.inside({{0.2f, 0.2f, 0.2f}, {1.5f, 1.5f, 1.5f}});
    const Box box{{at.x - half.x, at.y - half.y, at.z - half.z},
                  {at.x + half.x, at.y + half.y, at.z + half.z}};
    if (overlaps(frustum, box)) boxes.push_back(box);
  }
  std::vector<std::uint8_t> visible(boxes.size());
  for (auto _ : state) {
    or_throw(buffer.may_see(boxes.view(), visible));
    benchmark::ClobberMemory();
  }
  const double kept = std::accumulate(visible.begin(), visible.end(), 0.0);
  const auto right = static_cast<double>(reference(view, occluders, boxes));
  state.counters["visible"] = kept / static_cast<double>(visible.size());
  state.counters["excess_%"] = 100 * (kept - right) / right;
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
