// Sectors in and out of a world: their maps, where their objects stand, and what columns say of them.
#include "library/world/snapshot_world.hpp"

#include <algorithm>
#include <utility>

#include "library/world/world_cull.hpp"

namespace sightline::world {

namespace {

// Where an object is that is out; its generation is known once it was in.
void go_out(ChunkMap::Location& at, bool known) noexcept {
  at.chunk = ChunkMap::kOut, at.slot_and_history = known ? kGenerationIsKnown : 0,
  at.sector = ChunkMap::kNone;
}

// Calls with each object of a map, and where it stands.
template <class Take>
void for_each_object(const ChunkMap& map, const Take& take) {
  ChunkMapParts::for_each_chunk(map, [&](std::uint32_t chunk, const ChunkMap::ChunkView& c) {
    for (std::uint32_t i = 0; i < c.count; ++i) take(c.objects[i], chunk, i);
  });
}

}  // namespace

bool Passed::drop(std::size_t sector) {
  const auto part = std::ranges::find(parts_, sector, &Part::sector);
  if (part == parts_.end()) return false;
  const std::size_t first = part->first, end = part + 1 == parts_.end() ? handles_.size() : (part + 1)->first;
  handles_.erase(handles_.begin() + static_cast<std::ptrdiff_t>(first),
                 handles_.begin() + static_cast<std::ptrdiff_t>(end));
  for (auto later = parts_.erase(part); later != parts_.end(); ++later) later->first -= end - first;
  return true;
}

bool SnapshotWorld::is_new(const World& world) noexcept {
  const WorldState& s = WorldAccess::state(world);
  const bool has_columns = s.columns.any() || s.columns.has_values;
  return s.objects.empty() && s.sectors.empty() && !s.levels && !s.occluders && !has_columns;
}

void SnapshotWorld::begin(SnapshotDirectory directory, World& world) {
  directory_ = std::move(directory);
  state_ = &WorldAccess::state(world);
  WorldState& s = *state_;
  const std::size_t ids = directory_.id_limit();
  s.objects.resize(ids, {ChunkMap::kOut, 0, ChunkMap::kNone, 0});
  for (const FreeId& free : directory_.free_ids) {
    s.objects[free.id].chunk = ChunkMap::kNone, s.objects[free.id].generation = free.generation;
    s.free_ids.push_back(free.id);
  }
  s.sectors.resize(directory_.sectors.size());
  using Has = SnapshotColumns;
  Columns& c = s.columns;
  c.has_layers = directory_.columns & Has::kLayers, c.has_values = directory_.columns & Has::kValues;
  c.has_distances = directory_.columns & Has::kDistances;
  if (c.has_layers) c.layers.resize(ids, kAllLayers);
  if (c.has_values) c.values.resize(ids, 0);
  if (c.has_distances) c.distances.resize(ids);
  if (c.any()) s.column_tests = c.has_distances ? &kDistanceTests : &kLayerTests;
  if (directory_.tables.empty()) return;
  auto levels = std::make_unique<WorldLevels>();
  for (const SnapshotTable& table : directory_.tables) levels->tables.push_back({table.sizes});
  if (directory_.columns & Has::kLevels) levels->table_of.resize(ids);
  s.levels = std::move(levels);
}

// Says of each object where it stands. One that stands elsewhere, or is free, ends that, and all is as
// before.
Status SnapshotWorld::claim(std::size_t sector, const ChunkMap& map) {
  WorldState& s = *state_;
  std::size_t claimed = 0;
  bool sound = true;
  for_each_object(map, [&](ObjectId id, std::uint32_t chunk, std::uint32_t slot) {
    ChunkMap::Location& at = s.objects[id];
    sound = sound && at.chunk == ChunkMap::kOut;
    if (!sound) return;
    at.chunk = chunk, at.slot_and_history = slot, at.sector = static_cast<std::uint32_t>(sector);
    ++claimed;
  });
  if (sound) return {};
  for_each_object(map, [&](ObjectId id, std::uint32_t, std::uint32_t) {
    if (claimed == 0) return;
    go_out(s.objects[id], false);
    --claimed;
  });
  return {StatusCode::bad_file, "snapshot: an id of a sector stands elsewhere, too, of that at this byte",
          directory_.first_bytes[sector]};
}

void SnapshotWorld::read_columns(const SectorPiece& piece) {
  WorldState& s = *state_;
  const SnapshotRows rows(directory_.columns);
  auto* levels = static_cast<WorldLevels*>(s.levels.get());
  const std::uint32_t* at = piece.rows.data();
  ChunkMapParts::for_each_chunk(*piece.map, [&](std::uint32_t, const ChunkMap::ChunkView& c) {
    const auto row = [&](std::uint32_t r) { return at + std::size_t{r} * c.count; };
    const auto real = [&](std::uint32_t r, std::uint32_t i) { return std::bit_cast<float>(row(r)[i]); };
    for (std::uint32_t i = 0; i < c.count; ++i) {
      const ObjectId id = c.objects[i];
      s.objects[id].generation = at[i];
      s.note_generation(id);
      came_.add({id, at[i]});
      s.columns.forget(id);
      if (levels) levels->forget(id);
      if (rows.layers != SnapshotRows::kNone) s.columns.layers[id] = row(rows.layers)[i];
      if (rows.values != SnapshotRows::kNone) s.columns.values[id] = row(rows.values)[i];
      if (rows.distances != SnapshotRows::kNone)
        s.columns.distances[id] = {real(rows.distances, i), real(rows.distances + 1, i)};
      if (rows.levels != SnapshotRows::kNone) levels->set(id, row(rows.levels)[i]);
    }
    at += std::size_t{rows.count} * c.count;
  });
}

// Into a sector that others' objects have begun.
void SnapshotWorld::file_each(const ChunkMap& map, std::uint32_t into) {
  WorldState& s = *state_;
  s.touch(into);
  ChunkMapParts::for_each_chunk(map, [&](std::uint32_t, const ChunkMap::ChunkView& c) {
    for (std::uint32_t i = 0; i < c.count; ++i) {
      const ObjectId id = c.objects[i];
      s.sectors[into].map->insert(id, c.box(i));
      s.objects[id].sector = into;
    }
  });
  s.tidy(true);
}

Status SnapshotWorld::put_in(std::size_t i, SectorPiece& piece) {
  WorldState& s = *state_;
  const auto& [x, y, z] = directory_.sectors[i].cell;
  if (const Status sound = claim(i, *piece.map); !sound) return sound;
  came_.begin(i);
  read_columns(piece);
  s.size += piece.map->size();
  const auto begun = s.sector_of_cell.find({x, y, z});
  if (begun != s.sector_of_cell.end()) {
    file_each(*piece.map, begun->second);
    s.free_sectors.push_back(static_cast<std::uint32_t>(i));
    return {};
  }
  Sector& sector = s.sectors[i];
  sector.map = std::move(piece.map);
  sector.origin = {static_cast<double>(x) * kSectorSide, static_cast<double>(y) * kSectorSide,
                   static_cast<double>(z) * kSectorSide};
  s.sector_of_cell.emplace(SectorCell{x, y, z}, static_cast<std::uint32_t>(i));
  ChunkMapParts::join(*sector.map, s);
  if (s.columns.any()) sector.map->begin_column();
  s.note_untidy(static_cast<std::uint32_t>(i));
  s.tidy(false);
  sector.snapshot = static_cast<std::uint32_t>(i);
  return {};
}

void SnapshotWorld::take_out(std::size_t i) {
  WorldState& s = *state_;
  Sector& sector = s.sectors[i];
  const bool goes = !came_.drop(i);
  if (goes) went_.begin(i);
  for_each_object(*sector.map, [&](ObjectId id, std::uint32_t, std::uint32_t) {
    if (goes) went_.add({id, s.objects[id].generation});
    go_out(s.objects[id], true);
    s.note_generation(id);
    if (s.occluders) s.occluders->forget(id);
  });
  s.size -= sector.map->size();
  s.sector_of_cell.erase(sector_cell({sector.origin, sector.origin}));
  sector.map.reset();
  sector.snapshot = ChunkMap::kNone;
  ++s.tidied;
}

}  // namespace sightline::world
