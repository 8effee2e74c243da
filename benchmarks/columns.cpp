// What layers, distances and levels of detail cost a cull: where all of a chunk's objects have the same in
// common, and where each object has its own; beside a world that has no columns.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

struct Columns {
  std::vector<std::uint32_t> layers;
  std::vector<DistanceRange> distances;
};

// A million boxes as case_of() has them, and of each what `give` says.
struct Filtered {
  World world;
  Columns columns;
  const Boxes& flat;

  explicit Filtered(const std::function<void(const Vec3&, Columns&)>& give) : flat(case_of(1'000'000).flat) {
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const Box b = flat[i];
      give({0.5f * (b.min.x + b.max.x), 0.5f * (b.min.y + b.max.y), 0.5f * (b.min.z + b.max.z)}, columns);
    }
    std::vector<Handle> handles(flat.size());
    ObjectColumns given;
    if (!columns.layers.empty()) given.layers = std::span<const std::uint32_t>(columns.layers);
    if (!columns.distances.empty()) given.distances = std::span<const DistanceRange>(columns.distances);
    or_throw(world.insert(flat.view(), handles, given));
  }
};

// Judged by the columns, of what a world without any sees.
void cull(benchmark::State& state, const Filtered& world, std::uint32_t layers) {
  const CullView view{.view = {looking(0.3f, tenth_of_view()), {}}, .layers = layers};
  std::vector<ObjectId> plain(cull_capacity(world.world)), visible(plain.size());
  Culler culler;
  const CullView all{.view = view.view};
  const std::size_t in_view = culler.cull(case_of(1'000'000).world, all, plain)->count;
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(world.world, view, visible));
  std::size_t expected = 0;
  for (const ObjectId id : std::span(plain).first(in_view)) {
    const Box b = world.flat[id];
    const double x = 0.5 * (b.min.x + b.max.x), y = 0.5 * (b.min.y + b.max.y) - 5,
                 z = 0.5 * (b.min.z + b.max.z), d = std::sqrt(x * x + y * y + z * z);
    const bool in_layer = world.columns.layers.empty() || (world.columns.layers[id] & layers) != 0;
    const bool in_range = world.columns.distances.empty() ||
                          (d >= world.columns.distances[id].min && d < world.columns.distances[id].max);
    expected += in_layer && in_range;
  }
  state.counters["visible"] = static_cast<double>(result.count);
  state.counters["tested"] = static_cast<double>(result.tested);
  if (result.count > expected + 10 || expected > result.count + 10) state.SkipWithError("a wrong answer");
}

void plain(benchmark::State& state) {
  static const Filtered world([](const Vec3&, Columns&) {});
  cull(state, world, kAllLayers);
}
void all_layers(benchmark::State& state) {
  static const Filtered world([](const Vec3&, Columns& c) { c.layers.push_back(6); });
  cull(state, world, 2);
}
void all_columns(benchmark::State& state) {
  static const Filtered world([](const Vec3&, Columns& c) {
    c.layers.push_back(6), c.distances.push_back({0, 5000});
  });
  cull(state, world, 2);
}
// Districts of 500 m: chunks at their borders alone are looked into.
void districts(benchmark::State& state) {
  static const Filtered world([](const Vec3& at, Columns& c) {
    c.layers.push_back(1u << ((at.x > 0) + 2 * (at.z > -500)));
    c.distances.push_back({0, at.x > 0 ? 5000.0f : 800.0f});
  });
  cull(state, world, 5);
}
void random_layers(benchmark::State& state) {
  static scene::Random random(2);
  static const Filtered world([](const Vec3&, Columns& c) { c.layers.push_back(1u << random.below(4)); });
  cull(state, world, 7);
}
void random_columns(benchmark::State& state) {
  static scene::Random random(3);
  static const Filtered world([](const Vec3&, Columns& c) {
    c.layers.push_back(1u << random.below(4));
    c.distances.push_back({random.between(0, 100), random.between(500, 3000)});
  });
  cull(state, world, 7);
}

