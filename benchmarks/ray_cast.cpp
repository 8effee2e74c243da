// Rays at boxes, one thread: our wide tree beside all of Embree's ways of casting at user geometry, the same
// boxes and rays, and the paper's own ways. A grid of rays through a view, neighbours together, and rays from
// anywhere to anywhere. Each checks its hits before it is timed.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <sightline/tbb.hpp>
#include <sightline/workbench/worlds.hpp>

#include "embree_rays.hpp"
#include "library/rays/ray_grid.hpp"
#include "library/rays/wide_rays.hpp"
#include "only_avx2.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::benchmarks {
namespace {

struct Setting {
  Boxes boxes;
  rays::Bvh bvh;
  rays::WideBvh wide;
  BoxBvh face;
  std::unique_ptr<EmbreeBoxes> fast, robust, avx2;
};

struct Rays {
  rays::RayGrid grid;
  rays::RayHits expected;
  std::map<std::string, EmbreeCast> embree;
  bool coherent;
};

constexpr std::uint32_t kSide = 100;  // rays

rays::RayGrid look_from(const Vec3& eye, float far) {
  const View view = *make_view({.eye = eye,
                                .forward = {-eye.x, -eye.y, -eye.z},
                                .vertical_fov = 0.6f,
                                .near_plane = 1,
                                .far_plane = far},
                               1280, 720);
  rays::RayGrid grid;
  grid.make(view, kSide, kSide);
  return grid;
}

// From anywhere among the boxes, any way; in no order.
rays::RayGrid anywhere(const Boxes& boxes) {
  scene::Random random(2);
  rays::RayGrid grid;
  const auto count = static_cast<std::uint32_t>(boxes.size());
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const Box a = boxes[random.below(count)], b = boxes[random.below(count)];
    const Vec3 from{(a.min.x + b.max.x) / 2, (a.min.y + b.max.y) / 2, (a.min.z + b.max.z) / 2};
    grid.rays.push_back({from, random.direction()});
    grid.prepared.emplace_back(grid.rays.back());
    grid.order.push_back(i);
  }
  return grid;
}

