#include "bake/pvs_file.hpp"

#include <roaring/roaring.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <memory>

#include <sightline/scene.hpp>

#include "io/byte_reader.hpp"
#include "io/files.hpp"

namespace sightline::bake {

using io::Bytes;
using io::fits;
using io::read_at;

namespace {

constexpr char kMagic[8] = {'S', 'i', 'g', 'h', 't', 'P', 'V', 'S'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 84;
constexpr std::size_t kChecksumAt = 76;
constexpr std::uint64_t kMostCells = std::uint64_t{1} << 22;
constexpr std::uint32_t kMostObjects = 1u << 30;
constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30;
constexpr std::size_t kMostVisible = std::size_t{1} << 28;  // runs are short in the file and long in memory

struct Header {
  std::uint32_t version, objects;
  std::uint64_t scene;
  std::array<std::uint32_t, 3> counts;
  std::array<float, 6> bounds;
  std::uint64_t unpacked, packed, checksum;
};

// The cell before this one along x (1), y (2) or z (3).
std::uint32_t neighbour(const CellPvs& cells, std::uint32_t cell, std::uint8_t axis) {
  const std::uint32_t x = cells.counts[0], y = cells.counts[1];
  if (axis == 1) return cell % x > 0 ? cell - 1 : kNoCell;
  if (axis == 2) return cell / x % y > 0 ? cell - x : kNoCell;
  return cell >= x * y ? cell - x * y : kNoCell;
}

template <class T>
void put(std::vector<std::byte>& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

void copy_to(std::vector<std::byte>& out, std::size_t at, std::uint64_t value) {
  std::memcpy(out.data() + at, &value, sizeof value);
}

// FNV-1a of the file without the checksum itself.
std::uint64_t checksum_of_file(Bytes file) {
  const std::uint64_t head = checksum(file.first(kChecksumAt));
  return checksum(file.subspan(kHeader), head);
}

}  // namespace

std::uint64_t checksum(Bytes bytes, std::uint64_t seed) noexcept {
  for (const std::byte byte : bytes) seed = (seed ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  return seed;
}

std::vector<std::byte> pack_set(std::span<const std::uint32_t> ids) {
  const std::unique_ptr<roaring_bitmap_t, decltype(&roaring_bitmap_free)> bitmap(
      roaring_bitmap_of_ptr(ids.size(), ids.data()), roaring_bitmap_free);
  if (!bitmap) throw std::bad_alloc();
  roaring_bitmap_run_optimize(bitmap.get());
  std::vector<std::byte> bytes(roaring_bitmap_portable_size_in_bytes(bitmap.get()));
  roaring_bitmap_portable_serialize(bitmap.get(), reinterpret_cast<char*>(bytes.data()));
  return bytes;
}

// The portable form (github.com/RoaringBitmap/RoaringFormatSpec), read here and not by the library: its
// reader does not check what lies within the containers.
void unpack_set(Bytes b, std::uint32_t objects, const std::string& what, std::vector<std::uint32_t>& ids) {
  const auto fail = [&](const char* why) { throw Error(what + ": " + why); };
  constexpr std::uint32_t kNoRuns = 12346, kRuns = 12347;
  constexpr std::uint32_t kArrayMost = 4096, kFewWithRuns = 4;
  if (b.size() < 4) fail("ends within its header");
  const auto cookie = read_at<std::uint32_t>(b, 0);
  std::size_t at = 4, count = 0;
  const bool has_runs = (cookie & 0xffff) == kRuns;
  std::size_t run_flags = 0;
  if (has_runs) {
    count = (cookie >> 16) + 1;
    run_flags = at;
    at += (count + 7) / 8;
  } else if (cookie == kNoRuns) {
    if (b.size() < 8) fail("ends within its header");
    count = read_at<std::uint32_t>(b, 4);
    at = 8;
  } else {
    fail("is no bitmap");
  }
  if (count > 65536 || !fits(at, count * 4, b.size())) fail("names more containers than it holds");
  const std::size_t keys = at;
  at += count * 4;
  if (!has_runs || count >= kFewWithRuns) at += count * 4;  // offsets, which follow from the sizes
  std::int64_t last = -1;
  const auto add = [&](std::uint32_t id) {
    if (static_cast<std::int64_t>(id) <= last || id >= objects)
      fail("holds objects out of order or out of range");
    if (ids.size() >= kMostVisible) fail("holds more than Sightline reads");
    last = id;
    ids.push_back(id);
  };
  for (std::size_t c = 0; c < count; ++c) {
    const std::uint32_t high = std::uint32_t{read_at<std::uint16_t>(b, keys + c * 4)} << 16;
    const std::uint32_t members = std::uint32_t{read_at<std::uint16_t>(b, keys + c * 4 + 2)} + 1;
    const bool is_run = has_runs && (static_cast<unsigned>(b[run_flags + c / 8]) >> (c % 8) & 1u) != 0;
    if (is_run) {
      if (!fits(at, 2, b.size())) fail("ends within a container");
      const std::uint32_t runs = read_at<std::uint16_t>(b, at);
      at += 2;
      if (!fits(at, std::uint64_t{runs} * 4, b.size())) fail("ends within a container");
      for (std::uint32_t r = 0; r < runs; ++r, at += 4) {
        const std::uint32_t start = read_at<std::uint16_t>(b, at), length = read_at<std::uint16_t>(b, at + 2);
        if (start + length > 0xffff) fail("has a run beyond its container");
        for (std::uint32_t i = 0; i <= length; ++i) add(high | (start + i));
      }
    } else if (members <= kArrayMost) {
      if (!fits(at, std::uint64_t{members} * 2, b.size())) fail("ends within a container");
      for (std::uint32_t i = 0; i < members; ++i, at += 2) add(high | read_at<std::uint16_t>(b, at));
    } else {
      if (!fits(at, 8192, b.size())) fail("ends within a container");
      for (std::uint32_t i = 0; i < 65536; ++i) {
        if ((static_cast<unsigned>(b[at + i / 8]) >> (i % 8) & 1u) != 0) add(high | i);
      }
      at += 8192;
    }
  }
  if (at != b.size()) fail("is longer than its containers");
}

std::vector<std::byte> pack_cells(const CellPvs& cells) {
  std::vector<std::byte> unpacked;
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (!cells.open[cell]) {
      put(unpacked, std::uint32_t{0});
      continue;
    }
    // As the difference from the neighbour that is most alike: what is seen changes little from cell to cell.
    std::vector<std::uint32_t> least(cells.seen_from(cell).begin(), cells.seen_from(cell).end()), difference;
    std::uint8_t like = 0;
    for (std::uint8_t axis = 1; axis <= 3; ++axis) {
      const std::uint32_t other = neighbour(cells, cell, axis);
      if (other == kNoCell || !cells.open[other]) continue;
      difference.clear();
      std::ranges::set_symmetric_difference(cells.seen_from(cell), cells.seen_from(other),
                                            std::back_inserter(difference));
      if (difference.size() < least.size()) least = difference, like = axis;
    }
    const std::vector<std::byte> set = pack_set(least);
    put(unpacked, static_cast<std::uint32_t>(set.size() + 1));
    put(unpacked, like);
    unpacked.insert(unpacked.end(), set.begin(), set.end());
  }
  std::vector<std::byte> packed(ZSTD_compressBound(unpacked.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), unpacked.data(), unpacked.size(), 19);
  if (ZSTD_isError(size)) throw Error(std::string("bake: zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);

  std::vector<std::byte> file;
  for (const char c : kMagic) put(file, c);
  put(file, kVersion), put(file, cells.objects), put(file, cells.scene);
  for (const std::uint32_t count : cells.counts) put(file, count);
  const Box& b = cells.bounds;
  for (const float x : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) put(file, x);
  put(file, std::uint64_t{unpacked.size()}), put(file, std::uint64_t{packed.size()}),
      put(file, std::uint64_t{0});
  file.insert(file.end(), packed.begin(), packed.end());
  copy_to(file, kChecksumAt, checksum_of_file(file));
  return file;
}

CellPvs unpack_cells(Bytes file, const std::string& name) {
  const auto fail = [&](const std::string& why) { throw Error(name + ": " + why); };
  if (file.size() < sizeof kMagic || std::memcmp(file.data(), kMagic, sizeof kMagic) != 0) {
    fail("is no file of baked visibility, expected one that 'sightline bake' wrote");
  }
  if (file.size() < kHeader)
    fail("ends within its header, expected at least " + std::to_string(kHeader) + " bytes");
  const auto version = read_at<std::uint32_t>(file, 8);
  if (version != kVersion) {
    fail("has version " + std::to_string(version) + ", expected " + std::to_string(kVersion) +
         "; bake it again");
  }
  CellPvs cells;
  cells.objects = read_at<std::uint32_t>(file, 12);
  cells.scene = read_at<std::uint64_t>(file, 16);
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.counts[axis] = read_at<std::uint32_t>(file, 24 + 4 * axis);
    if (cells.counts[axis] == 0 || cells.counts[axis] > kMostCells)
      fail("its number of cells is out of range");
    count *= cells.counts[axis];
    if (count > kMostCells) fail("its number of cells is out of range");
  }
  if (cells.objects == 0 || cells.objects > kMostObjects) fail("its number of objects is out of range");
  const auto bound = [&](std::size_t i) { return read_at<float>(file, 36 + 4 * i); };
  cells.bounds = {{bound(0), bound(1), bound(2)}, {bound(3), bound(4), bound(5)}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(bound(axis)) || !std::isfinite(bound(axis + 3)) || !(bound(axis) <= bound(axis + 3))) {
      fail("its bounds are not finite with min <= max");
    }
  }
  const auto unpacked_size = read_at<std::uint64_t>(file, 60), packed_size = read_at<std::uint64_t>(file, 68);
  if (packed_size > file.size() - kHeader) {
    fail("is truncated: expected " + std::to_string(packed_size) + " bytes of sets, found " +
         std::to_string(file.size() - kHeader));
  }
  if (packed_size < file.size() - kHeader) fail("goes on after its end");
  if (read_at<std::uint64_t>(file, kChecksumAt) != checksum_of_file(file)) {
    fail("is damaged: its checksum does not match");
  }
  // A bitmap takes at most 8 KiB and a few words for 65,536 objects.
  const std::uint64_t containers = cells.objects / 65536 + 1;
  if (unpacked_size > kMostBytes || unpacked_size > count * (16 + containers * 8208))
    fail("its sets are too large");
  const Bytes packed = file.subspan(kHeader);
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != unpacked_size) fail("its sets do not unpack");
  std::vector<std::byte> sets(unpacked_size);
  if (ZSTD_decompress(sets.data(), sets.size(), packed.data(), packed.size()) != unpacked_size) {
    fail("its sets do not unpack");
  }
  std::size_t at = 0;
  std::vector<std::uint32_t> difference;
  cells.first.push_back(0);
  for (std::uint64_t cell = 0; cell < count; ++cell) {
    if (!fits(at, 4, sets.size())) fail("ends before its last cell");
    const std::size_t length = read_at<std::uint32_t>(sets, at);
    at += 4;
    if (!fits(at, length, sets.size())) fail("cell " + std::to_string(cell) + " ends beyond the file");
    if (length > 0) {
      const std::string what = name + ": cell " + std::to_string(cell);
      const auto like = static_cast<std::uint8_t>(sets[at]);
      difference.clear();
      unpack_set(Bytes(sets).subspan(at + 1, length - 1), cells.objects, what, difference);
      if (like == 0) {
        cells.visible.insert(cells.visible.end(), difference.begin(), difference.end());
      } else {
        const std::uint32_t other =
            like <= 3 ? neighbour(cells, static_cast<std::uint32_t>(cell), like) : kNoCell;
        if (other == kNoCell || !cells.open[other])
          fail("cell " + std::to_string(cell) + " is like one that is not there");
        const std::vector<std::uint32_t> seen(cells.seen_from(other).begin(), cells.seen_from(other).end());
        std::ranges::set_symmetric_difference(seen, difference, std::back_inserter(cells.visible));
      }
      if (cells.visible.size() > kMostVisible) fail("holds more than Sightline reads");
    }
    cells.open.push_back(length > 0);
    cells.first.push_back(cells.visible.size());
    at += length;
  }
  if (at != sets.size()) fail("goes on after its last cell");
  return cells;
}

void write_pvs(const CellPvs& cells, const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = pack_cells(cells);
  const std::span<const std::byte> pieces[] = {bytes};
  io::write_file(file, pieces);
}

CellPvs read_pvs(const std::filesystem::path& file) {
  return unpack_cells(io::read_file(file), file.string());
}

void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene) {
  if (cells.objects == scene.size() && cells.scene == fingerprint(scene)) return;
  throw Error(file + ": was baked for another scene than '" + scene.name + "'");
}

}  // namespace sightline::bake
