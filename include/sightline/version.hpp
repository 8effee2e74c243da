// The version, written once: CMake reads it from here.
#pragma once

#include <string_view>

namespace sightline {

/// Major, minor and patch.
inline constexpr std::string_view kVersion = "0.1.0";

}  // namespace sightline
