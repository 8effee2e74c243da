// What moving many boxes at once stands on, in SIMD.
#pragma once

#include <cstdint>
#include <span>

#include <sightline/types.hpp>
#include <sightline/world.hpp>

#include "library/geometry/box_reader.hpp"

namespace sightline::world {

/// A chunk of movers.
struct MoverRun {
  const Box& bounds;
  const ObjectId* ids;
  float* boxes;  ///< its minimum x; the other sides `row` floats apart
  std::size_t row;
  std::uint32_t count;
  std::uint64_t* moved;  ///< a bit a slot
  bool past_cache;       ///< whole vectors need not stay in the cache
};

/// A page of movers.
struct PageRun {
  const Box &bounds, &within;  ///< in both of which boxes lie that are written
  ObjectId first;              ///< the object whose place is the first
  const ObjectId* ids;         ///< who stands there; null where all do
  float* boxes;                ///< its minimum x; the other sides `row` floats apart
  std::size_t row;
  std::uint64_t* moved;  ///< a bit a slot
  std::size_t& woken;    ///< counts those whose bit was not set
};

/// Writes the boxes of objects while each stands in its place of the page and lies within bounds. Returns how
/// many did.
std::uint32_t write_in_page(const PageRun& run, std::span<const ObjectId> objects, const Box* boxes) noexcept;
/// Makes holes of the objects whose bits are set, of `count` that are readable up to the next multiple of 16.
/// Returns how many it found.
std::uint32_t take_out(ObjectId* objects, std::uint32_t count, std::span<const std::uint32_t> bits) noexcept;
/// The union of boxes that lie as six rows, so many floats apart.
Box bounds_of_rows(const float* first, std::size_t step, std::uint32_t count) noexcept;
/// Lays at most a block of boxes out, an array a coordinate. Returns how far they reach from 0 on any axis.
float lay_out_structs(std::span<const Box> boxes, geometry::BoxBlock& out) noexcept;
/// The same of boxes of any form, about a sector's origin. Returns whether all surely have their centres in
/// it.
bool lay_out_in_sector(const BoxView& boxes, std::size_t first, std::size_t count, const WorldPoint& origin,
                       geometry::BoxBlock& out) noexcept;
/// Whether all are valid: min <= max within ±kWorldReach.
[[nodiscard]] bool boxes_are_sound(std::span<const Box> boxes) noexcept;

}  // namespace sightline::world
