#include <sightline/world.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "library/geometry/box_reader.hpp"
#include "library/world/chunk_runs.hpp"
#include "library/world/free_list.hpp"
#include "library/world/world_cull.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

namespace {

std::int64_t cell_of(double low, double high) {
  return static_cast<std::int64_t>(std::floor((0.5 * low + 0.5 * high) / kSectorSide + 0.5));
}

}  // namespace

std::span<const Handle> side_by_side(const Strided<const Handle>& handles, std::size_t first,
                                     std::span<Handle> copies) noexcept {
  const bool packed = handles.stride() == sizeof(Handle) &&
                      reinterpret_cast<std::uintptr_t>(handles.data()) % alignof(Handle) == 0;
  if (packed) return {static_cast<const Handle*>(handles.data()) + first, copies.size()};
  for (std::size_t i = 0; i < copies.size(); ++i) copies[i] = handles[first + i];
  return copies;
}

SectorCell sector_cell(const WorldBox& b) noexcept {
  return {cell_of(b.min.x, b.max.x), cell_of(b.min.y, b.max.y), cell_of(b.min.z, b.max.z)};
}

std::uint32_t WorldState::sector_at(const SectorCell& cell) {
  const auto found = sector_of_cell.find(cell);
  if (found != sector_of_cell.end()) return found->second;
  const std::uint32_t added = take_element(sectors, free_sectors);
  const bool awake_before = sectors[added].awake;  // it may still stand in the list
  sectors[added] = {{static_cast<double>(cell.x) * kSectorSide, static_cast<double>(cell.y) * kSectorSide,
                     static_cast<double>(cell.z) * kSectorSide},
                    std::make_unique<ChunkMap>(kSectorMap, &objects, &columns),
                    {},
                    false,
                    awake_before};
  sector_of_cell.emplace(cell, added);
  return added;
}

void WorldState::touch(std::uint32_t sector) {
  sectors[sector].snapshot = ChunkMap::kNone;
  note_untidy(sector);
}

void WorldState::note_untidy(std::uint32_t sector) {
  if (sectors[sector].touched) return;
  sectors[sector].touched = true;
  touched.push_back(sector);
}

void WorldState::tidy(bool after_insertions) {
  // Which sector is freed first says which is used again first: in order, whatever order they were touched
  // in.
  std::sort(touched.begin(), touched.end());
  for (const std::uint32_t s : touched) {
    Sector& sector = sectors[s];
    sector.touched = false;
    after_insertions ? sector.map->tighten() : sector.map->tighten_nodes();
    sector.map->settle_columns();
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

void WorldState::note_generation(ObjectId id) {
  if (!ChunkMap::kHasPages) return;
  if (id >= generations.size()) generations.resize(objects.size(), kUnknown);
  const bool known = objects[id].sector != ChunkMap::kNone && objects[id].generation < kUnknown;
  generations[id] = known ? static_cast<std::uint8_t>(objects[id].generation) : kUnknown;
}

namespace {

constexpr std::size_t kHandlesAtOnce = 128;  // few, for a call of one pays for all copies, too

// Of how many handles, from the first on and some at a time, the table of generations knows that it is
// theirs.
std::size_t known_handles(std::span<const Handle> handles,
                          std::span<const std::uint8_t> generations) noexcept {
  constexpr std::size_t kAtOnce = 16;
  std::size_t i = 0;
  for (; i + kAtOnce <= handles.size(); i += kAtOnce) {
    bool all = true;
    for (const Handle& handle : handles.subspan(i, kAtOnce))
      all = all && handle.index < generations.size() && generations[handle.index] == handle.generation &&
            handle.generation != WorldState::kUnknown;
    if (!all) break;
  }
  return i;
}

// How many of the handles from the first on, and of so many at most, name objects.
std::size_t standing(const World& world, const Strided<const Handle>& handles, std::size_t first,
                     std::size_t count) noexcept {
  std::array<Handle, kHandlesAtOnce> copies;
  const std::span<const Handle> part = side_by_side(handles, first, std::span(copies).first(count));
  std::size_t i = !ChunkMap::kHasPages ? 0 : known_handles(part, WorldAccess::state(world).generations);
  while (i < count && world.contains(part[i])) ++i;
  return i;
}

}  // namespace

Status check_handles(const World& world, const Strided<const Handle>& handles) noexcept {
  if (!handles.sound())
    return {StatusCode::bad_argument, "world: the handles' pointer is null or their stride too short"};
  for (std::size_t first = 0; first < handles.size(); first += kHandlesAtOnce) {
    const std::size_t count = std::min(kHandlesAtOnce, handles.size() - first);
    if (const std::size_t i = standing(world, handles, first, count); i < count)
      return {StatusCode::stale_handle, "world: a handle names no object that stands in this world",
              first + i};
  }
  return {};
}

WorldBox stored_box(const WorldState& state, ObjectId id) noexcept {
  const Sector& sector = state.sectors[state.objects[id].sector];
  return geometry::world_box(sector.map->box(id), sector.origin);
}

}  // namespace world

namespace {

using geometry::kBlock;
using world::check_handles;
using world::ChunkMap;
using world::WorldState;

using Handles = Strided<const Handle>;

Status check_boxes(const BoxView& boxes) noexcept {
  if (!boxes.sound())
    return {StatusCode::bad_argument, "world: a box's pointer is null or its stride too short"};
  std::span<const Box> structs;
  if (BoxReader::lies_as_structs(boxes, {}, structs) && world::boxes_are_sound(structs)) return {};
  std::array<WorldBox, kBlock> block;
  for (std::size_t first = 0; first < boxes.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, boxes.size() - first);
    if (geometry::kEveryFormIsQuick && BoxReader::surely_valid(boxes, first, count)) continue;
    BoxReader::read(boxes, first, count, block.data(), true);
    for (std::size_t i = 0; i < count; ++i) {
      if (!geometry::is_valid(block[i]))
        return {StatusCode::bad_box, "world: a box is not valid, expected min <= max within 1e11 m of 0",
                first + i};
    }
  }
  return {};
}

// Whether all of a move surely is right. Handles that are members of the structs that have the boxes come
// with them, so that the caller's memory is read but once.
bool surely_right(const World& objects, const Handles& handles, const BoxView& boxes) noexcept {
  if (!geometry::kEveryFormIsQuick || !handles.sound() || !boxes.sound()) return false;
  if (std::span<const Box> structs; BoxReader::lies_as_structs(boxes, {}, structs)) return false;
  for (std::size_t first = 0; first < handles.size(); first += world::kHandlesAtOnce) {
    const std::size_t count = std::min(world::kHandlesAtOnce, handles.size() - first);
    if (world::standing(objects, handles, first, count) < count ||
        !BoxReader::surely_valid(boxes, first, count))
      return false;
  }
  return true;
}

// Calls take(i, box) for each box.
template <class Take>
void for_each_box(const BoxView& boxes, const Take& take) {
  std::array<WorldBox, kBlock> block;
  for (std::size_t first = 0; first < boxes.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, boxes.size() - first);
    BoxReader::read(boxes, first, count, block.data(), true);
    for (std::size_t i = 0; i < count; ++i) take(first + i, block[i]);
  }
}

