// The bytes of baked potentially visible sets: a header, and all cells' sets (cell_coding.hpp) in one zstd
// frame. Little-endian:
//
//   8  "SightPVS"     4  version (2)      4  objects          8  fingerprint of the scene
//   12 cells x, y, z  24 bounds           8  bytes unpacked   8  bytes packed    8  checksum (FNV-1a) of all
//   else
//
// then the packed bytes.
#include <zstd.h>

#include <cmath>
#include <cstring>

#include <sightline/pvs.hpp>

#include "library/pvs/byte_reader.hpp"
#include "library/pvs/cell_coding.hpp"
#include "library/pvs/checksum.hpp"
#include "library/pvs/set_coding.hpp"

namespace sightline {

namespace {

using pvs::Bytes;
using pvs::checksum;
using pvs::read_at;

constexpr char kMagic[8] = {'S', 'i', 'g', 'h', 't', 'P', 'V', 'S'};
constexpr std::uint32_t kFormat = 2;
constexpr std::size_t kHeader = 84;
constexpr std::size_t kChecksumAt = 76;
constexpr std::uint32_t kMostObjects = 1u << 30;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 29;

template <class T>
void put(std::vector<std::byte>& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

// Of all bytes but the checksum itself.
std::uint64_t checksum_of_file(Bytes file) {
  const std::uint64_t head = checksum(file.first(kChecksumAt));
  return checksum(file.subspan(kHeader), head);
}

Result<std::vector<std::byte>> compress(Bytes bytes) {
  constexpr std::size_t kMany = std::size_t{1} << 26;  // beyond, the strongest takes minutes
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), bytes.size() > kMany ? 9 : 19);
  if (ZSTD_isError(size))
    return Status{StatusCode::too_many, "pvs: the sets do not fit into memory compressed"};
  packed.resize(size);
  return packed;
}

// Whether the cells hold what <sightline/pvs.hpp> says.
bool sound(const CellPvs& cells) {
  std::uint64_t count = 1;
  for (const std::uint32_t along : cells.counts) {
    if (along == 0 || along > kMostCells) return false;
    count *= along;
    if (count > kMostCells) return false;
  }
  if (cells.objects == 0) return false;
  if (cells.size() != count || cells.first.size() != count + 1 || cells.first[0] != 0) return false;
  for (std::uint32_t cell = 0; cell < count; ++cell) {
    const std::uint64_t first = cells.first[cell], end = cells.first[cell + 1];
    if (end < first || end > cells.visible.size() || (!cells.open[cell] && end > first)) return false;
    for (std::uint64_t i = first; i < end; ++i) {
      if (cells.visible[i] >= cells.objects) return false;
      if (i > first && cells.visible[i] <= cells.visible[i - 1]) return false;
    }
  }
  return cells.first[count] == cells.visible.size();
}

// What the header says beside the cells.
struct Header {
  std::uint64_t unpacked_size = 0, packed_size = 0;
};

Status damaged(const char* why, std::size_t at) {
  return {StatusCode::bad_file, why, at};
}

Status read_counts(Bytes file, CellPvs& cells) {
  cells.objects = read_at<std::uint32_t>(file, 12);
  cells.scene = read_at<std::uint64_t>(file, 16);
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.counts[axis] = read_at<std::uint32_t>(file, 24 + 4 * axis);
    if (cells.counts[axis] == 0 || cells.counts[axis] > kMostCells) {
      return damaged("pvs: its number of cells is out of range", 24);
    }
    count *= cells.counts[axis];
    if (count > kMostCells) return damaged("pvs: its number of cells is out of range", 24);
  }
  if (cells.objects == 0 || cells.objects > kMostObjects)
    return damaged("pvs: its number of objects is out of range", 12);
  const auto bound = [&](std::size_t i) { return read_at<float>(file, 36 + 4 * i); };
  cells.bounds = {{bound(0), bound(1), bound(2)}, {bound(3), bound(4), bound(5)}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(bound(axis)) || !std::isfinite(bound(axis + 3)) || !(bound(axis) <= bound(axis + 3))) {
      return damaged("pvs: its bounds are not finite with min <= max", 36);
    }
  }
  return {};
}

