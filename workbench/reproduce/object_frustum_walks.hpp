// The grids of the paper's figures 4 and 6 as they are drawn.
#pragma once

#include <vector>

#include "workbench/reproduce/object_frustum.hpp"
#include "workbench/reproduce/object_frustum_cells.hpp"

namespace sightline::reproduce {

/// How many of `all` are not among `some`.
std::size_t missing_of(const std::vector<ObjectId>& all, const std::vector<ObjectId>& some);

/// The viewpoint of the figure: before the middle of row 1, level, looking along the columns; drawn square.
Camera walk_camera(const WalkFigure& figure);

/// The figure's cells as a walk lists them; lost where the repaired walk has them and this one has not.
std::vector<DrawnCell> walk_cells(const WalkFigure& figure, const CellLists& lists);

}  // namespace sightline::reproduce
