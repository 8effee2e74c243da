// What a piece of work takes where two take turns frame by frame.
#pragma once

#include <time.h>

namespace sightline::benchmarks {

/// Milliseconds of this thread's own time: what others run meanwhile does not count.
double milliseconds(auto&& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

}  // namespace sightline::benchmarks
