// Flat frustum culling of 10 k … 10 M boxes beside a bare read of the same bytes and a scalar loop. Each
// benchmark checks that its answer is the scalar loop's before it is timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

#include <sightline/frustum.hpp>

#include "judged.hpp"
#include "scalar_cull.hpp"
#include "workbench/scene/random.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "../benchmarks/frustum_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::benchmarks::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Reads all six arrays and adds them up, four accumulators deep: as fast as memory gives.
float read_all(const Boxes& boxes) {
  const hn::ScalableTag<float> f;
  const std::size_t lanes = hn::Lanes(f);
  auto a = hn::Zero(f), b = a, c = a;
  std::size_t i = 0;
  for (; i + lanes <= boxes.size(); i += lanes) {
    a = hn::Add(a, hn::Add(hn::LoadU(f, boxes.min_x.data() + i), hn::LoadU(f, boxes.max_x.data() + i)));
    b = hn::Add(b, hn::Add(hn::LoadU(f, boxes.min_y.data() + i), hn::LoadU(f, boxes.max_y.data() + i)));
    c = hn::Add(c, hn::Add(hn::LoadU(f, boxes.min_z.data() + i), hn::LoadU(f, boxes.max_z.data() + i)));
  }
  return hn::GetLane(hn::SumOfLanes(f, hn::Add(a, hn::Add(b, c))));
}

}  // namespace sightline::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::benchmarks {

HWY_EXPORT(read_all);

namespace {

constexpr Box kAround{{-1000, -50, -1000}, {1000, 50, 1000}};  // their centres

const Boxes& boxes_of(std::size_t count) {
  static std::map<std::size_t, Boxes> worlds;
  Boxes& boxes = worlds[count];
  if (boxes.size() == count) return boxes;
  scene::Random random(1);
  boxes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = random.inside(kAround),
               half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
    boxes.push_back(
        {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
  }
  return boxes;
}

// About a quarter of the boxes is in view.
View view() {
  return *make_view({.eye = {0, 5, 0}, .forward = {0.3f, 0, -1}}, 1280, 720);
}

Frustum frustum() {
  return make_frustum(view());
}

void report(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(count * 6 * sizeof(float)));
}

void BM_BareRead(benchmark::State& state) {
  const Boxes& boxes = boxes_of(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(read_all)(boxes));
  report(state, boxes.size());
}

template <class Cull>
void run(benchmark::State& state, const Cull& cull) {
  const Boxes& boxes = boxes_of(static_cast<std::size_t>(state.range(0)));
  std::vector<ObjectId> visible(boxes.size() + kCullPadding), expected(visible.size());
  const std::size_t count = cull(boxes, visible), right = cull_boxes_scalar(frustum(), boxes, expected);
  if (count != right ||
      !std::equal(visible.begin(), visible.begin() + static_cast<std::ptrdiff_t>(count), expected.begin())) {
    state.SkipWithError("the answer differs from the scalar loop's");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(cull(boxes, visible));
  report(state, boxes.size());
  const View seen_by = view();
  judge(state, boxes, {&seen_by, 1}, std::span(visible).first(count));
}

void BM_FlatSimd(benchmark::State& state) {
  run(state, [](const Boxes& boxes, std::span<ObjectId> visible) {
    return *cull_boxes(frustum(), boxes.view(), visible);
  });
}
void BM_ScalarLoop(benchmark::State& state) {
  run(state, [](const Boxes& boxes, std::span<ObjectId> visible) {
    return cull_boxes_scalar(frustum(), boxes, visible);
  });
}

BENCHMARK(BM_BareRead)->RangeMultiplier(10)->Range(10'000, 10'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_FlatSimd)->RangeMultiplier(10)->Range(10'000, 10'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_ScalarLoop)->RangeMultiplier(10)->Range(10'000, 10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
#endif
