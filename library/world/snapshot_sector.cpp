// A sector's bytes become a chunk map. It is built up by the same steps as any other, so that whatever the
// bytes say, what comes out is one, or nothing.
#include <cmath>
#include <utility>

#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map_parts.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

// No more room than they need.
std::uint32_t capacity_of(std::uint32_t objects) {
  return (objects + ChunkMap::kLanes - 1) / ChunkMap::kLanes * ChunkMap::kLanes;
}

bool are_ordered(const float* low, const float* high, std::uint32_t count) {
  bool ordered = true;
  for (std::uint32_t i = 0; i < count; ++i) ordered &= low[i] <= high[i];
  return ordered;
}

}  // namespace

class ChunkMapParts::Reader {
public:
  Reader(const SnapshotDirectory& directory, std::size_t sector, SectorPiece& piece)
      : directory_(directory),
        entry_(directory.sectors[sector]),
        at_(directory.first_bytes[sector]),
        rows_(directory.columns),
        words_(directory.sector(sector)),
        piece_(piece) {}

  Status read() {
    groups_.resize(entry_.groups), counts_.resize(entry_.chunks), next_.resize(entry_.chunks);
    splits_.resize(entry_.splits);
    words_.copy(groups_.data(), groups_.size());
    words_.copy(counts_.data(), counts_.size());
    words_.copy(next_.data(), next_.size());
    words_.copy(splits_.data(), splits_.size());
    if (!counts_are_sound()) return bad("snapshot: the counts of a sector do not fit, of that at this byte");
    piece_.map = std::make_unique<ChunkMap>(kSectorMap);
    map_ = piece_.map.get();
    reserve();
    const std::uint32_t key = map_->find_key({});
    std::uint32_t chunk = 0;
    for (const std::uint32_t of_group : groups_) {
      const std::uint32_t group = map_->add_group(map_->keys_[key].node);
      for (std::uint32_t i = 0; i < of_group; ++i)
        if (const Status sound = read_chunk(chunk++, key, group); !sound) return sound;
    }
    if (!read_tree()) return bad("snapshot: the splits of a sector are no tree, of that at this byte");
    if (map_->nodes_[0].bounds != entry_.bounds)
      return bad("snapshot: the boxes of a sector have other bounds than it says, of that at this byte");
    map_->size_ = entry_.objects, map_->misplaced_ = 0;
    // All its chunks stay listed as changed, for an order that follows the world.
    return {};
  }

private:
  struct StoredSplit {
    float at = 0;
    std::uint32_t axis = 0;
    std::array<std::uint32_t, 2> child{};
  };

  [[nodiscard]] Status bad(const char* what) const { return {StatusCode::bad_file, what, at_}; }

  bool counts_are_sound() const {
    std::uint64_t chunks = 0, objects = 0, small = 0;
    for (const std::uint32_t count : groups_) {
      if (count < 1 || count > ChunkMap::kGroupCapacity) return false;
      chunks += count;
    }
    for (const std::uint32_t count : counts_) {
      if (count < 1 || count > ChunkMap::kCapacity) return false;
      objects += count, small += count <= ChunkMap::kSmallCapacity;
    }
    return chunks == entry_.chunks && objects == entry_.objects && small == entry_.small_chunks;
  }

  void reserve() {
    std::size_t lanes = ChunkMap::kCapacity;
    for (const std::uint32_t count : counts_) lanes += capacity_of(count);
    ChunkMap::Pool& pool = map_->pools_[ChunkMap::kStill];
    pool.lanes.reserve(6 * lanes), pool.ids.reserve(lanes);
    map_->chunks_.reserve(entry_.chunks), map_->groups_.reserve(entry_.groups);
    map_->splits_.reserve(entry_.splits);
    piece_.rows.resize(std::size_t{rows_.count} * entry_.objects);
  }