Status read_header(Bytes file, CellPvs& cells, Header& header) {
  if (file.size() < sizeof kMagic || std::memcmp(file.data(), kMagic, sizeof kMagic) != 0) {
    return damaged("pvs: it is no file of baked visibility, expected one that 'sightline bake' wrote", 0);
  }
  if (file.size() < kHeader)
    return damaged("pvs: it ends within its header, expected at least 84 bytes", file.size());
  if (read_at<std::uint32_t>(file, 8) != kFormat)
    return damaged("pvs: it has another version than 2, the one that is read; bake it again", 8);
  if (const Status sound = read_counts(file, cells); !sound) return sound;
  header = {read_at<std::uint64_t>(file, 60), read_at<std::uint64_t>(file, 68)};
  const std::uint64_t rest = file.size() - kHeader;
  if (header.packed_size > rest)
    return damaged("pvs: it is truncated, expected as many bytes of sets as its header says", file.size());
  if (header.packed_size < rest)
    return damaged("pvs: it goes on after its end", kHeader + header.packed_size);
  if (read_at<std::uint64_t>(file, kChecksumAt) != checksum_of_file(file))
    return damaged("pvs: it is damaged, its checksum does not match", kChecksumAt);
  if (header.unpacked_size > kMostBytes) return damaged("pvs: its sets are too large", 60);
  return {};
}

}  // namespace

Result<std::vector<std::byte>> write_pvs(const CellPvs& cells) {
  if (cells.objects > kMostObjects)
    return Status{StatusCode::too_many, "pvs: there are too many objects, expected at most 1073741824"};
  if (!sound(cells)) {
    return Status{StatusCode::bad_argument,
                  "pvs: the cells are not sound, expected a flag and a set for each, in ascending order of "
                  "objects that there are"};
  }
  const std::vector<std::uint32_t> order = pvs::object_order(cells);
  std::vector<std::byte> packed;
  std::size_t unpacked_size = 0;
  for (const pvs::Layout layout : pvs::kLayouts) {
    if (layout == pvs::Layout::by_object && order.empty()) continue;
    const std::vector<std::byte> unpacked = pvs::code_cells(cells, layout, order);
    if (unpacked.size() > kMostBytes || cells.visible.size() > pvs::kMostMembers) {
      return Status{StatusCode::too_many,
                    "pvs: the sets are larger than Sightline reads, expected larger cells"};
    }
    Result<std::vector<std::byte>> smaller = compress(unpacked);
    if (!smaller) return smaller.error();
    if (!packed.empty() && smaller->size() >= packed.size()) continue;
    packed = *std::move(smaller), unpacked_size = unpacked.size();
  }

  std::vector<std::byte> file;
  for (const char c : kMagic) put(file, c);
  put(file, kFormat), put(file, cells.objects), put(file, cells.scene);
  for (const std::uint32_t count : cells.counts) put(file, count);
  const Box& b = cells.bounds;
  for (const float x : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) put(file, x);
  put(file, std::uint64_t{unpacked_size}), put(file, std::uint64_t{packed.size()});
  put(file, std::uint64_t{0});
  file.insert(file.end(), packed.begin(), packed.end());
  const std::uint64_t sum = checksum_of_file(file);
  std::memcpy(file.data() + kChecksumAt, &sum, sizeof sum);
  return file;
}

Result<CellPvs> read_pvs(Bytes file) {
  CellPvs cells;
  Header header;
  if (const Status sound = read_header(file, cells, header); !sound) return sound;
  const Bytes packed = file.subspan(kHeader);
  constexpr Status kNotUnpacked{StatusCode::bad_file, "pvs: its sets do not unpack", kHeader};
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != header.unpacked_size) return kNotUnpacked;
  std::vector<std::byte> sets(header.unpacked_size);
  if (ZSTD_decompress(sets.data(), sets.size(), packed.data(), packed.size()) != header.unpacked_size)
    return kNotUnpacked;
  if (const Status sound = pvs::decode_cells(sets, cells); !sound) return sound;
  return cells;
}

}  // namespace sightline
