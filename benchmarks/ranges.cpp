// What is seen of a million boxes as ids, as ranges of their order, and as whole chunks: of views that see
// few, a tenth and all; and what it costs to follow a world that changes.
#include <benchmark/benchmark.h>

#include <algorithm>

#include <sightline/ranges.hpp>

#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr std::size_t kBoxes = 1'000'000;

// 0: some thousands; 1: a tenth; 2: half of them, from above; 3: all of them.
CullView seeing(int much) {
  if (much < 2) return {.view = {looking(0.3f, much == 0 ? 0.12f : tenth_of_view()), {}}};
  Camera camera{.eye = {0, 3000, 0}, .forward = {0, -1, 0}, .up = {0, 0, -1}};
  camera.vertical_fov = 2 * std::atan((much == 2 ? 700.0f : 1100.0f) / 2950), camera.far_plane = 5000;
  return {.view = {*make_view(camera, 720, 720), {}}};
}

struct Ordered {
  const World& world;
  ObjectOrder order;
  Ordered() : world(case_of(kBoxes).world) { (void)order.update(case_of(kBoxes).world); }
};
const Ordered& ordered() {
  static const Ordered made;
  return made;
}

void ids(benchmark::State& state, int much) {
  const World& world = ordered().world;
  std::vector<ObjectId> visible(cull_capacity(world));
  Culler culler;
  CullResult result;
  const CullView view = seeing(much);
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(world, view, visible));
  state.counters["visible"] = static_cast<double>(result.count);
}

// Judged by the ids of a plain cull.
void ranges(benchmark::State& state, int much, bool whole_chunks) {
  const Ordered& o = ordered();
  RangeCuller culler;
  RangeResult result;
  const CullView view = seeing(much);
  const RangeOptions options{.whole_chunks = whole_chunks};
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(o.world, o.order, view, options));
  state.counters["visible"] = static_cast<double>(result.objects);
  state.counters["ranges"] = static_cast<double>(result.ranges.size());
  std::vector<ObjectId> expected(cull_capacity(o.world)), got;
  expected.resize(Culler().cull(o.world, view, expected)->count);
  for (const SlotRange& range : result.ranges)
    for (std::uint32_t i = 0; i < range.count; ++i) got.push_back(o.order.objects()[range.first + i]);
  std::sort(expected.begin(), expected.end()), std::sort(got.begin(), got.end());
  const bool right = whole_chunks ? std::includes(got.begin(), got.end(), expected.begin(), expected.end())
                                  : got == expected;
  if (!right) state.SkipWithError("a wrong answer");
}

// A world of its own, as orders take turns in following one.
Case& moving_case() {
  static Case made = [] {
    Case c;
    c.flat = case_of(kBoxes).flat, c.handles.resize(kBoxes);
    or_throw(c.world.insert(c.flat.view(), c.handles));
    return c;
  }();
  return made;
}

// So many boxes by a metre to and fro each frame: the report of what that changed. Not timed: the move.
void follow(benchmark::State& state) {
  Case& moving = moving_case();
  const auto count = static_cast<std::size_t>(state.range(0));
  ObjectOrder order;
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(moving.world));
  // What others have moved comes to rest first, in frames that move nothing.
  for (int calm = 0; calm < 1024;) {
    or_throw(moving.world.move(std::span<const Handle>(), Boxes().view()));
    (void)culler.cull(moving.world, seeing(0), visible);
    calm = order.update(moving.world)->empty() ? calm + 1 : 0;
  }
  double reported = 0, frames = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Boxes boxes;
    for (std::size_t i = 0; i < count; ++i) {
      Box b = moving.flat[i];
      const float by = static_cast<int>(frames) % 2 == 0 ? 1.0f : 0.0f;
      b.min.x += by, b.max.x += by;
      boxes.push_back(b);
    }
    or_throw(moving.world.move(std::span<const Handle>(moving.handles).first(count), boxes.view()));
    (void)culler.cull(moving.world, seeing(0), visible);
    state.ResumeTiming();
    const auto report = order.update(moving.world);
    reported += static_cast<double>(report->size()), ++frames;
  }
  state.counters["changes"] = reported / frames;
}

// All slots anew, and all reported.
void first_report(benchmark::State& state) {
  Case& c = moving_case();
  for (auto _ : state) {
    ObjectOrder order;
    benchmark::DoNotOptimize(order.update(c.world)->size());
  }
}

#define SIGHTLINE_RANGES(name, much)                                                                  \
  BENCHMARK_CAPTURE(ids, name, much)->Name("ids/" #name)->Unit(benchmark::kMicrosecond);              \
  BENCHMARK_CAPTURE(ranges, name, much, false)->Name("ranges/" #name)->Unit(benchmark::kMicrosecond); \
  BENCHMARK_CAPTURE(ranges, name##_whole, much, true)                                                 \
      ->Name("whole_chunks/" #name)                                                                   \
      ->Unit(benchmark::kMicrosecond)
SIGHTLINE_RANGES(few, 0);
SIGHTLINE_RANGES(tenth, 1);
SIGHTLINE_RANGES(half, 2);
SIGHTLINE_RANGES(all, 3);
#undef SIGHTLINE_RANGES
BENCHMARK(follow)->Arg(0)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMicrosecond)->Iterations(100);
BENCHMARK(first_report)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline::benchmarks
