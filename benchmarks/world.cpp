// Culling a world beside the flat SIMD loop, a scalar loop and other libraries, in one process on the same
// boxes and views, and keeping it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>

#include <sightline/frustum.hpp>
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
  for (auto _ : state) benchmark::DoNotOptimize(count = *cull_boxes(frustum, c.flat.view(), visible));
  state.counters["visible"] = static_cast<double>(count);
}

void scalar_loop(benchmark::State& state) {
  const Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
  const Frustum frustum =
      make_frustum(looking(0.3f, tenth_of_view()), {{-2000, -60, -2000}, {2000, 60, 12000}});
  for (auto _ : state) benchmark::DoNotOptimize(cull_boxes_scalar(frustum, c.flat, visible));
}

void world(benchmark::State& state) {
  Case& c = case_of(static_cast<std::size_t>(state.range(0)));
  std::vector<ObjectId> visible(cull_capacity(c.world));
  const CullView view{.view = {looking(0.3f, tenth_of_view()), {}}};
  Culler culler;
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(c.world, view, visible));
  state.counters["visible"] = static_cast<double>(result.count);
  state.counters["tested"] = static_cast<double>(result.tested);
  state.counters["nodes"] = static_cast<double>(result.nodes_visited);
  const std::vector<ObjectId> by_world(visible.begin(),
                                       visible.begin() + static_cast<std::ptrdiff_t>(result.count));
  std::vector<ObjectId> sorted = by_world;
  std::sort(sorted.begin(), sorted.end());
  std::vector<ObjectId> flat(c.flat.size() + kCullPadding);
  const Frustum frustum = make_frustum(view.view.view, {{-2000, -60, -2000}, {2000, 60, 12000}});
  flat.resize(*cull_boxes(frustum, c.flat.view(), flat));
  if (std::abs(static_cast<double>(flat.size()) - static_cast<double>(sorted.size())) > 10) {
    state.SkipWithError("the visible sets differ");
  }
}

// Views in these directions, in widths of a view.
void cull_views(benchmark::State& state, std::initializer_list<float> turns) {
  Case& c = case_of(1'000'000);
  std::vector<ObjectId> visible(cull_capacity(c.world));
  std::vector<std::uint8_t> masks(visible.size());
  std::vector<CullView> views;
  const float fov = tenth_of_view();
  const float across = 2 * std::atan(std::tan(fov / 2) * 1280 / 720);
  for (const float turn : turns) views.push_back({.view = {looking(0.3f + turn * across, fov), {}}});
  Culler culler;
  CullResult result;
  for (auto _ : state) {
    benchmark::DoNotOptimize(result = *culler.cull(c.world, views, {}, {visible, masks}));
  }
  state.counters["visible"] = static_cast<double>(result.count);
}

void one_view(benchmark::State& state) {
  cull_views(state, {0});
}
// Any two of the four share at least half of what they see.
void four_views_sharing_half(benchmark::State& state) {
  cull_views(state, {0, 1.0f / 6, 2.0f / 6, 3.0f / 6});
}
// Each shares half with the next, and nothing with the one after that.
void four_views_in_a_fan(benchmark::State& state) {
  cull_views(state, {0, 1.0f / 2, 2.0f / 2, 3.0f / 2});
}
// Two and two the same, the pairs sharing half: what four_views was measured by until now.
void four_views_in_two_pairs(benchmark::State& state) {
  cull_views(state, {0, 1.0f / 2, 0, 1.0f / 2});
}

// A million boxes put in and moved, out of an array of boxes and out of the caller's own structs.
struct OwnStruct {
  char name[20];
  float centre[3], half[3];
  Handle handle;
};

void keep(benchmark::State& state, const BoxView& boxes, Strided<Handle> handles, bool moves) {
  World moving;
  if (moves) or_throw(moving.insert(boxes, handles));
  for (auto _ : state) {
    if (moves) {
      or_throw(moving.move(handles, boxes));
    } else {
      World fresh;
      or_throw(fresh.insert(boxes, handles));
      benchmark::DoNotOptimize(fresh.size());
    }
  }
}

void keep_array(benchmark::State& state, bool moves) {
  const Case& c = case_of(1'000'000);
  std::vector<WorldBox> boxes(c.flat.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = c.flat.view()[i];
  std::vector<Handle> handles(boxes.size());
  keep(state, boxes, handles, moves);
}

void keep_structs(benchmark::State& state, bool moves) {
  const Case& c = case_of(1'000'000);
  std::vector<OwnStruct> things(c.flat.size());
  for (std::size_t i = 0; i < things.size(); ++i) {
    const Box b = c.flat[i];
    things[i] = {"",
                 {0.5f * (b.min.x + b.max.x), 0.5f * (b.min.y + b.max.y), 0.5f * (b.min.z + b.max.z)},
                 {0.5f * (b.max.x - b.min.x), 0.5f * (b.max.y - b.min.y), 0.5f * (b.max.z - b.min.z)},
                 {}};
  }
  keep(state, BoxView::centre_half(things[0].centre, things[0].half, sizeof(OwnStruct), things.size()),
       {&things[0].handle, things.size(), sizeof(OwnStruct)}, moves);
}

void build(benchmark::State& state) {
  keep_array(state, false);
}
void build_from_structs(benchmark::State& state) {
  keep_structs(state, false);
}
void move_all(benchmark::State& state) {
  keep_array(state, true);
}
void move_all_from_structs(benchmark::State& state) {
  keep_structs(state, true);
}

void move_a_tenth(benchmark::State& state) {
  const Case& c = case_of(1'000'000);
  // A world of its own: the others are culled where they stand.
  World moving;
  std::vector<Handle> handles(c.flat.size());
  or_throw(moving.insert(c.flat.view(), handles));
  scene::Random random(3);
  std::vector<Handle> moved(handles.size() / 10);
  std::vector<Box> boxes(moved.size());
  std::vector<ObjectId> visible(cull_capacity(moving));
  const CullView view{.view = {looking(0.3f, tenth_of_view()), {}}};
  Culler culler;
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const ObjectId id = random.below(static_cast<std::uint32_t>(c.flat.size()));
      const float by = random.between(-1, 1);
      Box box = c.flat[id];
      box.min.x += by, box.max.x += by, box.min.z -= by, box.max.z -= by;
      moved[i] = handles[id], boxes[i] = box;
    }
    state.ResumeTiming();
    or_throw(moving.move(moved, BoxView(boxes)));
    benchmark::DoNotOptimize(culler.cull(moving, view, visible));
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
BENCHMARK(build_from_structs)->Unit(benchmark::kMillisecond);
BENCHMARK(move_all)->Unit(benchmark::kMillisecond);
BENCHMARK(move_all_from_structs)->Unit(benchmark::kMillisecond);
BENCHMARK(move_a_tenth)->Unit(benchmark::kMillisecond);
BENCHMARK(world)->Arg(10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
