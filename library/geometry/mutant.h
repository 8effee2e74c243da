// Small deliberate faults, for C++ and GLSL alike. In builds with SIGHTLINE_MUTANTS one of those that
// tests/mutants/table.txt lists is planted by its name in the environment's SIGHTLINE_MUTANT, and
// SIGHTLINE_MUTANT(name) says whether it is this one. In all other builds it is false, and nothing is left of
// it.
#ifndef SIGHTLINE_LIBRARY_GEOMETRY_MUTANT_H
#define SIGHTLINE_LIBRARY_GEOMETRY_MUTANT_H

#ifndef SIGHTLINE_MUTANTS

#define SIGHTLINE_MUTANT(name) false

#elif !defined(__cplusplus)

#include "sightline_mutants.h"

layout(constant_id = 100) const uint planted_mutant = 0;
#define SIGHTLINE_MUTANT(name) (planted_mutant == name)

#else

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace sightline::mutants {

using uint = unsigned;
#include "sightline_mutants.h"

/// Ends the program where there is no mutant of that name: a test that plants nothing kills nothing.
inline uint number_of(const char* name) noexcept {
  if (name == nullptr) return 0;
  for (uint i = 0; i < sizeof kNames / sizeof kNames[0]; ++i) {
    if (std::strcmp(kNames[i], name) == 0) return i + 1;
  }
  std::fprintf(stderr, "SIGHTLINE_MUTANT: there is no mutant named %s\n", name);
  std::_Exit(3);
}

inline const uint kPlanted = number_of(std::getenv("SIGHTLINE_MUTANT"));

}  // namespace sightline::mutants

#define SIGHTLINE_MUTANT(name) (sightline::mutants::kPlanted == sightline::mutants::name)

#endif
#endif
