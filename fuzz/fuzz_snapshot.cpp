// Any bytes as a world's snapshot: refused, or a world that can be culled, changed, saved and read again.
// Checksums would keep the fuzzer out, so they are made right first; one byte in two says otherwise.
#include <cstdlib>

#include <sightline/snapshot.hpp>

#include "tests/support/forged_checksums.hpp"

namespace {

using namespace sightline;

bool append(void* user, std::span<const std::byte> bytes) {
  auto& to = *static_cast<std::vector<std::byte>*>(user);
  to.insert(to.end(), bytes.begin(), bytes.end());
  return true;
}

CullView overview() {
  Camera camera{.eye = {0, 20'000, 0}, .forward = {0, -1, 0}, .up = {0, 0, 1}};
  camera.orthographic_height = 20'000, camera.near_plane = 0.1f, camera.far_plane = 40'000;
  return {.view = {*make_view(camera, 64, 64), {}}};
}

void use(World& world) {
  std::vector<Handle> handles;
  std::vector<WorldBox> boxes;
  for (std::size_t i = 0; i < world.id_limit(); ++i) {
    const Handle handle = world.handle(static_cast<ObjectId>(i));
    if (!world.contains(handle)) continue;
    handles.push_back(handle), boxes.push_back({{0, 0, 0}, {double(i), 1, 1}});
  }
  if (handles.size() != world.size()) std::abort();
  std::vector<ObjectId> ids(cull_capacity(world));
  Culler culler;
  const CullView view = overview();
  if (const auto seen = culler.cull(world, view, ids); !seen || seen->count > world.size()) std::abort();
  if (!world.move(handles, boxes) || !world.remove(handles) || world.size() != 0) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto given = std::as_bytes(std::span(data, size));
  std::vector<std::byte> bytes(given.begin(), given.end());
  if (size % 2 == 0) test::forge_checksums(bytes);
  if (Result<World> world = load(bytes)) {
    std::vector<std::byte> again;
    if (!save(*world, {append, &again}) || !load(again)) std::abort();
    use(*world);
  }
  World world;
  Result<WorldStream> stream = WorldStream::open(bytes, world);
  if (!stream) return 0;
  const CullView view = overview();
  for (const std::size_t budget : {std::size_t{1} << 40, std::size_t{0}, std::size_t{100'000}})
    if (const auto report = stream->bring_in({&view, 1}, {.budget = budget});
        !report || report->memory > budget)
      std::abort();
  use(world);
  return 0;
}
