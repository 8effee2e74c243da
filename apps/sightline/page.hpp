// The report of a comparison.
#pragma once

#include <string>

#include "workbench/measure/compare.hpp"

namespace sightline::app {

/// Writes the page and its pictures, with the view that shows most. Throws Error where it cannot.
void write_page(const std::string& folder, measure::Bench& bench, const measure::Comparison& comparison);

}  // namespace sightline::app
