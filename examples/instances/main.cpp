// A city of ten thousand blocks, ten kinds of them, each a World of its own: what of it to draw.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include <sightline/sightline.hpp>

// The value, or the end with the library's sentence.
template <class T>
T need(const sightline::Result<T>& result) {
  if (result) return *result;
  std::fprintf(stderr, "%s\n", result.error().message());
  std::exit(2);
}

int main() {
  std::mt19937 random(1);
  const auto between = [&](float low, float high) {
    return low + (high - low) * float(random()) / 4294967296.0f;
  };

  // A block is 100 m wide and full of things: houses, lamps, benches.
  std::vector<sightline::World> blocks(10);
  sightline::Instances city;
  for (sightline::World& block : blocks) {
    std::vector<sightline::Box> things(10'000);
    for (sightline::Box& thing : things) {
      const float x = between(-50, 49), z = between(-50, 49), size = between(0.1f, 1);
      thing = {{x, 0, z}, {x + size, 5 * size, z + size}};
    }
    std::vector<sightline::Handle> handles(things.size());
    if (!block.insert(sightline::BoxView(things), handles)) return 2;
    need(city.add_world(block));  // named 0, 1, 2 and so on
  }

  // Each of them stands a thousand times, turned by some quarter.
  std::vector<sightline::InstancePlacement> placements;
  for (int i = 0; i < 10'000; ++i) {
    const float turn = 1.57079633f * float(random() % 4), c = std::cos(turn), s = std::sin(turn);
    const sightline::Mat4 matrix{{c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1}};
    placements.push_back({std::uint32_t(random() % 10), matrix, {i % 100 * 100.0, 0, i / 100 * -100.0}});
  }
  std::vector<sightline::Handle> handles(placements.size());
  if (!city.insert(placements, handles)) return 2;

  sightline::InstanceCuller culler;
  const sightline::View view =
      need(sightline::make_view({.eye = {5000, 30, 20}, .far_plane = 3000}, 1920, 1080));
  const sightline::InstanceCullResult seen = need(culler.cull(city, {.view = {view, {}}}));
  std::size_t whole = 0;
  for (const auto& [instance, first, count] : seen.ranges) {
    // Here: draw seen.ids.subspan(first, count) by the matrix of placements[instance].
    whole += count == 10'000;
  }
  std::printf("the city has %llu things: draw %llu in %zu blocks, %zu of them whole, by a list of %zu\n",
              static_cast<unsigned long long>(city.objects()), static_cast<unsigned long long>(seen.objects),
              seen.ranges.size(), whole, seen.ids.size());
}
