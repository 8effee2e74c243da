// What stands before the first frame: structures over a million boxes, and what they hold.
#include "startup.hpp"

#include <sightline/occlusion.hpp>
#include <sightline/rays.hpp>

#include "embree_boxes.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr std::size_t kBoxes = 1'000'000;

void world(benchmark::State& state) {
  const Case& c = case_of(kBoxes);
  std::vector<Handle> handles(kBoxes);
  start_up(state, Held::counted, [&] {
    World made;
    or_throw(made.insert(c.flat.view(), handles));
    return made;
  });
}

// With its first cull, in which it grows to the world's size.
void culler(benchmark::State& state) {
  const Case& c = case_of(kBoxes);
  std::vector<ObjectId> visible(cull_capacity(c.world));
  const CullView view{.view = {looking(0.3f, tenth_of_view()), {}}};
  start_up(state, Held::counted, [&] {
    Culler made;
    or_throw(made.cull(c.world, view, visible));
    return made;
  });
}

void box_bvh(benchmark::State& state) {
  const Boxes& boxes = case_of(kBoxes).flat;
  start_up(state, Held::counted, [&] {
    BoxBvh made;
    or_throw(made.build(boxes.view()));
    return made;
  });
}

void embree(benchmark::State& state) {
  const Boxes& boxes = case_of(kBoxes).flat;
  start_up(state, Held::elsewhere, [&] { return std::make_unique<EmbreeBoxes>(boxes, RTC_SCENE_FLAG_NONE); });
}

// With its first frame of 1280 × 720 pixels.
void occlusion_buffer(benchmark::State& state) {
  const View view = looking(0.3f, 1);
  start_up(state, Held::elsewhere, [&] {
    OcclusionBuffer made;
    or_throw(made.begin({view, {}}));
    return made;
  });
}

BENCHMARK(world)->Unit(benchmark::kMillisecond);
BENCHMARK(culler)->Unit(benchmark::kMillisecond);
BENCHMARK(box_bvh)->Unit(benchmark::kMillisecond);
BENCHMARK(embree)->Unit(benchmark::kMillisecond);
BENCHMARK(occlusion_buffer)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
