// A world as bytes, a sector at a time.
#include <algorithm>
#include <cmath>

#include <sightline/boxes.hpp>
#include <sightline/snapshot.hpp>

#include "library/world/chunk_map_parts.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

std::vector<std::uint32_t> ChunkMapParts::order(const ChunkMap& map) {
  std::vector<std::uint32_t> numbers(map.chunks_.size(), ChunkMap::kNone);
  std::uint32_t next = 0;
  for_each_chunk(map, [&](std::uint32_t chunk, const auto&) { numbers[chunk] = next++; });
  return numbers;
}

void ChunkMapParts::write_shape(const ChunkMap& map, SectorEntry& entry, std::vector<std::uint32_t>& words) {
  const auto& groups = map.nodes_[0].groups;
  const std::vector<std::uint32_t> number = order(map);
  const auto numbered = [&](std::uint32_t chunk) { return chunk == ChunkMap::kNone ? chunk : number[chunk]; };
  for (const std::uint32_t g : groups) words.push_back(map.groups_[g].count);
  for_each_chunk(map, [&](std::uint32_t, const ChunkMap::ChunkView& view) {
    words.push_back(view.count);
    entry.objects += view.count, entry.small_chunks += view.count <= ChunkMap::kSmallCapacity;
    ++entry.chunks;
  });
  for_each_chunk(map, [&](std::uint32_t c, const auto&) { words.push_back(numbered(map.chunks_[c].next)); });
  // Splits in the order in which they are met, each after its parent.
  std::vector<std::uint32_t> found;
  const auto reference = [&](std::uint32_t at) {
    if (ChunkMap::is_chunk(at)) return number[at & ~ChunkMap::kChunkBit] | ChunkMap::kChunkBit;
    found.push_back(at);
    return static_cast<std::uint32_t>(found.size() - 1);
  };
  entry.root = reference(map.keys_[0].root);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Split& split = map.splits_[found[i]];
    words.push_back(std::bit_cast<std::uint32_t>(split.at)), words.push_back(split.axis);
    for (const std::uint32_t child : split.child) words.push_back(reference(child));
  }
  entry.groups = static_cast<std::uint32_t>(groups.size());
  entry.splits = static_cast<std::uint32_t>(found.size());
}

namespace {

// What moved is filed anew: its objects are numbered, and `ids` says who they are.
std::unique_ptr<ChunkMap> still_copy(const ChunkMap& map, std::vector<ObjectId>& ids) {
  Boxes boxes;
  for (const ChunkMap::Group& group : map.groups()) {
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const ChunkMap::ChunkView c = map.chunk(group, i);
      for (std::uint32_t k = 0; k < c.count; ++k) {
        if (c.objects[k] == kNoObject) continue;
        boxes.push_back(c.box(k));
        ids.push_back(c.objects[k]);
      }
    }
  }
  auto copy = std::make_unique<ChunkMap>(kSectorMap);
  copy->insert_all(boxes);
  copy->tighten();
  return copy;
}

class Writer {
public:
  Writer(const WorldState& state, const SnapshotSink& sink) : s_(state), sink_(sink) {
    levels_ = static_cast<const WorldLevels*>(s_.levels.get());
    using Has = SnapshotColumns;
    const Columns& c = s_.columns;
    columns_ = (c.has_layers ? Has::kLayers : 0) | (c.has_values ? Has::kValues : 0) |
               (c.has_distances ? Has::kDistances : 0) |
               (levels_ && !levels_->table_of.empty() ? Has::kLevels : 0);
  }

  bool write() {
    const SnapshotHead head{kSnapshotMagic, kSnapshotVersion, columns_};
    if (!put(std::as_bytes(std::span(&head, 1)))) return false;
    for (const Sector& sector : s_.sectors)
      if (sector.map && !write_sector(sector)) return false;
    return write_end(head);
  }

private:
  bool put(Bytes bytes) {
    at_ += bytes.size();
    return bytes.empty() || sink_.write(sink_.user, bytes);
  }

