// Any bytes as glTF, text or binary: a scene that passes its check, or an Error.
#include <sightline/workbench/io.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  Scene scene;
  try {
    scene = read_gltf(std::as_bytes(std::span(data, size)), "fuzz.gltf");
  } catch (const Error&) {
    return 0;
  }
  check(scene);  // what it throws nobody catches
  return 0;
}
