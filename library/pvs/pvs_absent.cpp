// In place of pvs_bytes.cpp where the library is built without roaring and zstd.
#include <sightline/pvs.hpp>

namespace sightline {

Result<std::vector<std::byte>> write_pvs(const CellPvs&) {
  return Failure{"pvs: this Sightline was built without SIGHTLINE_PVS, expected one with roaring and zstd"};
}

Result<CellPvs> read_pvs(std::span<const std::byte>, std::string_view name) {
  return Failure{std::string(name) +
                 ": this Sightline was built without SIGHTLINE_PVS, expected one with roaring and zstd"};
}

}  // namespace sightline
