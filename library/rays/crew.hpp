// A few threads that wait for work, so that none is made while a frame is.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#ifndef __wasm__
#include <thread>
#endif

namespace sightline::rays {

class Crew {
public:
  /// The caller is one of `threads`; 0: as many as the machine has cores. WebAssembly has one.
  explicit Crew(unsigned threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] unsigned size() const noexcept;
  /// Calls job(context, worker) once on each thread, worker 0 … size() - 1, and returns when all have.
  void run(void (*job)(void* context, unsigned worker), void* context) noexcept;
  template <class Job>
  void run(Job&& job) noexcept {
    run([](void* context, unsigned worker) { (*static_cast<Job*>(context))(worker); }, &job);
  }

private:
#ifndef __wasm__
  void serve(unsigned worker) noexcept;

  void (*job_)(void*, unsigned) = nullptr;  // null: go home
  void* context_ = nullptr;
  std::atomic<std::uint32_t> round_{0}, busy_{0};
  std::vector<std::thread> threads_;
#endif
};

}  // namespace sightline::rays
