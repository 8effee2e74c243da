// The report of a comparison, with pictures of the view that says most.
#pragma once

#include <string>

#include "lab/fate.hpp"
#include "lab/measure.hpp"

namespace sightline::app {

/// Writes index.html and its pictures into `folder`.
void write_page(const std::string& folder, const Scene& scene, const lab::EmbreeJudge& judge,
                std::span<const lab::Contestant> contestants, const lab::Comparison& comparison);

}  // namespace sightline::app
