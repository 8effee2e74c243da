// How long something over a million boxes takes to make, and what it holds.
#pragma once

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <fstream>
#include <optional>
#include <string>

namespace sightline::benchmarks {

/// Whether all that is made is of this library's or malloc's, so that it can be counted.
enum class Held { counted, elsewhere };

/// Of all memory of its own that the process has mapped: "VmData:   123 kB".
inline double mapped_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0;
    if (word == "VmData:" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

/// What malloc has given out, and what is mapped besides malloc's own: large vectors are mapped by
/// themselves.
inline double bytes_held() {
  const struct mallinfo2 now = mallinfo2();
  const auto given = static_cast<double>(now.uordblks + now.hblkhd),
             of_malloc = static_cast<double>(now.arena + now.hblkhd);
  return given + mapped_bytes() - of_malloc;
}

template <class Make>
void start_up(benchmark::State& state, Held held, const Make& make) {
  double bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const double before = bytes_held();
    state.ResumeTiming();
    std::optional made(make());
    state.PauseTiming();
    bytes = bytes_held() - before;
    made.reset();
    state.ResumeTiming();
  }
  if (held == Held::counted) state.counters["bytes_each"] = bytes / 1e6;
}

}  // namespace sightline::benchmarks
