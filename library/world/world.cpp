#include <sightline/world.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "library/world/free_list.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

namespace {

constexpr float kHalfSide = static_cast<float>(kSectorSide / 2);
// One level would do for culling; with some, large objects stay out of the small ones' groups.
constexpr ChunkMapOptions kSectorMap{
    {{-kHalfSide, -kHalfSide, -kHalfSide}, {kHalfSide, kHalfSide, kHalfSide}}, 0};

std::int64_t cell_of(double low, double high) {
  return static_cast<std::int64_t>(std::floor((0.5 * low + 0.5 * high) / kSectorSide + 0.5));
}

float down(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

}  // namespace

SectorCell sector_cell(const WorldBox& b) noexcept {
  return {cell_of(b.min.x, b.max.x), cell_of(b.min.y, b.max.y), cell_of(b.min.z, b.max.z)};
}

Box relative_box(const WorldBox& b, const WorldPoint& o) noexcept {
  return {{down(b.min.x - o.x), down(b.min.y - o.y), down(b.min.z - o.z)},
          {up(b.max.x - o.x), up(b.max.y - o.y), up(b.max.z - o.z)}};
}

std::uint32_t WorldState::sector_at(const SectorCell& cell) {
  const auto found = sector_of_cell.find(cell);
  if (found != sector_of_cell.end()) return found->second;
  const std::uint32_t added = take_element(sectors, free_sectors);
  sectors[added] = {{static_cast<double>(cell.x) * kSectorSide, static_cast<double>(cell.y) * kSectorSide,
                     static_cast<double>(cell.z) * kSectorSide},
                    std::make_unique<ChunkMap>(kSectorMap, &locations),
                    {},
                    false};
  sector_of_cell.emplace(cell, added);
  return added;
}

void WorldState::touch(std::uint32_t sector) {
  if (sectors[sector].touched) return;
  sectors[sector].touched = true;
  touched.push_back(sector);
}

void WorldState::tidy() {
  // Which sector is freed first says which is used again first: in order, whatever order they were touched
  // in.
  std::sort(touched.begin(), touched.end());
  for (const std::uint32_t s : touched) {
    Sector& sector = sectors[s];
    sector.touched = false;
    sector.map->tighten();
    sector.bounds = sector.map->nodes()[0].bounds;
    if (sector.map->size() > 0) continue;
    const WorldPoint& o = sector.origin;
    sector_of_cell.erase(sector_cell({o, o}));
    sector.map.reset();
    free_sectors.push_back(s);
  }
  tidied += touched.size();
  touched.clear();
}

}  // namespace world

namespace {

using world::ChunkMap;
using world::WorldState;

bool in_reach(double low, double high) {
  // False for NaN, too.
  return low >= -kWorldReach && high <= kWorldReach && low <= high;
}

Check check_boxes(std::span<const WorldBox> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const WorldBox& b = boxes[i];
    if (in_reach(b.min.x, b.max.x) && in_reach(b.min.y, b.max.y) && in_reach(b.min.z, b.max.z)) continue;
    return Failure{"world: box " + std::to_string(i) + " of " + std::to_string(boxes.size()) +
                   " is not valid, expected min <= max within 1e11 m of 0"};
  }
  return {};
}

Failure stale(std::size_t i, std::size_t count) {
  return {"world: handle " + std::to_string(i) + " of " + std::to_string(count) +
          " names no object that stands in this world"};
}

Check check_handles(const World& world, std::span<const Handle> handles) {
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (!world.contains(handles[i])) return stale(i, handles.size());
  }
  return {};
}

}  // namespace

