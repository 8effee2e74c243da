#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "command.hpp"

namespace sightline::app {

std::string in_words(double seconds) {
  const auto whole = static_cast<long long>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::function<void(std::size_t, std::size_t)> progress(std::string what) {
  using Clock = std::chrono::steady_clock;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  // Into a file goes a line now and then: a long silence looks like a hang.
  const auto pause = terminal ? std::chrono::milliseconds(100) : std::chrono::seconds(30);
  // Rate and time left are of what was done here: what was resumed took no time. A count that falls is that
  // of the next part of the work.
  return [what = std::move(what), terminal, pause, start = Clock::now(), last = Clock::now(),
          first = std::size_t{0}, before = std::size_t(-1)](std::size_t done, std::size_t all) mutable {
    const auto now = Clock::now();
    if (done < before) first = done, start = now;
    before = done;
    const bool over = done >= all;
    if (now - last < pause && !(over && terminal)) return;
    last = now;
    if (over) {
      // The line is wiped at the end: what stays on the terminal is the result.
      if (terminal) std::fputs("\r\033[K", stderr);
    } else {
      const double seconds = std::chrono::duration<double>(now - start).count();
      const double rate = seconds > 0 ? static_cast<double>(done - first) / seconds : 0;
      const std::string left = rate > 0 ? fmt::format(", {:.3g}/s, about {} left", rate,
                                                      in_words(static_cast<double>(all - done) / rate))
                                        : std::string();
      const std::string line = fmt::format("{}: {} of {}{}", what, done, all, left);
      fmt::print(stderr, "{}{}{}", terminal ? "\r" : "", line, terminal ? "\033[K" : "\n");
    }
    std::fflush(stderr);
  };
}

}  // namespace sightline::app
