#include "library/rays/crew.hpp"

#include <algorithm>

namespace sightline::rays {

#ifdef __wasm__

Crew::Crew(unsigned) {}
Crew::~Crew() = default;

unsigned Crew::size() const noexcept {
  return 1;
}

void Crew::run(void (*job)(void*, unsigned), void* context) noexcept {
  job(context, 0);
}

#else

Crew::Crew(unsigned threads) {
  const unsigned wanted = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  threads_.reserve(wanted - 1);
  for (unsigned worker = 1; worker < wanted; ++worker) {
    threads_.emplace_back([this, worker] { serve(worker); });
  }
}

Crew::~Crew() {
  job_ = nullptr;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

unsigned Crew::size() const noexcept {
  return static_cast<unsigned>(threads_.size()) + 1;
}

void Crew::run(void (*job)(void*, unsigned), void* context) noexcept {
  job_ = job, context_ = context;
  busy_.store(static_cast<std::uint32_t>(threads_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  job(context, 0);
  for (std::uint32_t busy; (busy = busy_.load(std::memory_order_acquire)) > 0;) busy_.wait(busy);
}

void Crew::serve(unsigned worker) noexcept {
  for (std::uint32_t round = 0;; ++round) {
    round_.wait(round, std::memory_order_acquire);
    if (!job_) return;
    job_(context_, worker);
    if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
  }
}

#endif

}  // namespace sightline::rays
