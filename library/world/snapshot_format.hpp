// A world's bytes: a head, the sectors, then of each an entry, free ids, tables of levels, and a tail.
// Everything is little-endian and a multiple of four bytes.
//
// A sector is rows of 32-bit words: of each group how many chunks it has; of each chunk how many objects it
// has, and which chunk follows it in its chain; of each split of the k-d tree where, along which axis, and
// its two children; then chunk by chunk the objects, an array each of six sides, of ids, generations, and of
// what columns there are.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include <sightline/status.hpp>
#include <sightline/types.hpp>

namespace sightline::world {

static_assert(std::endian::native == std::endian::little, "snapshots are little-endian");

using Bytes = std::span<const std::byte>;

inline constexpr std::array<char, 8> kSnapshotMagic{'S', 'L', 'W', 'O', 'R', 'L', 'D', '\n'};
inline constexpr std::uint32_t kSnapshotVersion = 1;

/// Which columns there are.
struct SnapshotColumns {
  static constexpr std::uint32_t kLayers = 1, kValues = 2, kDistances = 4, kLevels = 8, kAll = 15;
};

struct SnapshotHead {
  std::array<char, 8> magic{};
  std::uint32_t version = 0, columns = 0;
};

/// Where a sector lies follows from the lengths of those before it.
struct SectorEntry {
  std::array<std::int64_t, 3> cell{};
  std::uint64_t bytes = 0, checksum = 0;
  Box bounds;  ///< of all its boxes, about the sector's origin
  std::uint32_t objects = 0, chunks = 0, groups = 0, splits = 0;
  std::uint32_t root = 0;          ///< of the k-d tree: a split, or a chunk with the highest bit set
  std::uint32_t small_chunks = 0;  ///< chunks that need no more than ChunkMap::kSmallCapacity
};
static_assert(sizeof(SectorEntry) == 88);

struct FreeId {
  std::uint32_t id = 0, generation = 0;
};
struct SnapshotTable {
  std::array<float, 8> sizes{};  ///< descending, then zeros
};

struct SnapshotTail {
  std::uint64_t directory = 0;  ///< where the first entry lies
  std::uint64_t sectors = 0, free_ids = 0, tables = 0, objects = 0;
  std::uint64_t checksum = 0;  ///< of all but sectors and what follows here
  std::array<char, 8> magic{};
};
static_assert(sizeof(SnapshotTail) == 56);

/// The rows of an object behind its box and its id: the generation is the first, and kNone stands for what
/// there is not.
struct SnapshotRows {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t layers = kNone, values = kNone, distances = kNone, levels = kNone;  ///< distances have two
  std::uint32_t count = 1;
  explicit SnapshotRows(std::uint32_t columns) noexcept {
    if (columns & SnapshotColumns::kLayers) layers = count++;
    if (columns & SnapshotColumns::kValues) values = count++;
    if (columns & SnapshotColumns::kDistances) distances = count, count += 2;
    if (columns & SnapshotColumns::kLevels) levels = count++;
  }
};

/// What a sector's bytes must be, by its counts.
constexpr std::uint64_t sector_bytes(const SectorEntry& e, const SnapshotRows& rows) noexcept {
  constexpr std::uint64_t kBoxAndId = 7;
  return 4 * (e.groups + std::uint64_t{2} * e.chunks + std::uint64_t{4} * e.splits +
              (kBoxAndId + rows.count) * e.objects);
}

/// Differs where one word of two equally long texts does; of other texts surely enough. `seed` is that of
/// what came before. Eight words at a time; FNV-1a, which files of baked visibility have, waits for a
/// multiplication at each byte, and sectors are checked while somebody flies towards them.
std::uint64_t checksum(Bytes bytes, std::uint64_t seed = 0) noexcept;

/// Reads words one after another, of bytes that the caller knows to be long enough.
class WordReader {
public:
  explicit WordReader(Bytes bytes) noexcept : at_(bytes.data()) {}
  template <class T>
  T take() noexcept {
    T value;
    copy(&value, 1);
    return value;
  }
  template <class T>
  void copy(T* to, std::size_t count) noexcept {
    if (count == 0) return;
    std::memcpy(to, at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }

private:
  const std::byte* at_;
};

/// All of the bytes but the sectors, checked.
struct SnapshotDirectory {
  Bytes bytes;
  std::uint32_t columns = 0;
  std::uint64_t objects = 0;
  std::vector<SectorEntry> sectors;
  std::vector<std::size_t> first_bytes;  ///< of these
  std::vector<FreeId> free_ids;
  std::vector<SnapshotTable> tables;

  [[nodiscard]] std::size_t id_limit() const noexcept {
    return static_cast<std::size_t>(objects) + free_ids.size();
  }
  [[nodiscard]] Bytes sector(std::size_t i) const noexcept {
    return bytes.subspan(first_bytes[i], sectors[i].bytes);
  }
};
Result<SnapshotDirectory> read_directory(Bytes bytes);

}  // namespace sightline::world
