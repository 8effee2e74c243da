// What objects have besides their boxes: columns by id, of which chunks are told where they say who is seen.
#include <sightline/world.hpp>

#include <utility>

#include "library/world/world_cull.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

// Ids that are new follow one another.
void Columns::forget(ObjectId id) {
  const auto set = [&](bool used, auto& column, auto value) {
    if (!used) return;
    if (id == column.size()) column.emplace_back();
    column[id] = value;
  };
  set(has_layers, layers, kAllLayers);
  set(has_values, values, id);
  set(has_distances, distances, DistanceRange{});
}

void WorldState::begin_column(const ColumnTests& tests) {
  column_tests = &tests;
  for (std::uint32_t s = 0; s < sectors.size(); ++s) {
    if (!sectors[s].map) continue;
    sectors[s].map->begin_column();
    note_untidy(s);
  }
}

void WorldState::note_changed(const Strided<const Handle>& handles) noexcept {
  for (std::size_t i = 0; i < handles.size(); ++i)
    sectors[objects[handles[i].index].sector].snapshot = ChunkMap::kNone;
}

}  // namespace world

namespace {

using world::check_handles;
using world::ChunkMap;
using world::WorldState;

using Handles = Strided<const Handle>;

template <class T>
Status check_column(const Strided<const T>& column, std::size_t expected) noexcept {
  if (!column.sound())
    return {StatusCode::bad_argument, "world: a column's pointer is null or its stride too short"};
  if (column.size() != expected)
    return {StatusCode::bad_argument, "world: expected one element of a column an object"};
  return {};
}

Status check_column(const Strided<const DistanceRange>& column, std::size_t expected) noexcept {
  if (const Status sound = check_column<DistanceRange>(column, expected); !sound) return sound;
  for (std::size_t i = 0; i < expected; ++i) {
    if (const DistanceRange d = column[i]; !(d.min >= 0 && d.min <= d.max))
      return {StatusCode::bad_argument, "world: distances are no range, expected 0 <= min <= max", i};
  }
  return {};
}

Status check_columns(const ObjectColumns& columns, std::size_t expected) noexcept {
  Status sound;
  if (columns.layers.size() > 0) sound = check_column(columns.layers, expected);
  if (sound && columns.values.size() > 0) sound = check_column(columns.values, expected);
  if (sound && columns.distances.size() > 0) sound = check_column(columns.distances, expected);
  return sound;
}

std::uint32_t own_id(std::size_t id) {
  return static_cast<std::uint32_t>(id);
}
std::uint32_t all_layers(std::size_t) {
  return kAllLayers;
}
DistanceRange any_distance(std::size_t) {
  return {};
}

// A column comes to be with the first value that somebody sets; ids without one have `otherwise`(id). Returns
// whether it has just come to be.
template <class T, class Otherwise>
bool cover(std::vector<T>& column, bool& used, std::size_t ids, const Otherwise& otherwise) {
  while (column.size() < ids) column.push_back(otherwise(column.size()));
  return !std::exchange(used, true);
}

template <class T>
void set_column(std::vector<T>& column, const Handles& handles, const Strided<const T>& values) {
  for (std::size_t i = 0; i < handles.size(); ++i) column[handles[i].index] = values[i];
}

// Of columns that say who is seen: chunks are told.
template <class T, class Otherwise>
void set_seen(WorldState& s, const world::ColumnTests& tests, std::vector<T>& column, bool& used,
              const Handles& handles, const Strided<const T>& values, const Otherwise& otherwise) {
  if (cover(column, used, s.objects.size(), otherwise)) s.begin_column(tests);
  set_column(column, handles, values);
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const ChunkMap::Location& object = s.objects[handles[i].index];
    s.touch(object.sector);
    s.sectors[object.sector].map->note_columns(handles[i].index);
  }
  s.tidy(false);
}

}  // namespace

Status World::insert(const BoxView& boxes, Strided<Handle> handles, const ObjectColumns& columns) {
  if (const Status sound = check_columns(columns, boxes.size()); !sound) return sound;
  if (const Status done = insert(boxes, handles); !done) return done;
  Status done;
  if (columns.layers.size() > 0) done = set_layers(handles, columns.layers);
  if (done && columns.values.size() > 0) done = set_values(handles, columns.values);
  if (done && columns.distances.size() > 0) done = set_distances(handles, columns.distances);
  return done;
}

Status World::set_layers(Strided<const Handle> handles, Strided<const std::uint32_t> layers) {
  if (const Status stand = check_handles(*this, handles); !stand) return stand;
  if (const Status sound = check_column(layers, handles.size()); !sound) return sound;
  WorldState& s = *state_;
  const world::ColumnTests& tests = s.column_tests ? *s.column_tests : world::kLayerTests;
  set_seen(s, tests, s.columns.layers, s.columns.has_layers, handles, layers, all_layers);
  return {};
}

Status World::set_values(Strided<const Handle> handles, Strided<const std::uint32_t> values) {
  if (const Status stand = check_handles(*this, handles); !stand) return stand;
  if (const Status sound = check_column(values, handles.size()); !sound) return sound;
  world::Columns& c = state_->columns;
  cover(c.values, c.has_values, state_->objects.size(), own_id);
  set_column(c.values, handles, values);
  state_->note_changed(handles);
  return {};
}

Status World::set_distances(Strided<const Handle> handles, Strided<const DistanceRange> distances) {
  if (const Status stand = check_handles(*this, handles); !stand) return stand;
  if (const Status sound = check_column(distances, handles.size()); !sound) return sound;
  WorldState& s = *state_;
  set_seen(s, world::kDistanceTests, s.columns.distances, s.columns.has_distances, handles, distances,
           any_distance);
  return {};
}

std::uint32_t World::layers(Handle handle) const noexcept {
  if (!contains(handle)) return 0;
  return state_->columns.has_layers ? state_->columns.layers[handle.index] : kAllLayers;
}

std::uint32_t World::value(Handle handle) const noexcept {
  if (!contains(handle)) return kNoObject;
  return state_->columns.has_values ? state_->columns.values[handle.index] : handle.index;
}

DistanceRange World::distances(Handle handle) const noexcept {
  if (!contains(handle)) return {0, 0};
  return state_->columns.has_distances ? state_->columns.distances[handle.index] : DistanceRange{};
}

}  // namespace sightline
