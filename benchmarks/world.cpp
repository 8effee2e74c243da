// Culling a world beside the flat SIMD loop, a scalar loop and other libraries, in one process on the same
// boxes and views, and keeping it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>

#include <sightline/culling.hpp>
#include <sightline/world.hpp>

#include "scalar_cull.hpp"
#include "workbench/scene/random.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

void flat_simd(benchmark::State& state) {
  const Case& c = case_of(static_cast<std::size_t>(state.range(0)));
  std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
  const Frustum frustum =
      make_frustum(looking(0.3f, tenth_of_view()), {{-2000, -60, -2000}, {2000, 60, 12000}});
  std::size_t count = 0;
  for (auto _ : state) benchmark::DoNotOptimize(count = cull_boxes(frustum, span_of(c.flat), visible));
  state.counters["visible"] = static_cast<double>(count);
}

void scalar_loop(benchmark::State& state) {
  const Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
  const Frustum frustum =
      make_frustum(looking(0.3f, tenth_of_view()), {{-2000, -60, -2000}, {2000, 60, 12000}});
  for (auto _ : state) benchmark::DoNotOptimize(cull_boxes_scalar(frustum, span_of(c.flat), visible));
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

// Views side by side, each turned against the one before by so much of its own width.
void cull_views(benchmark::State& state, std::size_t count, float turn) {
  Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(cull_capacity(c.world));
  std::vector<std::uint8_t> masks(visible.size());
  std::vector<WorldView> views;
  const float fov = tenth_of_view();
  const float across = 2 * std::atan(std::tan(fov / 2) * 1280 / 720);
  for (std::size_t v = 0; v < count; ++v)
    views.push_back({looking(0.3f + turn * across * static_cast<float>(v), fov), {}});
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = cull(c.world, views, {}, visible, masks));
  state.counters["visible"] = static_cast<double>(result.count);
}

void one_view(benchmark::State& state) {
  cull_views(state, 1, 0);
}
// Any two of the four share at least half of what they see.
void four_views_sharing_half(benchmark::State& state) {
  cull_views(state, 4, 1.0f / 6);
}
// Each shares half with the next, and nothing with the one after that.
void four_views_in_a_fan(benchmark::State& state) {
  cull_views(state, 4, 1.0f / 2);
}
// Two and two the same, the pairs sharing half: what four_views was measured by until now.
void four_views_in_two_pairs(benchmark::State& state) {
  Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(cull_capacity(c.world));
  std::vector<std::uint8_t> masks(visible.size());
  std::vector<WorldView> views;
  const float fov = tenth_of_view();
  const float across = 2 * std::atan(std::tan(fov / 2) * 1280 / 720);
  for (std::size_t v = 0; v < 4; ++v)
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
  const Case& c = case_of(1'000'000);
  // A world of its own: the others are culled where they stand.
  World moving;
  std::vector<WorldBox> all;
  for (std::size_t i = 0; i < c.flat.size(); ++i) all.push_back(wide(c.flat[i]));
  std::vector<Handle> handles(all.size());
  if (moving.insert(all, handles)) std::abort();
  scene::Random random(3);
  std::vector<Handle> moved(handles.size() / 10);
  std::vector<WorldBox> boxes(moved.size());
  std::vector<ObjectId> visible(cull_capacity(moving));
  const WorldView view{looking(0.3f, tenth_of_view()), {}};
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const ObjectId id = random.below(static_cast<std::uint32_t>(c.flat.size()));
      const float by = random.between(-1, 1);
      Box box = c.flat[id];
      box.min.x += by, box.max.x += by, box.min.z -= by, box.max.z -= by;
      moved[i] = handles[id], boxes[i] = wide(box);
    }
    state.ResumeTiming();
    if (moving.move(moved, boxes)) std::abort();
    benchmark::DoNotOptimize(cull(moving, {&view, 1}, {}, visible));
  }
}

BENCHMARK(flat_simd)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(scalar_loop)->Unit(benchmark::kMicrosecond);
BENCHMARK(world)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(one_view)->Unit(benchmark::kMicrosecond);
BENCHMARK(four_views_sharing_half)->Unit(benchmark::kMicrosecond);
BENCHMARK(four_views_in_two_pairs)->Unit(benchmark::kMicrosecond);
BENCHMARK(four_views_in_a_fan)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Unit(benchmark::kMillisecond);
BENCHMARK(move_a_tenth)->Unit(benchmark::kMillisecond);
BENCHMARK(world)->Arg(10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
