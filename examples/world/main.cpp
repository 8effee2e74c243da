// A moving world, a camera, and what to draw, every frame: the library's main use.
#include <cmath>
#include <cstdio>
#include <vector>

#include <sightline/sightline.hpp>
#ifdef WITH_TBB
#include <sightline/tbb.hpp>
#endif

int main() {
  // Your objects' boxes. A handle names each for as long as it stands; its index is the id that cull()
  // writes.
  std::vector<sightline::WorldBox> boxes;
  for (int i = 0; i < 100'000; ++i) {
    const double x = i % 400 * 5.0 - 1000, z = i / 400 * -5.0;
    boxes.push_back({{x - 1, 0, z - 1}, {x + 1, 2.0 + i % 7, z + 1}});
  }
  std::vector<sightline::Handle> handles(boxes.size());
  sightline::World world;
  if (const auto bad = world.insert(boxes, handles))
    return std::fprintf(stderr, "%s\n", bad->message.c_str()), 2;

  // Kept from frame to frame, so that nothing is allocated in them.
  sightline::OcclusionBuffer occlusion;
  sightline::CullOptions options;
#ifdef WITH_TBB
  options.jobs = sightline::tbb_jobs();
#endif
  std::vector<sightline::ObjectId> visible(sightline::cull_capacity(world, options));

  for (int frame = 0; frame < 3; ++frame) {
    // A tenth of the boxes moves.
    for (std::size_t i = 0; i < boxes.size() / 10; ++i) boxes[i].min.y += 0.1, boxes[i].max.y += 0.1;
    const auto moved = boxes.size() / 10;
    if (world.move(std::span(handles).first(moved), std::span(boxes).first(moved))) return 2;

    const auto view = sightline::make_view({.eye = {0, 1.7f, 10}}, 1280, 720);
    if (!view) return 2;
    const sightline::WorldView camera{*view, {}};

    // Near, solid things hide what is behind them. Here the front row is solid.
    if (occlusion.begin(camera)) return 2;
    occlusion.draw_boxes(std::span<const sightline::WorldBox>(boxes).first(2000));
    const sightline::OcclusionBuffer* occluders = &occlusion;

    options.occlusion = {&occluders, 1};
    const auto drawn = sightline::cull(world, {&camera, 1}, options, visible);
    std::printf("frame %d: draw %zu of %zu boxes; occlusion alone dropped %llu\n", frame, drawn.count,
                world.size(), static_cast<unsigned long long>(drawn.culled_occlusion));
  }
}
