// Culling a world beside the flat SIMD loop, a scalar loop and other libraries, in one process on the same
// boxes and views, and keeping it.
#include <benchmark/benchmark.h>

#include <array>

#include <sightline/frustum.hpp>
#include <sightline/world.hpp>

#include "judged.hpp"
#include "only_avx2.hpp"
#include "scalar_cull.hpp"
#include "workbench/scene/random.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

template <class Cull>
void flat(benchmark::State& state, const Cull& cull) {
  const Case& c = case_of(1'000'000);
  const View view = looking(0.3f, tenth_of_view());
  const Frustum frustum = make_frustum(view);
  std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
  std::size_t count = 0;
  for (auto _ : state) benchmark::DoNotOptimize(count = cull(frustum, c.flat, visible));
  judge(state, c.flat, {&view, 1}, std::span(visible).first(count));
}

void flat_simd(benchmark::State& state) {
  flat(state, [](const Frustum& frustum, const Boxes& boxes, std::span<ObjectId> visible) {
    return *cull_boxes(frustum, boxes.view(), visible);
  });
}
void scalar_loop(benchmark::State& state) {
  flat(state, cull_boxes_scalar);
}

// Culls a world by a view, again and again; what it keeps for nothing is a few boxes at the borders.
void cull_world(benchmark::State& state, const Case& c, const View& view) {
  std::vector<ObjectId> visible(cull_capacity(c.world));
  Culler culler;
  CullResult result;
  for (auto _ : state)
    benchmark::DoNotOptimize(result = *culler.cull(c.world, CullView{.view = {view, {}}}, visible));
  judge(state, c.flat, {&view, 1}, std::span(visible).first(result.count));
  if (state.counters["lost"] > 0 || state.counters["excess"] > 10) state.SkipWithError("a wrong answer");
}

void world(benchmark::State& state) {
  cull_world(state, case_of(static_cast<std::size_t>(state.range(0))), looking(0.3f, tenth_of_view()));
}

void world_avx2(benchmark::State& state) {
  const OnlyAvx2 without_avx512;
  world(state);
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

// 200,000 boxes over 600 km, so that most sectors hold a few.
Case& far_sectors() {
  static Case made;
  if (made.flat.size() != 0) return made;
  scene::Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    const Vec3 at = random.inside({{-3e5f, 0, -3e5f}, {3e5f, 100, 3e5f}});
    made.flat.push_back({{at.x - 5, at.y - 5, at.z - 5}, {at.x + 5, at.y + 5, at.z + 5}});
  }
  made.handles.resize(made.flat.size());
  or_throw(made.world.insert(made.flat.view(), made.handles));
  return made;
}

void far_sectors_cull(benchmark::State& state) {
  const View view = *make_view({.eye = {0, 50, 0}, .near_plane = 1, .far_plane = 1e5f}, 1280, 720);
  cull_world(state, far_sectors(), view);
}

void far_sectors_move(benchmark::State& state) {
  Case& c = far_sectors();
  const std::span<const Handle> handle(&c.handles[7], 1);
  std::array<Box, 2> to{c.flat[7], c.flat[7]};
  to[1].min.x += 1, to[1].max.x += 1;
  std::size_t turn = 0;
  for (auto _ : state) or_throw(c.world.move(handle, std::span<const Box>(&to[++turn % 2], 1)));
  or_throw(c.world.move(handle, std::span<const Box>(to.data(), 1)));
}

BENCHMARK(far_sectors_cull)->Name("far_sectors/cull")->Unit(benchmark::kMicrosecond);
BENCHMARK(far_sectors_move)->Name("far_sectors/move")->Unit(benchmark::kMicrosecond);
BENCHMARK(flat_simd)->Unit(benchmark::kMicrosecond);
BENCHMARK(scalar_loop)->Unit(benchmark::kMicrosecond);
BENCHMARK(world)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(world_avx2)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Unit(benchmark::kMillisecond);
BENCHMARK(build_from_structs)->Unit(benchmark::kMillisecond);
BENCHMARK(move_all)->Unit(benchmark::kMillisecond);
BENCHMARK(move_all_from_structs)->Unit(benchmark::kMillisecond);
BENCHMARK(move_a_tenth)->Unit(benchmark::kMillisecond);
BENCHMARK(world)->Arg(10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
