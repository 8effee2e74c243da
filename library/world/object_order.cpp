// An order of a world's objects that changes only by report: chunks keep blocks of slots, and only those that
// changed are looked at.
#include "library/world/object_order.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "library/geometry/mutant.h"

namespace sightline {

namespace world {

namespace {

// Tells the orders that have followed worlds apart, wherever in memory worlds and orders come to lie.
std::uint64_t next_token() {
  static constinit std::atomic<std::uint64_t> last{0};
  return ++last;
}

class OrderUpdate {
public:
  OrderUpdate(OrderState& state, WorldState& world) noexcept : s_(state), world_(world) {}

  Status follow() {
    begin();
    for (std::size_t i = 0; i < world_.sectors.size(); ++i) follow_sector(i);
    for (const SlotRange& block : s_.freed) s_.free[block.count].push_back(block.first);
    s_.freed.clear();
    return end();
  }

  // Chunk by chunk, as culls walk them. Slots that keep their objects are reported only where the caller
  // knows of no order.
  Status number_all(bool report_all) {
    begin();
    old_objects_.swap(s_.objects), old_generations_.swap(s_.generations);
    s_.objects.reserve(world_.size), s_.generations.reserve(world_.size);
    for (auto& blocks : s_.free) blocks.clear();
    for (std::size_t i = 0; i < world_.sectors.size(); ++i) {
      sector_ = &s_.sectors[i], map_ = world_.sectors[i].map.get();
      sector_->first.clear(), sector_->room.clear();
      if (!map_) continue;
      fit_sector();
      number_node(0);
      map_->acknowledge_changes();
    }
    report_renumbered(report_all);
    s_.token = world_.order_token = next_token();
    return end();
  }

private:
  void begin() {
    s_.changes.clear();
    s_.sectors.resize(world_.sectors.size());
  }

  Status end() {
    s_.tidied = world_.tidied;
    if (s_.objects.size() < std::numeric_limits<std::uint32_t>::max()) return {};
    s_.token = 0;
    return {StatusCode::too_many, "order: there are more slots than 2^32 - 1"};
  }

  void fit_sector() {
    sector_->first.resize(map_->chunk_limit());
    sector_->room.resize(map_->chunk_limit());
  }

  // --- what changed ---

  void follow_sector(std::size_t i) {
    sector_ = &s_.sectors[i], map_ = world_.sectors[i].map.get();
    // A map never has fewer chunks than it had: this is another, and lists all that it has as changed.
    const std::size_t chunks = map_ ? map_->chunk_limit() : 0;
    for (std::size_t c = chunks; c < sector_->room.size(); ++c) give_up(c);
    if (!map_) {
      sector_->first.clear(), sector_->room.clear();
      return;
    }
    fit_sector();
    if (SIGHTLINE_MUTANT(orders_that_stay)) return;
    for (const std::uint32_t chunk : map_->changed_chunks()) follow_chunk(chunk);
    map_->acknowledge_changes();
  }

  void follow_chunk(std::uint32_t chunk) {
    const ChunkMap::ChunkView now = map_->chunk(chunk);
    if (now.count == 0 || now.count > sector_->room[chunk]) give_up(chunk);
    if (now.count == 0) return;
    if (sector_->room[chunk] == 0) take_block(chunk, now);
    const std::uint32_t first = sector_->first[chunk], room = sector_->room[chunk];
    for (std::uint32_t i = 0; i < room; ++i) set(first + i, i < now.count ? now.objects[i] : kNoObject);
  }

  void set(std::uint32_t slot, ObjectId object) {
    const std::uint32_t generation = object == kNoObject ? 0 : world_.objects[object].generation;
    if (s_.objects[slot] == object && s_.generations[slot] == generation) return;
    s_.objects[slot] = object, s_.generations[slot] = generation;
    s_.changes.push_back({slot, object});
  }

  void give_up(std::size_t chunk) {
    const std::uint32_t first = sector_->first[chunk], room = std::exchange(sector_->room[chunk], 0);
    for (std::uint32_t i = 0; i < room; ++i) set(first + i, kNoObject);
    if (room > 0) s_.freed.push_back({first, room});
  }

