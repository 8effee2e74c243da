// How the library runs on the caller's threads: it makes none of its own.
#pragma once

#include <cstdint>

namespace sightline {

/// The caller's threads: `run` calls job(data, 0) … job(data, count - 1), each once, in any order, on any
/// threads, and returns when all are done. Jobs neither throw nor wait for each other. Without `run` all work
/// is done by the calling thread. Answers are the same for any number of jobs and threads.
struct JobSystem {
  /// As said above; null where there are no threads but the calling one.
  void (*run)(void* user, std::uint32_t count, void (*job)(void* data, std::uint32_t index),
              void* data) = nullptr;
  void* user = nullptr;       ///< handed to run
  std::uint32_t threads = 1;  ///< how many jobs a call makes at most; 1 … kMaxJobs
};
/// The most jobs that a call is split into.
inline constexpr std::uint32_t kMaxJobs = 64;

}  // namespace sightline
