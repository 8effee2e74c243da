// A job system of the caller's own: a thread a job; one after the other on WebAssembly, which has no threads.
#pragma once

#include <cstdint>

#ifndef __wasm__
#include <thread>
#include <vector>
#endif

namespace sightline::test {

/// As JobSystem::run.
inline void run_threads(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
#ifdef __wasm__
  for (std::uint32_t i = 0; i < count; ++i) job(data, i);
#else
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < count; ++i) threads.emplace_back(job, data, i);
  for (std::thread& thread : threads) thread.join();
#endif
}

}  // namespace sightline::test
