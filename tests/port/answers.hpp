// Answers as lines of "name hash", to be held against those of other builds and processors and against the
// pinned ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <hwy/highway.h>

namespace sightline::test {

/// FNV-1a of the values' bytes.
class Hash {
public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) state_ = (state_ ^ byte) * 0x100000001b3u;
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

struct Answers {
  std::uint32_t threads;  ///< for whoever takes jobs
  std::vector<std::string> lines = {};

  void add(const std::string& name, const Hash& hash) {
    char line[24];
    std::snprintf(line, sizeof line, " %016llx", static_cast<unsigned long long>(hash.value()));
    lines.push_back(name + line);
  }
  template <class Range>
  void add_all(const std::string& name, const Range& values) {
    Hash hash;
    for (const auto& value : values) hash.add(value);
    add(name, hash);
  }
};

/// Prints what `ask(answers)` answers on one thread by the vector instructions at hand, and says on stderr
/// where 2 … 8 threads or other vector instructions that the processor has answer otherwise: lines of the
/// same names, or some of them. Returns how many times they did.
template <class Ask>
int print_answers(const Ask& ask) {
  Answers first{1};
  ask(first);
  for (const std::string& line : first.lines) std::puts(line.c_str());
  int others = 0;
  const auto compare = [&](std::uint32_t threads, const char* target) {
    Answers again{threads};
    ask(again);
    for (const std::string& line : again.lines) {
      if (std::ranges::find(first.lines, line) != first.lines.end()) continue;
      std::fprintf(stderr, "%u threads, %s: %s\n", threads, target, line.c_str());
      ++others;
    }
  };
#ifdef HWY_COMPILE_ONLY_STATIC
  for (std::uint32_t threads = 2; threads <= 8; ++threads) compare(threads, "the only target");
#else
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (target == HWY_SCALAR || target == HWY_EMU128)
      continue;  // for whoever has no vector instructions at all
    hwy::SetSupportedTargetsForTest(target);
    std::fprintf(stderr, "by %s\n", hwy::TargetName(target));
    for (std::uint32_t threads = 1; threads <= 8; ++threads) compare(threads, hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
#endif
  return others;
}

}  // namespace sightline::test
