// Two eyes and three shadow cascades of one sun, culled in one call: a mask says which view each object is
// drawn in.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sightline/sightline.hpp>

constexpr std::uint32_t kDrawn = 1, kCastsShadows = 2;  // layers of our own making

// The value, or the end with the library's sentence.
template <class T>
T need(const sightline::Result<T>& result) {
  if (result) return *result;
  std::fprintf(stderr, "%s\n", result.error().message());
  std::exit(2);
}

int main() {
  std::vector<sightline::Box> boxes;
  std::vector<std::uint32_t> layers;  // grass is drawn, trees cast shadows, too
  for (int i = 0; i < 40'000; ++i) {
    const float x = static_cast<float>(i % 200) * 5 - 500, z = static_cast<float>(i / 200) * -5;
    const bool tree = i % 4 == 0;
    boxes.push_back({{x - 1, 0, z - 1}, {x + 1, tree ? 12.0f : 0.5f, z + 1}});
    layers.push_back(tree ? kDrawn | kCastsShadows : kDrawn);
  }
  sightline::World world;
  std::vector<sightline::Handle> handles(boxes.size());
  if (const auto done = world.insert(boxes, handles, {.layers = layers}); !done)
    return std::fprintf(stderr, "%s\n", done.message()), 2;

  std::vector<sightline::CullView> views;
  for (const float eye : {-0.032f, 0.032f}) {
    const auto view = need(sightline::make_view({.eye = {eye, 1.7f, 10}, .far_plane = 400}, 1440, 1600));
    views.push_back({.view = {view, {}}, .layers = kDrawn});
  }
  for (const float size :
       {40.0f, 120.0f, 400.0f}) {  // each cascade holds what is as far ahead as it is large
    const auto view = need(sightline::make_view({.eye = {-300, 300, 10 - size / 2},
                                                 .forward = {1, -1, 0},
                                                 .orthographic_height = size,
                                                 .far_plane = 1000},
                                                2048, 2048));
    views.push_back({.view = {view, {}}, .layers = kCastsShadows, .min_area = 4});
  }

  sightline::Culler culler;
  std::vector<std::uint32_t> ids(sightline::cull_capacity(world));
  std::vector<std::uint8_t> masks(ids.size());
  const auto drawn = need(culler.cull(world, views, {}, {ids, masks}));
  std::array<std::size_t, 5> of_view{};
  for (std::size_t i = 0; i < drawn.count; ++i)
    for (std::size_t v = 0; v < views.size(); ++v) of_view[v] += masks[i] >> v & 1;
  std::printf("draw %zu of %zu objects: %zu and %zu for the eyes, %zu, %zu and %zu into the cascades\n",
              drawn.count, world.size(), of_view[0], of_view[1], of_view[2], of_view[3], of_view[4]);
}
