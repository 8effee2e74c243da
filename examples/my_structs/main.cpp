// A hundred thousand moving objects in your own structs: the library reads their boxes, and writes their
// handles, where they lie.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include <sightline/sightline.hpp>

struct Thing {
  char name[12];
  float position[3], half[3], speed[3];
  sightline::Handle handle;
};

int main() {
  std::vector<Thing> things(100'000);
  for (std::size_t i = 0; i < things.size(); ++i) {
    const float x = 5.0f * static_cast<float>(i % 400) - 1000, z = -5.0f * static_cast<float>(i / 400);
    things[i] = {"", {x, 1, z}, {1, 1, 1}, {0, 0, i % 2 ? 2.0f : -2.0f}, {}};
  }
  const auto boxes =
      sightline::BoxView::centre_half(things[0].position, things[0].half, sizeof(Thing), things.size());
  const sightline::Strided<sightline::Handle> handles(&things[0].handle, things.size(), sizeof(Thing));

  sightline::World world;
  if (const auto done = world.insert(boxes, handles); !done)
    return std::fprintf(stderr, "%s\n", done.message()), 2;

  const auto camera = sightline::make_view({.eye = {0, 2, 10}}, 1280, 720);
  if (!camera) return std::fprintf(stderr, "%s\n", camera.error().message()), 2;

  sightline::Culler culler;  // kept from frame to frame, as the ids are: frames allocate nothing
  std::vector<std::uint32_t> ids(sightline::cull_capacity(world));
  for (int frame = 0; frame < 3; ++frame) {
    for (Thing& thing : things) thing.position[2] += thing.speed[2] / 60;
    if (const auto done = world.move(handles, boxes); !done)
      return std::fprintf(stderr, "%s\n", done.message()), 2;

    const auto drawn = culler.cull(world, {.view = {*camera, {}}}, ids);
    if (!drawn) return std::fprintf(stderr, "%s\n", drawn.error().message()), 2;
    // Here you draw them: an id is the thing's place, as all were inserted at once into a new world.
    float nearest = 1e9f;
    for (const std::uint32_t id : std::span(ids).first(drawn->count))
      nearest = std::min(nearest, 10 - things[id].position[2]);
    std::printf("frame %d: draw %zu of %zu things, the nearest %.2f m ahead\n", frame, drawn->count,
                world.size(), static_cast<double>(nearest));
  }
}