// Each object with a table of its own choice among so many, and, where asked, layers of its own, too.
struct Levelled : Filtered {
  Levelled(std::uint32_t tables, bool layered)
      : Filtered([random = scene::Random(2), layered](const Vec3&, Columns& c) mutable {
          if (layered) c.layers.push_back(1u << random.below(4));
        }) {
    scene::Random random(4);
    std::vector<LevelTableId> of_object;
    std::vector<Handle> handles;
    for (std::uint32_t t = 0; t < tables; ++t) {
      const float largest = 200.0f * std::pow(0.5f, static_cast<float>(t % 4)) * random.between(0.9f, 1.1f);
      const std::array sizes{largest, largest / 3, largest / 9, largest / 27};
      if (!world.add_levels(sizes)) throw Error("a table of levels was refused");
    }
    for (std::uint32_t id = 0; id < world.id_limit(); ++id) {
      handles.push_back(world.handle(id));
      of_object.push_back(1 + random.below(tables));
    }
    or_throw(world.set_levels(handles, std::span<const LevelTableId>(of_object)));
  }
};

constexpr double kWalked = 1.5, kFlown = 30;  // metres a second

// By a camera that goes on and back at 60 frames a second, so that levels change.
void levels(benchmark::State& state, Levelled& world, const LevelOptions& chosen, std::uint32_t layers,
            double speed = kWalked) {
  std::vector<ObjectId> visible(cull_capacity(world.world));
  std::vector<std::uint8_t> levels(visible.size()), fades(chosen.fade > 0 ? visible.size() : 0);
  Culler culler;
  CullResult result;
  const CullOptions options{.levels = chosen};
  std::vector<CullView> views;
  for (int i = 0; i < 64; ++i) {
    CullView view{.view = {looking(0.3f, tenth_of_view()), {}}, .layers = layers};
    view.view.origin.x = std::abs(i - 32) * speed / 60;
    views.push_back(view);
  }
  std::size_t frame = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(result = *culler.cull(world.world, {&views[frame++ % views.size()], 1}, options,
                                                   {visible, {}, levels, fades}));
  state.counters["visible"] = static_cast<double>(result.count);
  // Judged by the passes without levels.
  std::vector<ObjectId> plain(visible.size());
  if (culler.cull(world.world, views[(frame - 1) % views.size()], plain)->count != result.count)
    state.SkipWithError("a wrong answer");
}

constexpr LevelOptions kHeld{.hysteresis = 0.1f}, kFaded{.hysteresis = 0.1f, .fade = 0.2f};

Levelled& shared_tables() {
  static Levelled world(4, false);
  return world;
}
void shared_levels(benchmark::State& state) {
  levels(state, shared_tables(), {}, kAllLayers);
}
void held_levels(benchmark::State& state) {
  levels(state, shared_tables(), kHeld, kAllLayers);
}
void faded_levels(benchmark::State& state) {
  levels(state, shared_tables(), kFaded, kAllLayers);
}
void own_levels(benchmark::State& state) {
  static Levelled world(65535, false);
  levels(state, world, kHeld, kAllLayers);
}
void flown_levels(benchmark::State& state) {
  levels(state, shared_tables(), kHeld, kAllLayers, kFlown);
}
Levelled& layered() {
  static Levelled world(65535, true);
  return world;
}
void layers_and_levels(benchmark::State& state) {
  levels(state, layered(), kHeld, 7);
}
void layers_and_levels_flown(benchmark::State& state) {
  levels(state, layered(), kHeld, 7, kFlown);
}

BENCHMARK(plain)->Name("columns/none")->Unit(benchmark::kMicrosecond);
BENCHMARK(all_layers)->Name("columns/whole_layers")->Unit(benchmark::kMicrosecond);
BENCHMARK(all_columns)->Name("columns/whole")->Unit(benchmark::kMicrosecond);
BENCHMARK(districts)->Name("columns/districts")->Unit(benchmark::kMicrosecond);
BENCHMARK(random_layers)->Name("columns/random_layers")->Unit(benchmark::kMicrosecond);
BENCHMARK(shared_levels)->Name("columns/levels")->Unit(benchmark::kMicrosecond);
BENCHMARK(held_levels)->Name("columns/levels_held")->Unit(benchmark::kMicrosecond);
BENCHMARK(faded_levels)->Name("columns/levels_faded")->Unit(benchmark::kMicrosecond);
BENCHMARK(own_levels)->Name("columns/own_levels_held")->Unit(benchmark::kMicrosecond);
BENCHMARK(flown_levels)->Name("columns/levels_held_flown")->Unit(benchmark::kMicrosecond);
BENCHMARK(layers_and_levels)->Name("columns/random_layers_and_levels")->Unit(benchmark::kMicrosecond);
BENCHMARK(layers_and_levels_flown)
    ->Name("columns/random_layers_and_levels_flown")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(random_columns)->Name("columns/random")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
