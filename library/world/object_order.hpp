// What stands behind sightline::ObjectOrder: of each chunk where its slots begin.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/ranges.hpp>

#include "library/geometry/aligned_vector.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

/// A sector's, by chunk.
struct SectorOrder {
  std::vector<std::uint32_t> first;  ///< slot, of the chunk's object 0
  std::vector<std::uint8_t> room;    ///< slots; 0: the chunk has none
};

struct OrderState {
  std::vector<SectorOrder> sectors;
  geometry::LargeVector<ObjectId> objects;           ///< one a slot
  geometry::LargeVector<std::uint32_t> generations;  ///< theirs, as ids are used again
  std::vector<SlotChange> changes;
  /// Where free slots begin, by how many there are.
  std::array<std::vector<std::uint32_t>, ChunkMap::kCapacity + 1> free;
  /// Freed by this update, and free from the next on: so that no slot changes twice.
  std::vector<SlotRange> freed;

  /// The world's order_token, if this order was the last that followed it; and how far.
  std::uint64_t token = 0, tidied = 0;

  /// Whether the order is that of the world as it is now.
  [[nodiscard]] bool is_of(const WorldState& world) const noexcept {
    return token != 0 && token == world.order_token && tidied == world.tidied;
  }
};

}  // namespace sightline::world

namespace sightline {

struct ObjectOrder::State : world::OrderState {};

struct OrderAccess {
  static const world::OrderState& state(const ObjectOrder& order) noexcept { return *order.state_; }
};

}  // namespace sightline
