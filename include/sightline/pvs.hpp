// Potentially visible sets baked for the cells of a grid over a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <sightline/result.hpp>
#include <sightline/types.hpp>

namespace sightline {

inline constexpr std::uint32_t kNoCell = 0xffffffffu;
inline constexpr std::uint64_t kMostCells = std::uint64_t{1} << 22;  ///< that are baked and read

/// One set of objects a cell. Cells run x first, then y, then z.
struct CellPvs {
  Box bounds;
  std::array<std::uint32_t, 3> counts{};  ///< cells along x, y and z
  std::uint32_t objects = 0;              ///< of the scene it was baked for
  std::uint64_t scene = 0;                ///< its fingerprint()
  std::vector<std::uint8_t> open;         ///< one a cell: 0 where nobody can be, and nothing is known
  std::vector<std::uint64_t> first;    ///< cell c's objects are visible[first[c]] … visible[first[c + 1])
  std::vector<std::uint32_t> visible;  ///< ascending within a cell

  [[nodiscard]] std::size_t size() const noexcept { return open.size(); }
  /// The open cell that holds the point, or kNoCell.
  [[nodiscard]] std::uint32_t cell_at(const Vec3& point) const noexcept;
  [[nodiscard]] Box cell_bounds(std::uint32_t cell) const noexcept;
  [[nodiscard]] std::span<const std::uint32_t> seen_from(std::uint32_t cell) const noexcept {
    return std::span(visible).subspan(first[cell], first[cell + 1] - first[cell]);
  }
};

/// Reads the bytes of a file that write_pvs or `sightline bake` made. Refuses, in one sentence that begins
/// with `name`, what is damaged, truncated, of another version, or no such file at all. Safe with any bytes;
/// allocates no more than cells and objects of a sound header allow. A library that was built without
/// SIGHTLINE_PVS refuses all.
Result<CellPvs> read_pvs(std::span<const std::byte> bytes, std::string_view name = "pvs");

/// The bytes of a file. The same bytes for the same sets, in whichever layout is shortest; takes seconds for
/// large ones. Refuses cells that are not as CellPvs says, and sets that are larger than read_pvs would read.
Result<std::vector<std::byte>> write_pvs(const CellPvs& cells);

}  // namespace sightline
