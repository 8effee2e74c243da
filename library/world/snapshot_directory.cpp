// Nothing in the bytes is trusted: each count is held against what the bytes have room for before it is used.
#include <cmath>
#include <unordered_set>
#include <utility>

#include <sightline/box_view.hpp>
#include <sightline/world.hpp>

#include "library/world/chunk_map.hpp"
#include "library/world/snapshot_format.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

namespace {

Status damaged(const char* what, std::size_t at) {
  return {StatusCode::bad_file, what, at};
}

// Takes what `count` elements of `size` bytes need off the bytes left; false where they are fewer.
bool take_bytes(std::uint64_t& left, std::uint64_t count, std::uint64_t size) {
  if (count > left / size) return false;
  left -= count * size;
  return true;
}

// Twice, for a sector's origin may lie half a sector and a box's rounding off.
constexpr double kFarthest = 2 * kWorldReach;

bool is_sound(const Box& b) {
  const auto pair = [](float low, float high) {
    return low <= high && double{low} >= -kFarthest && double{high} <= kFarthest;
  };
  return pair(b.min.x, b.max.x) && pair(b.min.y, b.max.y) && pair(b.min.z, b.max.z);
}

bool is_sound(const SectorEntry& e, const SnapshotRows& rows) {
  constexpr std::int64_t kMostCells = 32'000'000;  // kWorldReach is 31,250,000 sectors away
  for (const std::int64_t c : e.cell)
    if (c < -kMostCells || c > kMostCells) return false;
  const bool filled = e.groups >= 1 && e.groups <= e.chunks && e.chunks <= e.objects;
  return filled && e.splits < e.chunks && e.small_chunks <= e.chunks && e.chunks < (1u << 31) &&
         e.objects <= std::uint64_t{e.chunks} * ChunkMap::kCapacity &&
         e.chunks <= std::uint64_t{e.groups} * ChunkMap::kGroupCapacity && is_sound(e.bounds) &&
         e.bytes == sector_bytes(e, rows);
}

bool is_sound(const SnapshotTable& table) {
  bool ended = false;
  for (std::size_t i = 0; i < kMaxLevels; ++i) {
    const float size = table.sizes[i];
    if (size == 0) ended = true;
    if (ended ? size != 0 : !(size > 0 && std::isfinite(size)) || (i > 0 && size >= table.sizes[i - 1]))
      return false;
  }
  return ended && table.sizes[0] > 0;
}

Status check_sectors(SnapshotDirectory& out, const SnapshotTail& tail) {
  const SnapshotRows rows(out.columns);
  std::uint64_t at = sizeof(SnapshotHead);
  std::unordered_set<SectorCell, SectorCellHash> cells;
  for (std::size_t i = 0; i < out.sectors.size(); ++i) {
    const SectorEntry& e = out.sectors[i];
    const std::size_t entry = static_cast<std::size_t>(tail.directory) + i * sizeof(SectorEntry);
    if (!is_sound(e, rows) || e.bytes > tail.directory - at)
      return damaged("snapshot: the entry of a sector is not sound, at this byte", entry);
    if (!cells.insert({e.cell[0], e.cell[1], e.cell[2]}).second)
      return damaged("snapshot: a sector stands where another does, its entry at this byte", entry);
    out.first_bytes.push_back(static_cast<std::size_t>(at));
    at += e.bytes, out.objects += e.objects;
  }
  if (at != tail.directory) return damaged("snapshot: its sectors do not end where their entries begin", at);
  constexpr std::uint64_t kMostObjects = std::uint64_t{1} << 31;
  if (out.objects != tail.objects || out.objects > kMostObjects || out.id_limit() > kNoObject)
    return damaged("snapshot: its sectors hold another number of objects than it says, or more than 2^31",
                   tail.directory);
  return {};
}

Status check_rest(const SnapshotDirectory& out, std::uint64_t at) {
  std::vector<bool> met(out.free_ids.empty() ? 0 : out.id_limit());
  for (std::size_t i = 0; i < out.free_ids.size(); ++i) {
    const std::uint32_t id = out.free_ids[i].id;
    if (id >= met.size() || met[id])
      return damaged("snapshot: a free id is out of range or stands twice, at this byte",
                     at + i * sizeof(FreeId));
    met[id] = true;
  }
  at += out.free_ids.size() * sizeof(FreeId);
  for (std::size_t i = 0; i < out.tables.size(); ++i)
    if (!is_sound(out.tables[i]))
      return damaged("snapshot: sizes of levels do not descend, at this byte",
                     at + i * sizeof(SnapshotTable));
  return {};
}

}  // namespace