World::World() : state_(std::make_unique<WorldState>()) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Check World::insert(std::span<const WorldBox> boxes, std::span<Handle> handles) {
  if (boxes.size() != handles.size()) return Failure{"world: expected one handle a box"};
  if (Check bad = check_boxes(boxes)) return bad;
  WorldState& s = *state_;
  constexpr std::size_t kMostObjects = std::size_t{1} << 31;
  if (boxes.size() > kMostObjects - s.size) return Failure{"world: it cannot hold more than 2^31 objects"};
  const std::size_t reused = std::min(boxes.size(), s.free_ids.size());
  const std::size_t limit = s.objects.size() + boxes.size() - reused;
  if (limit > s.objects.capacity()) {
    const std::size_t room = std::max(limit, 2 * s.objects.capacity());
    s.objects.reserve(room);
    s.locations.reserve(room);
  }
  world::SectorCell last_cell;
  std::uint32_t sector = ChunkMap::kNone;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const ObjectId id = world::take_element(s.objects, s.free_ids);
    if (s.locations.size() < s.objects.size()) s.locations.emplace_back();
    const world::SectorCell cell = world::sector_cell(boxes[i]);
    if (sector == ChunkMap::kNone || !(cell == last_cell)) {
      sector = s.sector_at(cell), last_cell = cell;
      s.touch(sector);
    }
    s.sectors[sector].map->insert(id, world::relative_box(boxes[i], s.sectors[sector].origin));
    s.objects[id].sector = sector;
    handles[i] = {id, s.objects[id].generation};
  }
  s.tidy();
  s.size += boxes.size();
  return {};
}

Check World::move(std::span<const Handle> handles, std::span<const WorldBox> boxes) {
  if (boxes.size() != handles.size()) return Failure{"world: expected one box a handle"};
  if (Check bad = check_boxes(boxes)) return bad;
  if (Check bad = check_handles(*this, handles)) return bad;
  WorldState& s = *state_;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const ObjectId id = handles[i].index;
    const world::SectorCell cell = world::sector_cell(boxes[i]);
    const std::uint32_t from = s.objects[id].sector;
    const WorldPoint& origin = s.sectors[from].origin;
    const bool stays = static_cast<double>(cell.x) * world::kSectorSide == origin.x &&
                       static_cast<double>(cell.y) * world::kSectorSide == origin.y &&
                       static_cast<double>(cell.z) * world::kSectorSide == origin.z;
    s.touch(from);
    if (stays) {
      s.sectors[from].map->move(id, world::relative_box(boxes[i], origin));
    } else {
      const std::uint32_t to = s.sector_at(cell);
      s.touch(to);
      s.sectors[from].map->remove(id);
      s.sectors[to].map->insert(id, world::relative_box(boxes[i], s.sectors[to].origin));
      s.objects[id].sector = to;
    }
  }
  s.tidy();
  return {};
}

Check World::remove(std::span<const Handle> handles) {
  if (Check bad = check_handles(*this, handles)) return bad;
  WorldState& s = *state_;
  // A handle that stands twice is stale the second time; the new generations are taken back then.
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (contains(handles[i])) {
      ++s.objects[handles[i].index].generation;
      continue;
    }
    for (std::size_t k = 0; k < i; ++k) --s.objects[handles[k].index].generation;
    return stale(i, handles.size());
  }
  for (const Handle& handle : handles) {
    world::WorldObject& object = s.objects[handle.index];
    s.touch(object.sector);
    s.sectors[object.sector].map->remove(handle.index);
    object.sector = ChunkMap::kNone;
    s.free_ids.push_back(handle.index);
  }
  s.size -= handles.size();
  s.tidy();
  return {};
}

bool World::contains(Handle handle) const noexcept {
  const auto& objects = state_->objects;
  return handle.index < objects.size() && objects[handle.index].sector != ChunkMap::kNone &&
         objects[handle.index].generation == handle.generation;
}

WorldBox World::box(Handle handle) const noexcept {
  if (!contains(handle)) return {};
  const world::Sector& sector = state_->sectors[state_->objects[handle.index].sector];
  const Box b = sector.map->box(handle.index);
  const WorldPoint& o = sector.origin;
  return {{o.x + static_cast<double>(b.min.x), o.y + static_cast<double>(b.min.y),
           o.z + static_cast<double>(b.min.z)},
          {o.x + static_cast<double>(b.max.x), o.y + static_cast<double>(b.max.y),
           o.z + static_cast<double>(b.max.z)}};
}

Handle World::handle(ObjectId id) const noexcept {
  const auto& objects = state_->objects;
  if (id >= objects.size() || objects[id].sector == ChunkMap::kNone) return {};
  return {id, objects[id].generation};
}

std::size_t World::size() const noexcept {
  return state_->size;
}
std::size_t World::id_limit() const noexcept {
  return state_->objects.size();
}

}  // namespace sightline
