// Boxes seen from above as a path of an SVG drawing.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sightline::report {

/// In a drawing's units; x to the right, y down.
struct FlatBox {
  std::int32_t x0, y0, x1, y1;
  auto operator<=>(const FlatBox&) const = default;
};

/// The value of a path's `d` that outlines these boxes, each once. More than `most` are widened to ever
/// coarser grids, on which ever more of them are the same.
std::string path_of(std::vector<FlatBox> boxes, std::size_t most);

}  // namespace sightline::report
