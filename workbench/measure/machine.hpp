// The machine that figures were measured on; an absolute time means nothing without it.
#pragma once

#include <cstdint>
#include <string>

namespace sightline::measure {

struct Machine {
  std::string cpu, os, compiler;
  unsigned cores = 0;        ///< hardware threads
  std::uint64_t memory = 0;  ///< bytes
};

/// This machine; what it will not tell is called "unknown" or 0.
Machine this_machine();

}  // namespace sightline::measure
