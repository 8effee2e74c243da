// Flat culling: many boxes in your own arrays against one camera, in one call.
#include <cstdio>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>

int main() {
  sightline::Boxes trees;  // one array a coordinate, which is fastest; any BoxView over your own does as well
  for (int z = 0; z < 150; ++z) {
    for (int x = 0; x < 200; ++x) {
      const float at_x = 5.0f * static_cast<float>(x - 100), at_z = 6.0f * static_cast<float>(z - 75);
      trees.push_back({{at_x - 1.5f, 0, at_z - 1.5f}, {at_x + 1.5f, 8, at_z + 1.5f}});
    }
  }
  const auto view = sightline::make_view({.eye = {0, 8.9f, 0}, .forward = {0, 0, -1}}, 1280, 720);
  if (!view) return std::fprintf(stderr, "%s\n", view.error().message()), 2;

  const sightline::Frustum frustum = sightline::make_frustum(*view);
  std::vector<sightline::ObjectId> visible(trees.size() + sightline::kCullPadding);
  const auto count = sightline::cull_boxes(frustum, trees.view(), visible);
  if (!count) return std::fprintf(stderr, "%s\n", count.error().message()), 2;
  std::printf("draw %zu of %zu trees\n", *count, trees.size());
}
