// Potentially visible sets baked for the cells of a grid over a scene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

}  // namespace sightline
