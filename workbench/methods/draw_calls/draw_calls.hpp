// What paper D gives to the registry.
#pragma once

#include <array>

#include "workbench/methods/methods.hpp"

namespace sightline::methods {

extern const std::array<MethodInfo, 9> kDrawCallMethods;
extern const MethodInfo kClusterCone;
extern const MethodInfo kAdaptive;

/// The parameter `submission`.
Submission submission_from(const Parameters& parameters) noexcept;

}  // namespace sightline::methods
