// A forest of trees in four levels of detail: which of them to draw, and at which level, without flicker.
#include <array>
#include <cstdio>
#include <cstdlib>
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
  std::vector<sightline::Box> trees;
  for (int i = 0; i < 40'000; ++i) {
    const float x = static_cast<float>(i % 200) * 6 - 600, z = static_cast<float>(i / 200) * -6;
    trees.push_back({{x - 2, 0, z - 2}, {x + 2, 9, z + 2}});
  }
  sightline::World world;
  std::vector<sightline::Handle> handles(trees.size());
  if (!world.insert(sightline::BoxView(trees), handles)) return 2;

  // Level 0 from 300 pixels on, 1 from 100, 2 from 30; below that, level 3.
  const std::array sizes{300.0f, 100.0f, 30.0f};
  const std::vector<sightline::LevelTableId> tables(trees.size(), need(world.add_levels(sizes)));
  if (!world.set_levels(handles, tables)) return 2;

  sightline::Culler culler;
  std::vector<sightline::ObjectId> ids(sightline::cull_capacity(world));
  std::vector<std::uint8_t> levels(ids.size()), fades(ids.size()), last(trees.size(), 255);
  for (const float hysteresis : {0.0f, 0.1f}) {
    std::size_t changes = 0, blended = 0;
    std::array<std::size_t, 4> drawn{};
    for (int frame = 0; frame < 100; ++frame) {
      // Somebody who stands there, and breathes.
      const float z = frame % 2 == 0 ? 10.0f : 9.5f;
      const sightline::CullView view{
          .view = {need(sightline::make_view({.eye = {0, 1.7f, z}}, 1920, 1080)), {}}};
      sightline::CullOptions options;
      options.levels = {.hysteresis = hysteresis, .fade = 0.2f, .cut = frame == 0};
      const std::size_t count = need(culler.cull(world, {&view, 1}, options, {ids, {}, levels, fades})).count;
      for (std::size_t i = 0; i < count; ++i) {
        changes += frame > 0 && last[ids[i]] != levels[i];
        blended += frame == 99 && fades[i] != 0;
        last[ids[i]] = levels[i];
        if (frame == 99) ++drawn[levels[i]];
      }
    }
    std::printf("hysteresis %.1f: %zu, %zu, %zu and %zu trees, %zu of them blended, %zu changes\n",
                double(hysteresis), drawn[0], drawn[1], drawn[2], drawn[3], blended, changes);
  }
}