  // With some room to grow; a chunk of movers, which fills from its beginning, gets all that it may need.
  void take_block(std::uint32_t chunk, const ChunkMap::ChunkView& now) {
    constexpr std::uint32_t kStep = 32;
    const bool small = now.count <= ChunkMap::kSmallCapacity && !map_->holds_movers(chunk);
    const std::uint32_t room = map_->holds_movers(chunk) ? ChunkMap::kCapacity
                               : small                   ? ChunkMap::kSmallCapacity
                                                         : (now.count + kStep - 1) / kStep * kStep;
    for (std::uint32_t fits = now.count; fits <= room; ++fits) {
      if (s_.free[fits].empty()) continue;
      sector_->first[chunk] = s_.free[fits].back(), sector_->room[chunk] = static_cast<std::uint8_t>(fits);
      s_.free[fits].pop_back();
      return;
    }
    append_block(chunk, room);
  }

  void append_block(std::uint32_t chunk, std::uint32_t room) {
    sector_->first[chunk] = static_cast<std::uint32_t>(s_.objects.size());
    sector_->room[chunk] = static_cast<std::uint8_t>(room);
    s_.objects.resize(s_.objects.size() + room, kNoObject);
    s_.generations.resize(s_.objects.size());
  }

  // --- all of it ---

  void number_node(std::uint32_t index) {
    const ChunkMap::Node& node = map_->nodes()[index];
    for (const std::uint32_t g : node.groups) {
      const ChunkMap::Group& group = map_->groups()[g];
      for (std::uint32_t i = 0; i < group.count; ++i) number_chunk(group.chunks[i]);
    }
    if (index == 0 && map_->mover_node() != ChunkMap::kNone) number_node(map_->mover_node());
    if (node.first_child == ChunkMap::kNone) return;
    for (std::uint32_t i = 0; i < 4; ++i) number_node(node.first_child + i);
  }

  void number_chunk(std::uint32_t chunk) {
    const ChunkMap::ChunkView now = map_->chunk(chunk);
    append_block(chunk, map_->holds_movers(chunk) ? ChunkMap::kCapacity : now.count);
    for (std::uint32_t i = 0; i < now.count; ++i) {
      if (now.objects[i] == kNoObject) continue;
      s_.objects[sector_->first[chunk] + i] = now.objects[i];
      s_.generations[sector_->first[chunk] + i] = world_.objects[now.objects[i]].generation;
    }
  }

  void report_renumbered(bool all) {
    const std::size_t before = old_objects_.size(), now = s_.objects.size();
    for (std::size_t slot = 0; slot < std::max(before, now); ++slot) {
      const ObjectId object = slot < now ? s_.objects[slot] : kNoObject,
                     old = slot < before ? old_objects_[slot] : kNoObject;
      const bool same =
          object == old && (object == kNoObject || (!all && s_.generations[slot] == old_generations_[slot]));
      if (!same) s_.changes.push_back({static_cast<std::uint32_t>(slot), object});
    }
  }

  OrderState& s_;
  WorldState& world_;
  SectorOrder* sector_ = nullptr;  // that is looked at
  ChunkMap* map_ = nullptr;        // its
  geometry::LargeVector<ObjectId> old_objects_;
  geometry::LargeVector<std::uint32_t> old_generations_;
};

}  // namespace

}  // namespace world

ObjectOrder::ObjectOrder() : state_(new State) {}
ObjectOrder::~ObjectOrder() {
  delete state_;
}
ObjectOrder::ObjectOrder(ObjectOrder&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
ObjectOrder& ObjectOrder::operator=(ObjectOrder&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<std::span<const SlotChange>> ObjectOrder::update(World& world) {
  world::WorldState& followed = WorldAccess::state(world);
  const bool follows = state_->token != 0 && state_->token == followed.order_token;
  world::OrderUpdate update(*state_, followed);
  if (const Status done = follows ? update.follow() : update.number_all(true); !done) return done;
  return std::span<const SlotChange>(state_->changes);
}

Result<std::span<const SlotChange>> ObjectOrder::renumber(World& world) {
  world::WorldState& followed = WorldAccess::state(world);
  const bool follows = state_->token != 0 && state_->token == followed.order_token;
  if (const Status done = world::OrderUpdate(*state_, followed).number_all(!follows); !done) return done;
  return std::span<const SlotChange>(state_->changes);
}

std::size_t ObjectOrder::slot_limit() const noexcept {
  return state_->objects.size();
}

std::span<const ObjectId> ObjectOrder::objects() const noexcept {
  return state_->objects;
}

std::uint32_t ObjectOrder::slot(const World& world, Handle handle) const noexcept {
  const world::WorldState& followed = WorldAccess::state(world);
  if (!state_->is_of(followed) || !world.contains(handle)) return kNoSlot;
  const world::ChunkMap::Location& at = followed.objects[handle.index];
  return state_->sectors[at.sector].first[at.chunk] + at.slot();
}

}  // namespace sightline
