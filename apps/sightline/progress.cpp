#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "command.hpp"

namespace sightline::app {

std::function<void(std::size_t, std::size_t)> progress(std::string what) {
  if (!isatty(STDERR_FILENO)) return [](std::size_t, std::size_t) {};
  using Clock = std::chrono::steady_clock;
  return [what = std::move(what), last = Clock::now()](std::size_t done, std::size_t all) mutable {
    const auto now = Clock::now();
    if (done < all && now - last < std::chrono::milliseconds(100)) return;
    last = now;
    // The line is wiped at the end: what stays on the terminal is the result.
    std::fprintf(stderr, done < all ? "\r%s: %zu of %zu" : "\r\033[K", what.c_str(), done, all);
    std::fflush(stderr);
  };
}

}  // namespace sightline::app
