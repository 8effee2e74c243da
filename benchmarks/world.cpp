// Culling a world beside the flat SIMD loop, in one process on the same boxes and views, and keeping it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>

#include <sightline/culling.hpp>
#include <sightline/world.hpp>

#include "scene/random.hpp"

namespace sightline {
namespace {

constexpr float kReach = 1000;

// Random boxes about the origin; beyond a million, the rest stands around them, out of all views.
struct Case {
  Boxes flat;
  World world;
  std::vector<Handle> handles;
};

WorldBox wide(const Box& b) {
  return {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
}

Case& case_of(std::size_t count) {
  static std::map<std::size_t, std::unique_ptr<Case>> made;
  std::unique_ptr<Case>& slot = made[count];
  if (slot) return *slot;
  slot = std::make_unique<Case>();
  scene::Random random(1);
  std::vector<WorldBox> boxes;
  while (boxes.size() < count) {
    Vec3 at = random.inside({{-kReach, -50, -kReach}, {kReach, 50, kReach}});
    // Behind the eye.
    if (boxes.size() >= 1'000'000) at.z = kReach + 8 * random.between(0, kReach);
    const Vec3 half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
    const Box box{{at.x - half.x, at.y - half.y, at.z - half.z},
                  {at.x + half.x, at.y + half.y, at.z + half.z}};
    slot->flat.push_back(box);
    boxes.push_back(wide(box));
  }
  slot->handles.resize(count);
  if (slot->world.insert(boxes, slot->handles)) std::abort();
  return *slot;
}

View looking(float heading, float fov) {
  Camera camera;
  camera.eye = {0, 5, 0};
  camera.forward = {std::sin(heading), -0.02f, -std::cos(heading)};
  camera.vertical_fov = fov;
  camera.far_plane = 1400;
  return *make_view(camera, 1280, 720);
}

// The field of view that sees a tenth of a million.
float tenth_of_view() {
  static const float found = [] {
    const Case& c = case_of(1'000'000);
    std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
    float low = 0.05f, high = 2.5f;
    for (int i = 0; i < 30; ++i) {
      const float middle = 0.5f * (low + high);
      const Frustum frustum = make_frustum(looking(0.3f, middle), {{-2000, -60, -2000}, {2000, 60, 2000}});
      (cull_boxes(frustum, span_of(c.flat), visible) < c.flat.size() / 10 ? low : high) = middle;
    }
    return high;
  }();
  return found;
}

void flat_simd(benchmark::State& state) {
  const Case& c = case_of(static_cast<std::size_t>(state.range(0)));
  std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
  const Frustum frustum =
      make_frustum(looking(0.3f, tenth_of_view()), {{-2000, -60, -2000}, {2000, 60, 12000}});
  std::size_t count = 0;
  for (auto _ : state) benchmark::DoNotOptimize(count = cull_boxes(frustum, span_of(c.flat), visible));
  state.counters["visible"] = static_cast<double>(count);
}

void world(benchmark::State& state) {
  Case& c = case_of(static_cast<std::size_t>(state.range(0)));
  std::vector<ObjectId> visible(cull_capacity(c.world));
  const WorldView view{looking(0.3f, tenth_of_view()), {}};
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = cull(c.world, {&view, 1}, {}, visible));
  state.counters["visible"] = static_cast<double>(result.count);
  state.counters["tested"] = static_cast<double>(result.tested);
  state.counters["nodes"] = static_cast<double>(result.nodes_visited);
  const std::vector<ObjectId> by_world(visible.begin(),
                                       visible.begin() + static_cast<std::ptrdiff_t>(result.count));
  std::vector<ObjectId> sorted = by_world;
  std::sort(sorted.begin(), sorted.end());
  std::vector<ObjectId> flat(c.flat.size() + kCullPadding);
  const Frustum frustum = make_frustum(view.view, {{-2000, -60, -2000}, {2000, 60, 12000}});
  flat.resize(cull_boxes(frustum, span_of(c.flat), flat));
  if (std::abs(static_cast<double>(flat.size()) - static_cast<double>(sorted.size())) > 10) {
    state.SkipWithError("the visible sets differ");
  }
}

// Views that overlap their neighbour by half.
void views(benchmark::State& state) {
  Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(cull_capacity(c.world));
  std::vector<std::uint8_t> masks(visible.size());
  std::vector<WorldView> views;
  const auto count = static_cast<std::size_t>(state.range(0));
  const float fov = tenth_of_view();
  const float across = 2 * std::atan(std::tan(fov / 2) * 1280 / 720);
  for (std::size_t v = 0; v < count; ++v)
    views.push_back({looking(0.3f + 0.5f * across * static_cast<float>(v % 2), fov), {}});
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = cull(c.world, views, {}, visible, masks));
  state.counters["visible"] = static_cast<double>(result.count);
}

void build(benchmark::State& state) {
  Case& c = case_of(1'000'000);
  std::vector<WorldBox> boxes;
  for (std::size_t i = 0; i < c.flat.size(); ++i) boxes.push_back(wide(c.flat[i]));
  std::vector<Handle> handles(boxes.size());
  for (auto _ : state) {
    World fresh;
    if (fresh.insert(boxes, handles)) std::abort();
    benchmark::DoNotOptimize(fresh.size());
  }
}

void move_a_tenth(benchmark::State& state) {
  Case& c = case_of(1'000'000);
  scene::Random random(3);
  std::vector<Handle> moved(c.handles.size() / 10);
  std::vector<WorldBox> boxes(moved.size());
  std::vector<ObjectId> visible(cull_capacity(c.world));
  const WorldView view{looking(0.3f, tenth_of_view()), {}};
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const ObjectId id = random.below(static_cast<std::uint32_t>(c.flat.size()));
      const float by = random.between(-1, 1);
      Box box = c.flat[id];
      box.min.x += by, box.max.x += by, box.min.z -= by, box.max.z -= by;
      moved[i] = c.handles[id], boxes[i] = wide(box);
    }
    state.ResumeTiming();
    if (c.world.move(moved, boxes)) std::abort();
    benchmark::DoNotOptimize(cull(c.world, {&view, 1}, {}, visible));
  }
}

BENCHMARK(flat_simd)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(world)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(views)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Unit(benchmark::kMillisecond);
BENCHMARK(move_a_tenth)->Unit(benchmark::kMillisecond);
BENCHMARK(world)->Arg(10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline
