// A town in the evening sun: which of its houses throw a shadow on anything that somebody in a street sees.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include <sightline/sightline.hpp>

void need(const sightline::Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", status.message());
  std::exit(2);
}

int main() {
  std::vector<sightline::Box> houses;
  for (float x = -1000; x < 1000; x += 20)
    for (float z = -1000; z < 1000; z += 20)
      houses.push_back({{x + 3, 0, z + 3}, {x + 18, x * z > 0 ? 18.0f : 6.0f, z + 18}});
  sightline::World world;
  std::vector<sightline::Handle> handles(houses.size());
  need(world.insert(sightline::BoxView(houses), handles));
  const auto eye = sightline::make_view({.eye = {0, 1.7f, 300}, .far_plane = 500}, 1280, 720);
  if (!eye) need(eye.error());
  const sightline::WorldView camera{*eye, {}};

  // What the camera sees, and how deep it sees at each pixel: the houses hide one another.
  sightline::Culler culler;
  sightline::OcclusionBuffer depth;
  std::vector<sightline::ObjectId> seen(sightline::cull_capacity(world)), cast(seen.size());
  need(depth.begin(camera));
  need(depth.draw_boxes(sightline::BoxView(houses)));
  const auto drawn = culler.cull(world, {.view = camera, .occlusion = &depth}, seen);
  if (!drawn) need(drawn.error());
  seen.resize(drawn->count);
  std::printf("the camera sees %zu of %zu houses\n", drawn->count, world.size());

  // Three shadow maps, which stand still while the camera turns and goes.
  std::array<sightline::Cascade, 3> cascades;
  need(sightline::split_cascades({.direction = {2, -1, 0.3f}, .reach = 200}, camera, {}, cascades));
  sightline::ShadowCasters casters;
  for (const auto& [map, depths] : cascades) {
    const auto all = culler.cull(world, {.view = map}, cast);
    need(casters.begin(map, camera, depths));
    const auto towards = culler.cull(world, {.view = map, .casters = &casters}, cast);
    need(casters.receive(world, seen, &depth));
    const auto left = culler.cull(world, {.view = map, .casters = &casters}, cast);
    if (!all || !towards || !left) need(left.error());
    std::printf("%.0f to %.0f m: %zu houses in the map, %zu towards the light, %zu throw a shadow there\n",
                double(depths.near_plane), double(depths.far_plane), all->count, towards->count, left->count);
  }
}
