// oneTBB's threads as a JobSystem. Header only and apart from <sightline/sightline.hpp>, so that the library
// itself needs no oneTBB: link TBB::tbb, or sightline::tbb where the package found it.
#pragma once

#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

#include <sightline/jobs.hpp>

namespace sightline {

/// Jobs that run in the calling thread's task arena. `threads` is how many jobs a call is split into, 1 …
/// kMaxJobs; 0: as many as oneTBB has threads. The answer is the same for every number.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing of ours.
inline JobSystem tbb_jobs(std::uint32_t threads = 0) {
  if (threads == 0) threads = static_cast<std::uint32_t>(std::max(tbb::info::default_concurrency(), 1));
  const auto run = [](void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
    // Each job is a task of its own: there are few, and they are long.
    const auto task = [=](std::uint32_t i) { job(data, i); };
    tbb::parallel_for(std::uint32_t{0}, count, task, tbb::simple_partitioner{});
  };
  return {run, nullptr, std::clamp(threads, 1u, kMaxJobs)};
}

}  // namespace sightline
