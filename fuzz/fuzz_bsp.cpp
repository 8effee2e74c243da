// Any bytes as a Quake 3 level: a scene that passes its check, or an Error. What it says must hold: each
// place has a leaf, each leaf's objects exist.
#include <cstdlib>

#include <sightline/workbench/io.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  Scene scene;
  try {
    scene = read_bsp(std::as_bytes(std::span(data, size)), "fuzz.bsp", {2});
  } catch (const Error&) {
    return 0;
  }
  check(scene);  // what it throws nobody catches
  if (!scene.level) std::abort();
  std::vector<std::uint8_t> mask(scene.size());
  for (const Viewpoint& view : scene.viewpoints) scene.level->potentially_visible(view.eye, mask);
  return 0;
}