  bool write_sector(const Sector& sector) {
    std::vector<ObjectId> ids;
    std::unique_ptr<ChunkMap> copy;
    if (!ChunkMapParts::is_still(*sector.map)) copy = still_copy(*sector.map, ids);
    const ChunkMap& map = copy ? *copy : *sector.map;
    SectorEntry entry;
    const SectorCell cell = sector_cell({sector.origin, sector.origin});
    entry.cell = {cell.x, cell.y, cell.z};
    entry.bounds = map.nodes()[0].bounds;
    words_.clear();
    ChunkMapParts::write_shape(map, entry, words_);
    ChunkMapParts::for_each_chunk(map, [&](std::uint32_t, const ChunkMap::ChunkView& c) {
      chunk_ids_.assign(c.objects, c.objects + c.count);
      if (copy)
        for (ObjectId& id : chunk_ids_) id = ids[id];
      write_objects(c);
    });
    const Bytes bytes = std::as_bytes(std::span(words_));
    entry.bytes = bytes.size(), entry.checksum = checksum(bytes);
    entries_.push_back(entry);
    return put(bytes);
  }

  void write_objects(const ChunkMap::ChunkView& c) {
    for (std::size_t k = 0; k < 6; ++k)
      for (std::uint32_t i = 0; i < c.count; ++i)
        words_.push_back(std::bit_cast<std::uint32_t>(c.side(k)[i]));
    const auto row = [&](const auto& value_of) {
      for (const ObjectId id : chunk_ids_) words_.push_back(std::bit_cast<std::uint32_t>(value_of(id)));
    };
    row([](ObjectId id) { return id; });
    row([&](ObjectId id) { return s_.objects[id].generation; });
    const Columns& columns = s_.columns;
    if (columns.has_layers) row([&](ObjectId id) { return columns.layers[id]; });
    if (columns.has_values) row([&](ObjectId id) { return columns.values[id]; });
    if (columns.has_distances) {
      row([&](ObjectId id) { return columns.distances[id].min; });
      row([&](ObjectId id) { return columns.distances[id].max; });
    }
    if (columns_ & SnapshotColumns::kLevels)
      row([&](ObjectId id) {
        return id < levels_->table_of.size() ? std::uint32_t{levels_->table_of[id]} : kNoLevels;
      });
  }

  bool write_end(const SnapshotHead& head) {
    SnapshotTail tail;
    tail.directory = at_, tail.objects = s_.size, tail.magic = kSnapshotMagic;
    std::vector<FreeId> free_ids;
    free_ids.reserve(s_.free_ids.size());
    for (const ObjectId id : s_.free_ids) free_ids.push_back({id, s_.objects[id].generation});
    std::vector<SnapshotTable> tables;
    if (levels_)
      for (std::size_t t = 1; t < levels_->tables.size(); ++t) tables.push_back({levels_->tables[t].sizes});
    tail.sectors = entries_.size(), tail.free_ids = free_ids.size(), tail.tables = tables.size();
    std::vector<std::byte> end;
    const auto add = [&](Bytes bytes) { end.insert(end.end(), bytes.begin(), bytes.end()); };
    add(std::as_bytes(std::span(entries_))), add(std::as_bytes(std::span(free_ids)));
    add(std::as_bytes(std::span(tables)));
    const Bytes of_tail = std::as_bytes(std::span(&tail, 1));
    add(of_tail.first(offsetof(SnapshotTail, checksum)));
    tail.checksum = checksum(end, checksum(std::as_bytes(std::span(&head, 1))));
    add(of_tail.subspan(offsetof(SnapshotTail, checksum)));
    return put(end);
  }

  const WorldState& s_;
  const SnapshotSink& sink_;
  const WorldLevels* levels_ = nullptr;
  std::uint32_t columns_ = 0;
  std::uint64_t at_ = 0;
  std::vector<SectorEntry> entries_;
  std::vector<std::uint32_t> words_;  // of a sector
  std::vector<ObjectId> chunk_ids_;   // of a chunk
};

}  // namespace

}  // namespace world

Status save(const World& world, const SnapshotSink& sink) {
  const world::WorldState& state = WorldAccess::state(world);
  if (!sink.write) return {StatusCode::bad_argument, "save: the sink's write is null"};
  if (state.size + state.free_ids.size() != state.objects.size())
    return {StatusCode::bad_argument, "save: sectors of the world are out, expected all of them in"};
  if (!world::Writer(state, sink).write())
    return {StatusCode::too_many, "save: the sink took no more, expected room for all of the world"};
  return {};
}

}  // namespace sightline