Result<SnapshotDirectory> read_directory(Bytes bytes) {
  SnapshotHead head;
  SnapshotTail tail;
  if (bytes.size() < sizeof head + sizeof tail)
    return damaged("snapshot: it is too short, expected a saved world", bytes.size());
  std::memcpy(&head, bytes.data(), sizeof head);
  std::memcpy(&tail, bytes.data() + bytes.size() - sizeof tail, sizeof tail);
  if (head.magic != kSnapshotMagic) return damaged("snapshot: it is none, expected a saved world", 0);
  if (head.version != kSnapshotVersion)
    return damaged("snapshot: it is of another version, expected 1", offsetof(SnapshotHead, version));
  if (tail.magic != kSnapshotMagic)
    return damaged("snapshot: its end is missing, it was truncated or is still being written", bytes.size());
  std::uint64_t left = bytes.size() - sizeof head - sizeof tail;
  constexpr std::uint64_t kMostTables = 65535;
  if (tail.directory < sizeof head || !take_bytes(left, tail.directory - sizeof head, 1) ||
      !take_bytes(left, tail.sectors, sizeof(SectorEntry)) ||
      !take_bytes(left, tail.free_ids, sizeof(FreeId)) || tail.tables > kMostTables ||
      !take_bytes(left, tail.tables, sizeof(SnapshotTable)) || left != 0)
    return damaged("snapshot: its counts are not those of its length", bytes.size() - sizeof tail);
  const std::uint64_t covered = bytes.size() - sizeof tail + offsetof(SnapshotTail, checksum);
  const std::uint64_t sum = checksum(bytes.first(sizeof head));
  if (checksum(bytes.subspan(tail.directory, covered - tail.directory), sum) != tail.checksum)
    return damaged("snapshot: its directory does not match its checksum, from this byte on", tail.directory);
  if (head.columns > SnapshotColumns::kAll)
    return damaged("snapshot: it has an unknown column", offsetof(SnapshotHead, columns));
  SnapshotDirectory out;
  out.bytes = bytes, out.columns = head.columns;
  out.sectors.resize(tail.sectors), out.free_ids.resize(tail.free_ids), out.tables.resize(tail.tables);
  WordReader reader(bytes.subspan(tail.directory));
  reader.copy(out.sectors.data(), tail.sectors);
  reader.copy(out.free_ids.data(), tail.free_ids);
  reader.copy(out.tables.data(), tail.tables);
  Status sound = check_sectors(out, tail);
  if (sound) sound = check_rest(out, tail.directory + tail.sectors * sizeof(SectorEntry));
  if (!sound) return sound;
  return out;
}

// Eight lanes, so that multiplications need not wait for one another. A step can be undone for a given word,
// so that of two texts which differ in one word alone no lane, and so no sum, is the same.
std::uint64_t checksum(Bytes bytes, std::uint64_t seed) noexcept {
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;
  constexpr std::size_t kLanes = 8, kStep = kLanes * sizeof(std::uint64_t);
  const auto mixed = [](std::uint64_t h, std::uint64_t word) { return std::rotl((h ^ word) * kFactor, 29); };
  std::array<std::uint64_t, kLanes> lane;
  for (std::size_t i = 0; i < kLanes; ++i) lane[i] = mixed(seed, i + 1);
  std::array<std::uint64_t, kLanes> words{};
  const auto step = [&] {
    for (std::size_t i = 0; i < kLanes; ++i) lane[i] = mixed(lane[i], words[i]);
  };
  std::size_t at = 0;
  for (; at + kStep <= bytes.size(); at += kStep) {
    std::memcpy(words.data(), bytes.data() + at, kStep);
    step();
  }
  words = {};
  if (at < bytes.size()) std::memcpy(words.data(), bytes.data() + at, bytes.size() - at);
  step();
  std::uint64_t sum = mixed(seed, bytes.size());
  for (const std::uint64_t h : lane) sum = mixed(sum, h ^ h >> 31);
  return sum ^ sum >> 32;
}

}  // namespace sightline::world
