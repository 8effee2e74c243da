// How long something over a million boxes takes to make, and what it holds.
#pragma once

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <optional>

namespace sightline::benchmarks {

/// Whether all that is made lies on malloc's heap, so that it can be counted.
enum class Held { heap, elsewhere };

inline double heap_bytes() {
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks + now.hblkhd);
}

template <class Make>
void start_up(benchmark::State& state, Held held, const Make& make) {
  double bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const double before = heap_bytes();
    state.ResumeTiming();
    std::optional made(make());
    state.PauseTiming();
    bytes = heap_bytes() - before;
    made.reset();
    state.ResumeTiming();
  }
  if (held == Held::heap) state.counters["bytes_each"] = bytes / 1e6;
}

}  // namespace sightline::benchmarks
