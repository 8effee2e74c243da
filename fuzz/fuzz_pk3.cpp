// Any bytes as an archive: its entry unpacks within the limits and reads, or an Error.
#include <sightline/workbench/io.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  try {
    read_pk3(std::as_bytes(std::span(data, size)), "maps/sample.bsp", "fuzz.pk3", {2});
  } catch (const Error&) {
  }
  return 0;
}
