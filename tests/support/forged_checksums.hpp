// Snapshots whose checksums are right whatever stands in them.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "library/world/snapshot_format.hpp"

namespace sightline::test {

/// The tail of a snapshot, and where it stands.
inline world::SnapshotTail tail_of(std::span<const std::byte> bytes) {
  world::SnapshotTail tail;
  std::memcpy(&tail, bytes.data() + bytes.size() - sizeof tail, sizeof tail);
  return tail;
}

/// Makes all checksums right, where the bytes are long enough to have any, as somebody would who wants to do
/// harm.
inline void forge_checksums(std::vector<std::byte>& bytes) {
  using namespace world;
  if (bytes.size() < sizeof(SnapshotHead) + sizeof(SnapshotTail)) return;
  const std::span<std::byte> all(bytes);
  SnapshotTail tail = tail_of(bytes);
  const std::size_t end = bytes.size() - sizeof tail;
  if (tail.directory > end || tail.sectors > (end - tail.directory) / sizeof(SectorEntry)) return;
  std::uint64_t at = sizeof(SnapshotHead);
  for (std::size_t i = 0; i < tail.sectors; ++i) {
    std::byte* const place = bytes.data() + tail.directory + i * sizeof(SectorEntry);
    SectorEntry entry;
    std::memcpy(&entry, place, sizeof entry);
    if (at > tail.directory || entry.bytes > tail.directory - at) break;
    entry.checksum = checksum(all.subspan(at, entry.bytes));
    std::memcpy(place, &entry, sizeof entry);
    at += entry.bytes;
  }
  const std::uint64_t covered = end + offsetof(SnapshotTail, checksum) - tail.directory;
  tail.checksum = checksum(all.subspan(tail.directory, covered), checksum(all.first(sizeof(SnapshotHead))));
  std::memcpy(bytes.data() + end, &tail, sizeof tail);
}

}  // namespace sightline::test
