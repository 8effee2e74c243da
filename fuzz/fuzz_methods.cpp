// Methods by name with any parameters, on any view: a method whose answers are ones, or an Error.
#include <cstdlib>
#include <string>
#include <vector>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>

#include "views.hpp"

namespace {

using namespace sightline;
using fuzz::Numbers;
using fuzz::require;

const Scene& fifty_objects() {
  static const Scene scene = [] {
    Scene made;
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, normals(4, {0, 1, 0});
    const std::uint32_t mesh =
        made.add_mesh(corners, normals, std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    for (int i = 0; i < 50; ++i) {
      Affine at;
      at.rows[0].w = static_cast<float>(i % 10) * 3 - 15, at.rows[2].w = static_cast<float>(i / 10) * -5;
      made.add_object(mesh, at);
    }
    return made;
  }();
  return scene;
}

std::string specification(Numbers& in) {
  const auto known = all_methods();
  std::string name(known[in.byte() % known.size()].name);
  if (in.byte() & 1) {
    name += '?';
    for (std::size_t i = in.byte() % 24; i > 0; --i) name += static_cast<char>(in.byte());
  }
  return name;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers in(data, size);
  const Scene& scene = fifty_objects();
  while (!in.empty()) {
    const View view = fuzz::view_of(in);
    Frame frame;
    try {
      cull(*create_method(specification(in), scene), view, frame);
    } catch (const Error&) {
      continue;
    }
    require(static_cast<bool>(check(view)) && frame.visible.size() <= scene.size());
    for (const ObjectId id : frame.visible) require(id < scene.size());
  }
  return 0;
}