// Room for so many more objects, and for some that come once a scene is loaded: who is the first of them need
// not wait until all are copied. What nobody writes takes no memory.
void reserve(WorldState& s, std::size_t more) {
  const std::size_t reused = std::min(more, s.free_ids.size());
  const std::size_t limit = s.objects.size() + more - reused;
  if (limit <= s.objects.capacity()) return;
  const std::size_t room = std::max(limit + limit / 8, 2 * s.objects.capacity());
  s.objects.reserve(room);
  if (ChunkMap::kHasPages) s.generations.reserve(room);
}

}  // namespace

World::World() : state_(new State) {}
World::~World() {
  delete state_;
}
World::World(World&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
World& World::operator=(World&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status World::insert(const BoxView& boxes, Strided<Handle> handles) {
  if (!handles.sound())
    return {StatusCode::bad_argument, "world: the handles' pointer is null or their stride too short"};
  if (boxes.size() != handles.size()) return {StatusCode::bad_argument, "world: expected one handle a box"};
  WorldState& s = *state_;
  constexpr std::size_t kMostObjects = std::size_t{1} << 31;
  if (boxes.size() > kMostObjects - s.size)
    return {StatusCode::too_many, "world: it cannot hold more than 2^31 objects"};
  if (const Status sound = check_boxes(boxes); !sound) return sound;
  reserve(s, boxes.size());
  world::SectorCell last_cell;
  std::uint32_t sector = ChunkMap::kNone;
  for_each_box(boxes, [&](std::size_t i, const WorldBox& box) {
    const ObjectId id = world::take_element(s.objects, s.free_ids);
    const world::SectorCell cell = world::sector_cell(box);
    if (sector == ChunkMap::kNone || !(cell == last_cell)) {
      sector = s.sector_at(cell), last_cell = cell;
      s.touch(sector);
    }
    s.columns.forget(id);
    if (s.levels) s.levels->forget(id);
    s.sectors[sector].map->insert(id, geometry::relative_box(box, s.sectors[sector].origin));
    s.objects[id].sector = sector;
    s.note_generation(id);
    handles.set(i, {id, s.objects[id].generation});
  });
  s.tidy(true);
  s.size += boxes.size();
  return {};
}

Status World::move(Strided<const Handle> handles, const BoxView& boxes) {
  if (boxes.size() != handles.size()) return {StatusCode::bad_argument, "world: expected one box a handle"};
  if (!surely_right(*this, handles, boxes)) {
    if (const Status stand = check_handles(*this, handles); !stand) return stand;
    if (const Status sound = check_boxes(boxes); !sound) return sound;
  }
  state_->move(handles, boxes);
  return {};
}

Status World::remove(Strided<const Handle> handles) {
  if (const Status stand = check_handles(*this, handles); !stand) return stand;
  WorldState& s = *state_;
  // A handle that stands twice is stale the second time; the new generations are taken back then.
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (contains(handles[i])) {
      ++s.objects[handles[i].index].generation;
      continue;
    }
    for (std::size_t k = 0; k < i; ++k) --s.objects[handles[k].index].generation;
    return {StatusCode::stale_handle, "world: a handle stands there twice", i};
  }
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const ObjectId id = handles[i].index;
    ChunkMap::Location& object = s.objects[id];
    s.touch(object.sector);
    s.sectors[object.sector].map->remove(id);
    object.sector = ChunkMap::kNone;
    s.note_generation(id);
    if (s.occluders) s.occluders->forget(id);
    s.free_ids.push_back(id);
  }
  s.size -= handles.size();
  s.tidy(false);
  return {};
}

bool World::contains(Handle handle) const noexcept {
  const auto& objects = state_->objects;
  return handle.index < objects.size() && objects[handle.index].sector != ChunkMap::kNone &&
         objects[handle.index].generation == handle.generation;
}

WorldBox World::box(Handle handle) const noexcept {
  if (!contains(handle)) return {};
  return world::stored_box(*state_, handle.index);
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
