// Any bytes as baked visibility: sets whose objects are in range and ascending, or a refusal. Checksum and
// compression would keep the fuzzer out, so the bytes are also read as a lone set, as the sets of a few cells
// before compression, and as a file whose checksum is right.
#include <cstdlib>
#include <cstring>

#include <sightline/pvs.hpp>

#include "library/pvs/cell_coding.hpp"
#include "library/pvs/checksum.hpp"
#include "library/pvs/set_coding.hpp"

namespace {

void expect_sound(const sightline::CellPvs& cells) {
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    std::int64_t last = -1;
    for (const std::uint32_t object : cells.seen_from(cell)) {
      if (object <= last || object >= cells.objects) std::abort();
      last = object;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  const auto bytes = std::as_bytes(std::span(data, size));
  std::vector<std::uint32_t> ids;
  (void)pvs::unpack_set(bytes, 100000, ids);
  CellPvs few;
  few.counts = {3, 2, 2}, few.objects = 60;
  if (pvs::decode_cells(bytes, few)) expect_sound(few);
  constexpr std::size_t kHeader = 84, kChecksumAt = 76;
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  if (size >= kHeader) {
    const std::uint64_t sum =
        pvs::checksum(std::span(file).subspan(kHeader), pvs::checksum(std::span(file).first(kChecksumAt)));
    std::memcpy(file.data() + kChecksumAt, &sum, sizeof sum);
  }
  if (const Result<CellPvs> cells = read_pvs(file)) expect_sound(*cells);
  return 0;
}
