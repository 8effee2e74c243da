// A job system of the caller's own: a thread a job.
#pragma once

#include <cstdint>
#include <thread>
#include <vector>

namespace sightline::test {

/// As JobSystem::run.
inline void run_threads(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < count; ++i) threads.emplace_back(job, data, i);
  for (std::thread& thread : threads) thread.join();
}

}  // namespace sightline::test
