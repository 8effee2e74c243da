// A hundred million plain boxes: what they take of memory, and what a cull of a million of them takes beside
// a world of that million alone.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <sightline/world.hpp>

#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr std::size_t kSlice = 1'000'000, kSlices = 100;
constexpr double kGiB = 1024.0 * 1024 * 1024;

double resident_GiB() {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  long all = 0, resident = 0;
  const bool read = file && std::fscanf(file, "%ld %ld", &all, &resident) == 2;
  if (file) std::fclose(file);
  return read ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / kGiB : 0;
}

double peak_GiB() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) * 1024 / kGiB;
}

// The million of case_of(), then as many again and again behind the eye, each 2 km farther: as dense, and in
// slices, as whoever loads a world brings it in.
struct Large {
  World world;
  double own_GiB = 0, peak = 0;

  Large() {
    const Case& c = case_of(kSlice);
    std::vector<Handle> handles(kSlice);
    std::vector<WorldBox> boxes(kSlice);
    const double before = resident_GiB();
    for (std::size_t slice = 0; slice < kSlices; ++slice) {
      for (std::size_t i = 0; i < kSlice; ++i) {
        boxes[i] = c.flat.view()[i];
        boxes[i].min.z += 2.0 * kReach * static_cast<double>(slice);
        boxes[i].max.z += 2.0 * kReach * static_cast<double>(slice);
      }
      or_throw(world.insert(BoxView(boxes), handles));
    }
    own_GiB = resident_GiB() - before, peak = peak_GiB();
  }
};

const Large& large() {
  static const Large made;
  return made;
}

CullView a_tenth() {
  return {.view = {looking(0.3f, tenth_of_view()), {}}};
}

std::vector<ObjectId> seen_of(const World& world) {
  std::vector<ObjectId> out(cull_capacity(world));
  Culler culler;
  out.resize(or_throw(culler.cull(world, a_tenth(), out)).count);
  std::ranges::sort(out);
  return out;
}

void cull(benchmark::State& state, const World& world) {
  std::vector<ObjectId> visible(cull_capacity(world));
  Culler culler;
  const CullView view = a_tenth();
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(world, view, visible));
  state.counters["visible"] = static_cast<double>(result.count);
}

void one_million(benchmark::State& state) {
  cull(state, case_of(kSlice).world);
}

void hundred_million(benchmark::State& state) {
  const Large& l = large();
  cull(state, l.world);
  static const bool same = seen_of(l.world) == seen_of(case_of(kSlice).world);
  if (!same) state.SkipWithError("the visible sets differ");
  state.counters["GiB"] = l.own_GiB, state.counters["peak_GiB"] = l.peak;
}

BENCHMARK(one_million)->Unit(benchmark::kMicrosecond);
BENCHMARK(hundred_million)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
