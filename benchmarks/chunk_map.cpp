// What keeping the chunk map right costs beside building it anew.
#include <benchmark/benchmark.h>

#include <sightline/boxes.hpp>

#include "library/world/chunk_map.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::world {
namespace {

constexpr std::size_t kObjects = 1'000'000;
constexpr Box kGround{{-1000, 0, -1000}, {1000, 100, 1000}};

Boxes random_boxes() {
  scene::Random random(1);
  Boxes boxes;
  boxes.reserve(kObjects);
  for (std::size_t i = 0; i < kObjects; ++i) {
    const Vec3 at = random.inside(kGround), half = random.inside({{0.1f, 0.1f, 0.1f}, {1, 1, 1}});
    boxes.push_back(
        {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
  }
  return boxes;
}

const Boxes& boxes() {
  static const Boxes made = random_boxes();
  return made;
}

void rebuild(benchmark::State& state) {
  for (auto _ : state) {
    ChunkMap map({kGround, 3});
    map.insert_all(boxes());
    benchmark::DoNotOptimize(map.size());
  }
}
BENCHMARK(rebuild)->Unit(benchmark::kMillisecond);

// One in `share` objects moves by up to a metre, or anywhere.
void move_objects(benchmark::State& state, bool anywhere) {
  ChunkMap map({kGround, 3});
  map.insert_all(boxes());
  scene::Random random(2);
  const std::size_t moved = kObjects * static_cast<std::size_t>(state.range(0)) / 100;
  std::vector<ObjectId> ids(moved);
  std::vector<Box> to(moved);
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t i = 0; i < moved; ++i) {
      ids[i] = random.below(kObjects);
      Box box = map.box(ids[i]);
      Vec3 by = random.inside({{-1, 0, -1}, {1, 0, 1}});
      if (anywhere) {
        const Vec3 at = random.inside(kGround);
        by = {at.x - box.min.x, at.y - box.min.y, at.z - box.min.z};
      }
      to[i] = {{box.min.x + by.x, box.min.y + by.y, box.min.z + by.z},
               {box.max.x + by.x, box.max.y + by.y, box.max.z + by.z}};
    }
    state.ResumeTiming();
    for (std::size_t i = 0; i < moved; ++i) map.move(ids[i], to[i]);
    map.tighten();
  }
}
BENCHMARK_CAPTURE(move_objects, nearby, false)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(move_objects, anywhere, true)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline::world
