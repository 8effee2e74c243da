// Flat frustum culling of 10 k … 10 M boxes beside a bare read of the same bytes, a loop by hand for AVX-512
// and a scalar loop; boxes in no order, and neighbours with neighbouring ids. The library's answer must be
// the scalar loop's before it is timed; the loop by hand fuses products and sums and so may judge a box that
// touches a plane otherwise: it is judged like all, by what it loses.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <compare>
#include <map>
#include <string>
#include <vector>

#include <sightline/frustum.hpp>

#include "judged.hpp"
#include "only_avx2.hpp"
#include "plain_cull.hpp"
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

struct Case {
  std::size_t count;
  bool coherent;
  auto operator<=>(const Case&) const = default;
};

// Where a box lies on a curve through the plane that leaves no neighbourhood before it is done with it.
std::uint32_t place_of(const Box& box) {
  constexpr float kCell = 4;
  const auto x = static_cast<std::uint32_t>((box.min.x - kAround.min.x + 10) / kCell),
             z = static_cast<std::uint32_t>((box.min.z - kAround.min.z + 10) / kCell);
  std::uint32_t place = 0;
  for (std::uint32_t bit = 0; bit < 10; ++bit)
    place |= (x >> bit & 1) << 2 * bit | (z >> bit & 1) << (2 * bit + 1);
  return place;
}

const Boxes& boxes_of(const Case& on) {
  static std::map<Case, Boxes> worlds;
  Boxes& boxes = worlds[on];
  if (boxes.size() == on.count) return boxes;
  scene::Random random(1);
  std::vector<Box> made;
  for (std::size_t i = 0; i < on.count; ++i) {
    const Vec3 at = random.inside(kAround),
               half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
    made.push_back(
        {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
  }
  if (on.coherent) {
    std::stable_sort(made.begin(), made.end(),
                     [](const Box& a, const Box& b) { return place_of(a) < place_of(b); });
  }
  boxes.reserve(on.count);
  for (const Box& box : made) boxes.push_back(box);
  return boxes;
}

// About a quarter of the boxes is in view.
View view() {
  return *make_view({.eye = {0, 5, 0}, .forward = {0.3f, 0, -1}}, 1280, 720);
}

const Frustum& frustum() {
  static const Frustum made = make_frustum(view());
  return made;
}

void report(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(count * 6 * sizeof(float)));
}

// Runs it once before the clock runs: a hypervisor maps pages anew after others were freed.
template <class Pass>
void time(benchmark::State& state, const Pass& pass) {
  benchmark::DoNotOptimize(pass());
  for (auto _ : state) benchmark::DoNotOptimize(pass());
}

void bare_read(benchmark::State& state, const Case& on) {
  const Boxes& boxes = boxes_of(on);
  time(state, [&] { return HWY_DYNAMIC_DISPATCH(read_all)(boxes); });
  report(state, boxes.size());
}

bool as_scalar(const Boxes& boxes, std::span<const ObjectId> visible) {
  std::vector<ObjectId> expected(boxes.size() + kCullPadding);
  expected.resize(cull_boxes_scalar(frustum(), boxes, expected));
  return std::equal(visible.begin(), visible.end(), expected.begin(), expected.end());
}

template <class Cull>
void run(benchmark::State& state, const Case& on, const Cull& cull, bool fuses = false) {
  const Boxes& boxes = boxes_of(on);
  std::vector<ObjectId> visible(boxes.size() + kCullPadding);
  const std::size_t count = cull(boxes, visible);
  if (!fuses && !as_scalar(boxes, std::span(visible).first(count))) {
    state.SkipWithError("the answer differs from the scalar loop's");
    return;
  }
  time(state, [&] { return cull(boxes, visible); });
  report(state, boxes.size());
  const View seen_by = view();
  judge(state, boxes, {&seen_by, 1}, std::span(visible).first(count));
}

void flat_simd(benchmark::State& state, const Case& on) {
  run(state, on, [](const Boxes& boxes, std::span<ObjectId> visible) {
    return *cull_boxes(frustum(), boxes.view(), visible);
  });
}
void flat_simd_avx2(benchmark::State& state, const Case& on) {
  const OnlyAvx2 without_avx512;
  flat_simd(state, on);
}
void scalar_loop(benchmark::State& state, const Case& on) {
  run(state, on, [](const Boxes& boxes, std::span<ObjectId> visible) {
    return cull_boxes_scalar(frustum(), boxes, visible);
  });
}

template <class Function>
void add(const std::string& name, const Case& on, Function function) {
  const std::string ids = on.coherent ? "Coherent/" : "/";
  benchmark::RegisterBenchmark(("BM_" + name + ids + std::to_string(on.count)).c_str(),
                               [on, function](benchmark::State& state) { function(state, on); })
      ->Unit(benchmark::kMicrosecond);
}

const int added = [] {
  for (const bool coherent : {false, true}) {
    for (std::size_t count = 10'000; count <= 10'000'000; count *= 10) {
      const Case on{count, coherent};
      add("BareRead", on, bare_read);
      add("FlatSimd", on, flat_simd);
      add("FlatSimdAvx2", on, flat_simd_avx2);
      for (const PlainLoop& loop : plain_loops()) {
        add(loop.name, on, [&loop](benchmark::State& state, const Case& with) {
          run(
              state, with,
              [&](const Boxes& boxes, std::span<ObjectId> visible) {
                return loop.cull(frustum(), boxes, visible);
              },
              true);
        });
      }
      if (!coherent) add("ScalarLoop", on, scalar_loop);
    }
  }
  return 0;
}();

}  // namespace
}  // namespace sightline::benchmarks
#endif
