// Rays per second at boxes, one thread: our wide tree beside Embree's user geometry, the same boxes and rays,
// and the paper's own ways. Each checks its hits before it is timed.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include <sightline/tbb.hpp>
#include <sightline/workbench/worlds.hpp>

#include "embree_boxes.hpp"
#include "library/rays/ray_grid.hpp"
#include "library/rays/wide_rays.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::benchmarks {
namespace {

struct Setting {
  Boxes boxes;
  rays::RayGrid grid;
  rays::Bvh bvh;
  rays::WideBvh wide;
  std::unique_ptr<EmbreeBoxes> fast, robust;
  rays::RayHits expected;
};

void look_from(Setting& setting, const Vec3& eye, float side) {
  const View view = *make_view({.eye = eye,
                                .forward = {-eye.x, -eye.y, -eye.z},
                                .vertical_fov = 0.6f,
                                .near_plane = 1,
                                .far_plane = 100 * side},
                               1280, 720);
  setting.grid.make(view, 100, 100);
}

const Setting& setting_of(std::int64_t count) {
  static std::map<std::int64_t, Setting> all;
  Setting& s = all[count];
  if (s.grid.size() != 0) return s;
  if (count < 1'000'000) {
    const Scene scene =
        generate_world(count == 1371 ? "strata?triangles=20000&model=1" : "strata?triangles=200000&model=5");
    s.boxes = scene.bounds;
    look_from(s, scene.viewpoints[1].eye, 2000);
  } else {
    scene::Random random(1);
    for (std::int64_t i = 0; i < count; ++i) {
      const Vec3 at = random.inside({{-1000, -1000, -1000}, {1000, 1000, 1000}}),
                 half{random.between(0.2f, 4), random.between(0.2f, 4), random.between(0.2f, 4)};
      s.boxes.push_back(
          {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
    }
    look_from(s, {1800, 1600, 3000}, 2000);
  }
  s.bvh.build(s.boxes), s.wide.build(s.boxes);
  s.fast = std::make_unique<EmbreeBoxes>(s.boxes, RTC_SCENE_FLAG_NONE);
  s.robust = std::make_unique<EmbreeBoxes>(s.boxes, RTC_SCENE_FLAG_ROBUST);
  methods::cast_by_skip_counts(s.bvh.nodes(), s.grid.prepared, s.expected);
  return s;
}

template <class Cast>
void run(benchmark::State& state, Cast cast, bool is_embree = false) {
  const Setting& s = setting_of(state.range(0));
  rays::RayHits hits;
  cast(s, hits);
  // Against the plain walk, which equals testing every box. Embree may leave out a box at the very distance
  // of the one it has (a tie; ours is the lower id), and by its own rounding one that a ray merely grazes.
  std::size_t ties = 0, grazed = 0;
  for (std::size_t r = 0; r < s.grid.size(); ++r) {
    const bool same_distance = hits.distance[r] == s.expected.distance[r];
    if (same_distance && hits.object[r] == s.expected.object[r]) continue;
    (same_distance ? ties : grazed) += 1;
  }
  if (!is_embree && ties + grazed > 0) {
    state.SkipWithError("a hit differs from the plain walk's");
    return;
  }
  for (auto _ : state) cast(s, hits);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.grid.size()));
  state.counters["hits"] = static_cast<double>(hits.stats.hits);
  if (is_embree) {
    state.counters["ties"] = static_cast<double>(ties);
    state.counters["grazed"] = static_cast<double>(grazed);
  }
}

void BM_EmbreeUserGeometry(benchmark::State& state) {
  run(
      state, [](const Setting& s, rays::RayHits& hits) { s.fast->cast(s.grid.rays, s.grid.prepared, hits); },
      true);
}
void BM_EmbreeRobust(benchmark::State& state) {
  run(
      state,
      [](const Setting& s, rays::RayHits& hits) { s.robust->cast(s.grid.rays, s.grid.prepared, hits); },
      true);
}
void BM_WideRays(benchmark::State& state) {
  run(state, [stack = rays::WideStack()](const Setting& s, rays::RayHits& hits) mutable {
    rays::cast_wide(s.wide, s.grid, stack, hits);
  });
}
void BM_WideRaysAllCores(benchmark::State& state) {
  const JobSystem jobs = tbb_jobs();
  std::vector<rays::WideStack> stacks(jobs.threads);
  run(state,
      [&](const Setting& s, rays::RayHits& hits) { rays::cast_wide(s.wide, s.grid, jobs, stacks, hits); });
  state.counters["threads"] = jobs.threads;
}
void BM_Boca(benchmark::State& state) {
  run(state,
      [](const Setting& s, rays::RayHits& hits) { methods::cast_down_bvh(s.bvh, s.grid.prepared, hits); });
}
void BM_SkipCounts(benchmark::State& state) {
  run(state, [](const Setting& s, rays::RayHits& hits) {
    methods::cast_by_skip_counts(s.bvh.nodes(), s.grid.prepared, hits);
  });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Arg(1371)->Arg(17773)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
}
BENCHMARK(BM_EmbreeUserGeometry)->Apply(sizes);
BENCHMARK(BM_EmbreeRobust)->Apply(sizes);
BENCHMARK(BM_WideRays)->Apply(sizes);
BENCHMARK(BM_WideRaysAllCores)->Apply(sizes)->UseRealTime();
BENCHMARK(BM_Boca)->Apply(sizes);
BENCHMARK(BM_SkipCounts)->Apply(sizes);

}  // namespace
}  // namespace sightline::benchmarks
