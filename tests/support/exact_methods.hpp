// Methods that lose nothing, so that every loss in a test was put there.
#pragma once

#include <string>
#include <vector>

namespace sightline::test {

inline const std::vector<std::string> kExactMethods{"none", "vfc-vc", "grid-cell", "object-frustum"};

}  // namespace sightline::test
