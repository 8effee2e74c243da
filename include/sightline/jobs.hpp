// How the library runs on the caller's threads: it makes none of its own.
#pragma once

#include <cstdint>

namespace sightline {

/// Runs job(data, 0) … job(data, count - 1), on any threads, and returns when all are done.
struct JobSystem {
  void (*run)(void* user, std::uint32_t count, void (*job)(void* data, std::uint32_t index),
              void* data) = nullptr;
  void* user = nullptr;
  std::uint32_t threads = 1;  ///< how many jobs to make; 1 … kMaxJobs
};
inline constexpr std::uint32_t kMaxJobs = 64;

}  // namespace sightline
