// What the methods of paper D share.
#pragma once

#include "workbench/methods/methods.hpp"

namespace sightline::methods {

/// The parameter `submission`.
Submission submission_from(const Parameters& parameters) noexcept;

}  // namespace sightline::methods
