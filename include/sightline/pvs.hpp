// Potentially visible sets baked for the cells of a grid over a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/status.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// What CellPvs::cell_at() says where there is no open cell.
inline constexpr std::uint32_t kNoCell = 0xffffffffu;
inline constexpr std::uint64_t kMostCells = std::uint64_t{1} << 22;  ///< that are baked and read

/// One set of objects a cell. Cells run x first, then y, then z.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: many may read. Allocates:
/// nothing.
struct CellPvs {
  Box bounds;                             ///< of all cells together, in metres
  std::array<std::uint32_t, 3> counts{};  ///< cells along x, y and z
  std::uint32_t objects = 0;              ///< of the scene it was baked for
  std::uint64_t scene = 0;                ///< its fingerprint()
  std::vector<std::uint8_t> open;         ///< one a cell: 0 where nobody can be, and nothing is known
  std::vector<std::uint64_t> first;    ///< cell c's objects are visible[first[c]] … visible[first[c + 1])
  std::vector<std::uint32_t> visible;  ///< ascending within a cell

  /// How many cells there are.
  [[nodiscard]] std::size_t size() const noexcept { return open.size(); }
  /// The open cell that holds the point, or kNoCell.
  [[nodiscard]] std::uint32_t cell_at(const Vec3& point) const noexcept;
  /// In metres, of cell < size().
  [[nodiscard]] Box cell_bounds(std::uint32_t cell) const noexcept;
  /// The objects of cell < size(), ascending.
  [[nodiscard]] std::span<const std::uint32_t> seen_from(std::uint32_t cell) const noexcept {
    return std::span(visible).subspan(first[cell], first[cell + 1] - first[cell]);
  }
};

/// Reads the bytes of a file that write_pvs or `sightline bake` made.
/// Errors: bad_file for what is damaged, truncated, of another version, or no such file at all; index() is
/// the byte where that was found, where one is to blame. Safe with any bytes. A library built without
/// SIGHTLINE_PVS refuses all. Cost: linear. Threads: any. Allocates: the cells, no more than a sound header
/// allows.
Result<CellPvs> read_pvs(std::span<const std::byte> bytes);

/// The bytes of a file: the same for the same sets, in whichever layout is shortest.
/// Errors: bad_argument for cells that are not as CellPvs says; too_many for more than 2^30 objects, and for
/// sets that are larger than read_pvs would read. Cost: compresses, seconds for large ones. Threads: any.
/// Allocates: several times the sets.
Result<std::vector<std::byte>> write_pvs(const CellPvs& cells);

}  // namespace sightline