Boxes boxes_of(std::int64_t count) {
  if (count < 1'000'000)
    return generate_world(count == 1371 ? "strata?triangles=20000&model=1"
                                        : "strata?triangles=200000&model=5")
        .bounds;
  scene::Random random(1);
  Boxes boxes;
  for (std::int64_t i = 0; i < count; ++i) {
    const Vec3 at = random.inside({{-1000, -1000, -1000}, {1000, 1000, 1000}}),
               half{random.between(0.2f, 4), random.between(0.2f, 4), random.between(0.2f, 4)};
    boxes.push_back(
        {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
  }
  return boxes;
}
const Setting& setting_of(std::int64_t count) {
  static std::map<std::int64_t, Setting> all;
  Setting& s = all[count];
  if (s.boxes.size() != 0) return s;
  s.boxes = boxes_of(count);
  s.bvh.build(s.boxes), s.wide.build(s.boxes);
  if (!s.face.build(s.boxes.view())) s.boxes = {};
  s.fast = std::make_unique<EmbreeBoxes>(s.boxes, RTC_SCENE_FLAG_NONE);
  s.robust = std::make_unique<EmbreeBoxes>(s.boxes, RTC_SCENE_FLAG_ROBUST);
  const OnlyAvx2 without_avx512;
  s.avx2 = std::make_unique<EmbreeBoxes>(s.boxes, RTC_SCENE_FLAG_NONE, "threads=1,isa=avx2");
  return s;
}

const Rays& rays_of(std::int64_t count, bool coherent) {
  static std::map<std::pair<std::int64_t, bool>, Rays> all;
  Rays& r = all[{count, coherent}];
  if (r.grid.size() != 0) return r;
  const Setting& s = setting_of(count);
  const Vec3 paper{40000, 0, 0}, corner{1800, 1600, 3000};
  r.grid = coherent ? look_from(count < 1'000'000 ? paper : corner, 200'000) : anywhere(s.boxes);
  for (const EmbreeForm& form : embree_forms())
    r.embree[form.name] = form.lay_out({r.grid.rays, r.grid.prepared, r.grid.order, coherent});
  methods::cast_by_skip_counts(s.bvh.nodes(), r.grid.prepared, r.expected);
  return r;
}

// How many boxes, and which rays.
struct Case {
  std::int64_t count;
  bool coherent;
};

// cast(setting, rays, hits) casts all rays.
template <class Cast>
void run(benchmark::State& state, const Case& on, Cast cast, bool is_embree = false) {
  const Setting& s = setting_of(on.count);
  const Rays& r = rays_of(on.count, on.coherent);
  rays::RayHits hits;
  cast(s, r, hits);
  // Against the plain walk, which equals testing every box. Embree may leave out a box at the very distance
  // of the one it has (a tie; ours is the lower id), and by its own rounding one that a ray merely grazes.
  std::size_t ties = 0, grazed = 0;
  for (std::size_t i = 0; i < r.grid.size(); ++i) {
    const bool same_distance = hits.distance[i] == r.expected.distance[i];
    if (same_distance && hits.object[i] == r.expected.object[i]) continue;
    (same_distance ? ties : grazed) += 1;
  }
  if (is_embree ? grazed > r.grid.size() / 100 : ties + grazed > 0) {
    state.SkipWithError("a hit differs from the plain walk's");
    return;
  }
  for (auto _ : state) cast(s, r, hits);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(r.grid.size()));
  state.counters["hits"] = static_cast<double>(hits.stats.hits);
  if (is_embree) {
    state.counters["ties"] = static_cast<double>(ties);
    state.counters["grazed"] = static_cast<double>(grazed);
  }
}

void wide_rays(benchmark::State& state, const Case& on) {
  run(state, on, [stack = rays::WideStack()](const Setting& s, const Rays& r, rays::RayHits& hits) mutable {
    rays::cast_wide(s.wide, r.grid, stack, hits);
  });
}
void wide_rays_avx2(benchmark::State& state, const Case& on) {
  const OnlyAvx2 without_avx512;
  wide_rays(state, on);
}
void wide_rays_all_cores(benchmark::State& state, const Case& on) {
  const JobSystem jobs = tbb_jobs();
  std::vector<rays::WideStack> stacks(jobs.threads);
  run(state, on, [&](const Setting& s, const Rays& r, rays::RayHits& hits) {
    rays::cast_wide(s.wide, r.grid, jobs, stacks, hits);
  });
  state.counters["threads"] = jobs.threads;
}
// As an engine calls it: rays are prepared on the way, and come row by row.
void box_bvh(benchmark::State& state, const Case& on) {
  run(state, on, [&](const Setting& s, const Rays& r, rays::RayHits& hits) {
    hits.object.resize(r.grid.size()), hits.distance.resize(r.grid.size());
    if (!const_cast<BoxBvh&>(s.face).cast(r.grid.rays, hits.object, hits.distance)) std::abort();
  });
}
void boca(benchmark::State& state, const Case& on) {
  run(state, on, [](const Setting& s, const Rays& r, rays::RayHits& hits) {
    methods::cast_down_bvh(s.bvh, r.grid.prepared, hits);
  });
}
void skip_counts(benchmark::State& state, const Case& on) {
  run(state, on, [](const Setting& s, const Rays& r, rays::RayHits& hits) {
    methods::cast_by_skip_counts(s.bvh.nodes(), r.grid.prepared, hits);
  });
}

template <class Function>
benchmark::internal::Benchmark* add(const std::string& name, const Case& on, Function function) {
  const std::string rays = on.coherent ? "" : "Random";
  return benchmark::RegisterBenchmark(("BM_" + name + rays + "/" + std::to_string(on.count)).c_str(),
                                      [on, function](benchmark::State& state) { function(state, on); })
      ->Unit(benchmark::kMillisecond);
}

void add_all(const Case& on) {
  add("WideRays", on, wide_rays);
  add("WideRaysAvx2", on, wide_rays_avx2);
  add("BoxBvh", on, box_bvh);
  for (const EmbreeForm& form : embree_forms()) {
    const std::string name = form.name;
    const auto add_scene = [&](const std::string& called, std::unique_ptr<EmbreeBoxes> Setting::*scene) {
      add(called, on, [name, scene](benchmark::State& state, const Case& with) {
        const auto cast = [&](const Setting& s, const Rays& r, rays::RayHits& hits) {
          r.embree.at(name)(*(s.*scene), hits);
        };
        run(state, with, cast, true);
      });
    };
    add_scene(name, &Setting::fast);
    add_scene(name + "Robust", &Setting::robust);
    // Without AVX-512 Embree takes packets of 16 apart, and what they bear is lost.
    if (name != "Embree16") add_scene(name + "Avx2", &Setting::avx2);
  }
  if (!on.coherent) return;
  add("WideRaysAllCores", on, wide_rays_all_cores)->UseRealTime();
  add("Boca", on, boca);
  add("SkipCounts", on, skip_counts);
}

const int added = [] {
  for (const bool coherent : {true, false}) {
    for (const std::int64_t count : {1371, 17773, 1'000'000}) add_all({count, coherent});
  }
  return 0;
}();

}  // namespace
}  // namespace sightline::benchmarks
