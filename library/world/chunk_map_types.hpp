// What a chunk map is told and tells.
#pragma once

#include <cstdint>

#include <sightline/boxes.hpp>

#include "library/geometry/box_reader.hpp"

namespace sightline::world {

/// Rows and columns of leaf regions, last ones included, that a box touches.
struct RegionSet {
  std::uint8_t first_x = 0, first_z = 0, last_x = 0, last_z = 0;
  bool operator==(const RegionSet&) const = default;
  /// Whether more than one region is touched.
  [[nodiscard]] bool shared() const noexcept { return first_x != last_x || first_z != last_z; }
};

/// The one vertex that stands for an object in the culling pass. The half extent is rounded up, so that
/// centre ± half_extent surely holds the box. Laid out as two vec4.
struct ChunkVertex {
  Vec3 centre;
  ObjectId object = kNoObject;
  Vec3 half_extent;
  std::uint32_t chunk = 0;
};

struct ChunkMapOptions {
  Box ground;               ///< its x-z rectangle is split; what stands outside belongs to the nearest region
  std::uint32_t depth = 3;  ///< of the quadtree, 0 … 6; 4^depth leaf regions
};

/// What a call that moves objects loosely knows of its frame.
struct Moving {
  std::uint16_t tick = 0;       ///< counts frames
  bool many = false;            ///< so many move that each becomes a mover at once
  std::uint32_t allowance = 0;  ///< how many may become movers for moving often
};

/// Where an object stood that stands elsewhere already.
struct Leaving {
  ObjectId object = kNoObject;
  std::uint32_t chunk = 0;
  std::uint32_t slot = 0;  ///< in 7 bits, and whether it was among movers, as ChunkMap::Location has them
};

/// The objects of a chunk: arrays of `count` values, aligned to 64 bytes and readable up to the next
/// multiple of 16, ids up to ChunkMap::kCapacity. Where it is loose, some objects may be kNoObject, and their
/// boxes mean nothing.
struct ChunkView {
  const float* sides;  ///< six rows: min x, y, z, max x, y, z
  const ObjectId* objects;
  std::uint32_t step;  ///< from one row to the next
  std::uint32_t count;
  bool loose;  ///< movers' or with holes

  [[nodiscard]] const float* side(std::size_t k) const noexcept { return sides + std::size_t{step} * k; }
  [[nodiscard]] geometry::BoxSpan boxes() const noexcept {
    return {side(0), side(1), side(2), side(3), side(4), side(5), count};
  }
  [[nodiscard]] Box box(std::size_t i) const noexcept {
    return {{side(0)[i], side(1)[i], side(2)[i]}, {side(3)[i], side(4)[i], side(5)[i]}};
  }
};

}  // namespace sightline::world
