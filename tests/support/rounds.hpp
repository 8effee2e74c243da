// How much of a long test is run: all of it, but where that would take minutes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace sightline::test {

/// The value of a variable of the environment, or what it is otherwise.
inline std::uint64_t number_in(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Of so many random rounds those to be run: one in SIGHTLINE_ONE_ROUND_IN, from the first on. Where the
/// variable says nothing all, as in every release build; test.sh says four where memory and threads are
/// checked, and --full runs all there, too.
inline std::uint32_t rounds(std::uint32_t all) {
  const std::uint64_t one_in = std::max<std::uint64_t>(number_in("SIGHTLINE_ONE_ROUND_IN", 1), 1);
  return static_cast<std::uint32_t>((all + one_in - 1) / one_in);
}

}  // namespace sightline::test
