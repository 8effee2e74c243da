// The report's pictures: the item buffer, and the world from above with every object's outcome.
#pragma once

#include <string>

#include <sightline/workbench/scene.hpp>

#include "workbench/report/canvas.hpp"
#include "workbench/report/outcome.hpp"

namespace sightline::report {

/// The colours of the outcomes, in their order; the page's legend uses the same.
Colour outcome_colour(Outcome outcome) noexcept;

/// Every object in a colour of its own, shaded by the slope of its surface; clear where nothing is seen. Half
/// the buffer's size: it is meant to be rendered at twice the size wanted.
Canvas draw_item_buffer(const View& view, const oracle::ItemBuffer& truth);

/// The world from above as an SVG document, x to the right and z down, objects as their bounds coloured by
/// outcome, with the eye and the outline of the frustum. `width` pixels wide at most, and not higher than 0.8
/// times that; at most 2 MB, whatever the number of objects.
std::string draw_top_view(const Scene& scene, const Snapshot& snapshot, const Snapshot::Method& method,
                          std::uint32_t width);

}  // namespace sightline::report
