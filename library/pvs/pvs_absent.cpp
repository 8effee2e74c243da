// In place of pvs_bytes.cpp where the library is built without roaring and zstd.
#include <sightline/pvs.hpp>

namespace sightline {

namespace {

constexpr Status kAbsent{
    StatusCode::bad_file,
    "pvs: this Sightline was built without SIGHTLINE_PVS, expected one with roaring and zstd"};

}  // namespace

Result<std::vector<std::byte>> write_pvs(const CellPvs&) {
  return kAbsent;
}

Result<CellPvs> read_pvs(std::span<const std::byte>) {
  return kAbsent;
}

}  // namespace sightline
