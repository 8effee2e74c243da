// Moves that are listed in no order, sorted by where their objects stand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/world.hpp>

namespace sightline::world {

/// A copy of some moves in the order of their objects' pages, in which memory is written from the front to
/// the back; the moves of one object stay in the order listed.
class ScatteredMoves {
public:
  /// Whether neighbours in the list stand here and there, by some of them.
  [[nodiscard]] static bool are_scattered(const Strided<const Handle>& handles) noexcept;

  /// Copies moves first … first + count - 1, of ids below `ids`, with boxes about this point: the one that
  /// they are given about in single precision, or else a sector's origin. False, with nothing of use, where a
  /// box may not have its centre in that sector.
  bool sort(const Strided<const Handle>& handles, const BoxView& boxes, const WorldPoint& about,
            std::size_t first, std::size_t count, std::size_t ids);
  [[nodiscard]] std::span<const Handle> handles() const noexcept;
  [[nodiscard]] std::span<const Box> boxes() const noexcept;

private:
#ifndef __wasm__                     // where movers have no pages
  std::vector<std::uint32_t> next_;  // of each page's moves where the next one goes
  std::vector<Handle> handles_;
  std::vector<Box> boxes_;
#endif
};

}  // namespace sightline::world
