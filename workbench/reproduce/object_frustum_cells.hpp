// Cells of a grid seen from above, as the paper's figures 4, 6 and 7 draw them.
#pragma once

#include <string>
#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/view.hpp>

#include "workbench/partition/object_grid.hpp"

namespace sightline::reproduce {

struct DrawnCell {
  enum class Kind : std::uint8_t { outside, inside, crossing, lost };
  Box ground;  ///< x and z
  std::string number;
  Kind kind = Kind::outside;
};

/// The cells in the colours of their kinds, numbered, those that cross the limits crossed out; the limits of
/// sight of a level camera; `kept` and `dropped` objects as dots. An SVG element, `width` pixels wide.
std::string draw_cells(const std::vector<DrawnCell>& cells, const Camera& camera, float aspect,
                       const std::vector<Box>& kept, const std::vector<Box>& dropped, std::uint32_t width);

/// "3.2": row 3 counted from the one nearest to a viewpoint that looks along -z, column 2 from the left.
std::string cell_number(const partition::ObjectGrid& grid, std::uint32_t row, std::uint32_t column);

}  // namespace sightline::reproduce
