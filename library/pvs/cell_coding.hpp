// All cells' sets as one matrix of bits, in Roaring bitmaps, laid so that a compressor finds what is alike:
//
//   1  layout          1  whether an order of the objects follows          1 a cell: 0 closed, 1 open,
//   2 … 4 open and the difference from the cell before it along x, y, z
//   4 an object, if ordered: which object stands at each place; first all low bytes, then the next
//
// then the rows (open cells, or places of objects), as many to a bitmap as 2^24 bits hold: 4 bytes of length
// and the bitmap. A row takes a whole number of bytes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sightline/pvs.hpp>
#include <sightline/status.hpp>

namespace sightline::pvs {

enum class Layout : std::uint8_t {
  by_cell,        ///< a row a cell
  by_difference,  ///< the same, each as its difference from the neighbour that is most alike
  by_object,      ///< a row an object: the cells it is seen from
};
inline constexpr Layout kLayouts[] = {Layout::by_cell, Layout::by_difference, Layout::by_object};

/// Which object stands at each place: each beside one that is seen from nearly the same cells. Empty, the
/// objects' own order, where to find one would take too long.
std::vector<std::uint32_t> object_order(const CellPvs& cells);

/// The same bytes for the same sets. By object needs an order.
std::vector<std::byte> code_cells(const CellPvs& cells, Layout layout, std::span<const std::uint32_t> order);

/// Fills in `open`, `first` and `visible` of `cells`, whose `counts` and `objects` are known and sound.
/// Refuses bytes that code_cells did not make (index: the cell, where one is to blame); allocates no more
/// than they and the cells account for.
Status decode_cells(std::span<const std::byte> bytes, CellPvs& cells);

}  // namespace sightline::pvs
