// The walk over a grid of cells as Le Hoang Minh et al. 2022, section 3, prints it.
#pragma once

#include <vector>

#include <sightline/view.hpp>

#include "workbench/partition/object_grid.hpp"

namespace sightline::methods {

/// Appends the cells of BLi (inside) and BLc (crossing), one a run, as the printed steps find them: line by
/// line from the viewpoint's to the far limit; of each line the cell straight ahead by its distance alone,
/// then to the left and to the right the cells that the limit of that side crosses. A cell that the limit
/// misses is deleted with all beyond it, also where it lies wholly within the angle: that is how the walk
/// loses objects. Its lines run across the axis that the view is nearest to.
void walk_as_printed(const partition::ObjectGrid& grid, const View& view, const Frustum& frustum,
                     std::vector<partition::ObjectGrid::Run>& runs);

}  // namespace sightline::methods
