#include "library/pvs/pvs_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <sightline/workbench/scene.hpp>

#include "library/pvs/cell_coding.hpp"
#include "library/pvs/set_coding.hpp"
#include "workbench/io/byte_reader.hpp"
#include "workbench/io/files.hpp"

namespace sightline::pvs {

using io::Bytes;
using io::read_at;

namespace {

constexpr char kMagic[8] = {'S', 'i', 'g', 'h', 't', 'P', 'V', 'S'};
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = 84;
constexpr std::size_t kChecksumAt = 76;
constexpr std::uint32_t kMostObjects = 1u << 30;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 29;

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

namespace {

std::vector<std::byte> compress(std::span<const std::byte> bytes) {
  constexpr std::size_t kMany = std::size_t{1} << 26;  // beyond, the strongest takes minutes
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), bytes.size() > kMany ? 9 : 19);
  if (ZSTD_isError(size)) throw Error(std::string("bake: zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace

std::vector<std::byte> pack_cells(const CellPvs& cells) {
  const std::vector<std::uint32_t> order = object_order(cells);
  std::vector<std::byte> packed;
  std::size_t unpacked_size = 0;
  for (const Layout layout : kLayouts) {
    if (layout == Layout::by_object && order.empty()) continue;
    const std::vector<std::byte> unpacked = code_cells(cells, layout, order);
    if (unpacked.size() > kMostBytes || cells.visible.size() > kMostMembers) {
      throw Error("bake: the sets are larger than Sightline reads, expected a larger --cell");
    }
    std::vector<std::byte> smaller = compress(unpacked);
    if (!packed.empty() && smaller.size() >= packed.size()) continue;
    packed = std::move(smaller), unpacked_size = unpacked.size();
  }

  std::vector<std::byte> file;
  for (const char c : kMagic) put(file, c);
  put(file, kVersion), put(file, cells.objects), put(file, cells.scene);
  for (const std::uint32_t count : cells.counts) put(file, count);
  const Box& b = cells.bounds;
  for (const float x : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) put(file, x);
  put(file, std::uint64_t{unpacked_size}), put(file, std::uint64_t{packed.size()}),
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
  if (unpacked_size > kMostBytes) fail("its sets are too large");
  const Bytes packed = file.subspan(kHeader);
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != unpacked_size) fail("its sets do not unpack");
  std::vector<std::byte> sets(unpacked_size);
  if (ZSTD_decompress(sets.data(), sets.size(), packed.data(), packed.size()) != unpacked_size) {
    fail("its sets do not unpack");
  }
  decode_cells(sets, name, cells);
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

}  // namespace sightline::pvs
