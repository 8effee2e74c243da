// What the methods of paper D share.
#pragma once

#include <string_view>

#include "workbench/methods/methods.hpp"

namespace sightline::methods {

/// The parameters that take cells as `adaptive` does, where the defaults are the paper's.
inline constexpr std::string_view kTightCells = "least=11&cells=tight";

/// The parameter `submission`.
Submission submission_from(const Parameters& parameters) noexcept;

}  // namespace sightline::methods
