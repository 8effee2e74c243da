// The report of a comparison, with pictures of the view that says most.
#pragma once

#include <string>

#include "workbench/measure/measure.hpp"
#include "workbench/report/outcome.hpp"

namespace sightline::app {

/// Writes index.html and its pictures into `folder`.
void write_page(const std::string& folder, const Scene& scene, const oracle::EmbreeJudge& judge,
                std::span<const measure::Contestant> contestants, const measure::Comparison& comparison);

}  // namespace sightline::app