  Status read_chunk(std::uint32_t expected, std::uint32_t key, std::uint32_t group) {
    const std::uint32_t count = counts_[expected];
    const std::uint32_t chunk = map_->add_chunk(key, capacity_of(count), kEmptyBox);
    Chunk& c = map_->chunks_[chunk];
    for (std::uint32_t side = 0; side < 6; ++side) words_.copy(map_->lanes(c, side), count);
    words_.copy(map_->ids(c), count);
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      if (!are_ordered(map_->lanes(c, axis), map_->lanes(c, axis + 3), count))
        return bad("snapshot: a box of a sector is not valid, of that at this byte");
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < count; ++i) last = std::max(last, map_->ids(c)[i]);
    if (last >= directory_.id_limit())
      return bad("snapshot: an id of a sector is out of range, of that at this byte");
    std::uint32_t* const rows = piece_.rows.data() + std::size_t{rows_.count} * first_;
    words_.copy(rows, std::size_t{rows_.count} * count);
    if (!columns_are_sound(rows, count))
      return bad("snapshot: distances or levels of a sector are not valid, of that at this byte");
    first_ += count;
    c.count = c.live = count;
    map_->put_in_group(chunk, group, map_->tight(c));
    return {};
  }

  bool columns_are_sound(const std::uint32_t* rows, std::uint32_t count) const {
    for (std::uint32_t i = 0; i < count && rows_.distances != SnapshotRows::kNone; ++i) {
      const auto min = std::bit_cast<float>(rows[rows_.distances * count + i]),
                 max = std::bit_cast<float>(rows[(rows_.distances + 1) * count + i]);
      if (!(min >= 0 && min <= max)) return false;
    }
    for (std::uint32_t i = 0; i < count && rows_.levels != SnapshotRows::kNone; ++i)
      if (rows[rows_.levels * count + i] > directory_.tables.size()) return false;
    return true;
  }

  // Each split and each chunk must be met exactly once.
  bool read_tree() {
    struct Visit {
      std::uint32_t reference, parent;
      Box cell;
    };
    map_->splits_.resize(entry_.splits);
    std::vector<std::uint8_t> met_split(entry_.splits), met_chunk(entry_.chunks);
    std::size_t met = 0;
    map_->keys_[0].root = entry_.root;
    std::vector<Visit> waiting{{entry_.root, ChunkMap::kNone, {kEmptyBox.max, kEmptyBox.min}}};
    while (!waiting.empty()) {
      const Visit visit = waiting.back();
      const std::uint32_t i = visit.reference;
      waiting.pop_back();
      if (!ChunkMap::is_chunk(i)) {
        if (i >= entry_.splits || std::exchange(met_split[i], 1)) return false;
        const StoredSplit& s = splits_[i];
        if (s.axis > 2 || !std::isfinite(s.at)) return false;
        map_->splits_[i] = {s.at, s.axis, visit.parent, s.child};
        Visit low{s.child[0], i, visit.cell}, high{s.child[1], i, visit.cell};
        coordinate(low.cell.max, s.axis) = coordinate(high.cell.min, s.axis) = s.at;
        waiting.push_back(low), waiting.push_back(high);
        ++met;
        continue;
      }
      std::uint32_t previous = ChunkMap::kNone;
      for (std::uint32_t c = i & ~ChunkMap::kChunkBit; c != ChunkMap::kNone;
           previous = c, c = next_[c], ++met) {
        if (c >= entry_.chunks || std::exchange(met_chunk[c], 1)) return false;
        Chunk& chunk = map_->chunks_[c];
        chunk.parent = visit.parent, chunk.cell = visit.cell;
        chunk.previous = previous, chunk.next = next_[c];
      }
    }
    return met == std::size_t{entry_.splits} + entry_.chunks;
  }

  const SnapshotDirectory& directory_;
  const SectorEntry& entry_;
  std::size_t at_;
  SnapshotRows rows_;
  WordReader words_;
  SectorPiece& piece_;
  ChunkMap* map_ = nullptr;
  std::vector<std::uint32_t> groups_, counts_, next_;
  std::vector<StoredSplit> splits_;
  std::size_t first_ = 0;  // objects read so far
};

Status ChunkMapParts::read(const SnapshotDirectory& directory, std::size_t sector, SectorPiece& piece) {
  const SectorEntry& entry = directory.sectors[sector];
  if (checksum(directory.sector(sector)) != entry.checksum)
    return {StatusCode::bad_file, "snapshot: a sector does not match its checksum, that at this byte",
            directory.first_bytes[sector]};
  const Status sound = Reader(directory, sector, piece).read();
  if (!sound) piece = {};
  return sound;
}

void ChunkMapParts::join(ChunkMap& map, WorldState& state) noexcept {
  map.locations_ = &state.objects, map.columns_ = &state.columns;
}

std::size_t ChunkMapParts::memory(const SectorEntry& e, std::uint32_t columns) noexcept {
  using Has = SnapshotColumns;
  const bool layers = columns & Has::kLayers, distances = columns & Has::kDistances;
  const std::size_t lane = 28 + (layers ? 4 : 0) + (distances ? 8 : 0);
  const std::size_t lanes = e.objects + std::size_t{ChunkMap::kLanes} * e.chunks + ChunkMap::kCapacity;
  constexpr std::size_t kInNode = 28, kListed = 8;
  const std::size_t group = sizeof(ChunkMap::Group) + kInNode + (layers ? 4 * LayerRows::kSize : 0) +
                            (distances ? 4 * DistanceRows::kSize : 0);
  return sizeof(ChunkMap) + sizeof(ChunkMap::Node) + lane * lanes + (sizeof(Chunk) + kListed) * e.chunks +
         group * e.groups + sizeof(Split) * e.splits +
         4 * std::size_t{SnapshotRows(columns).count} * e.objects;
}

}  // namespace sightline::world
