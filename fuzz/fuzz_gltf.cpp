// Any bytes as glTF, text or binary: a scene that passes its check, or an Error.
#include <cstdlib>

#include <sightline/workbench/io.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  try {
    if (check(read_gltf(std::as_bytes(std::span(data, size)), "fuzz.gltf"))) std::abort();
  } catch (const Error&) {
  }
  return 0;
}
