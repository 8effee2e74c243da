// A moving world, a camera, what hides what, and what to draw, every frame: the library's main use.
#include <cstdio>
#include <span>
#include <vector>

#include <sightline/sightline.hpp>
#ifdef WITH_TBB
#include <sightline/tbb.hpp>
#endif

int fail(const sightline::Status& status) {
  return std::fprintf(stderr, "%s\n", status.message()), 2;
}

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
  if (const auto done = world.insert(boxes, handles); !done) return fail(done);

  // Kept from frame to frame, so that nothing is allocated in them.
  sightline::Culler culler;
  sightline::OcclusionBuffer occlusion;
  sightline::CullOptions options;
#ifdef WITH_TBB
  options.jobs = sightline::tbb_jobs();
#endif
  std::vector<std::uint32_t> ids(sightline::cull_capacity(world, options));

  const auto moved = std::span(boxes).first(boxes.size() / 10);
  for (int frame = 0; frame < 3; ++frame) {
    for (sightline::WorldBox& box : moved) box.min.y += 0.1, box.max.y += 0.1;
    const auto which = std::span(handles).first(moved.size());
    if (const auto done = world.move(which, moved); !done) return fail(done);

    const auto view = sightline::make_view({.eye = {0, 1.7f, 10}}, 1280, 720);
    if (!view) return fail(view.error());
    const sightline::WorldView camera{*view, {}};

    // Near, solid things hide what is behind them. Here the front row is solid.
    if (const auto done = occlusion.begin(camera); !done) return fail(done);
    if (const auto done = occlusion.draw_boxes(moved.first(2000)); !done) return fail(done);

    const sightline::CullView seen{.view = camera, .occlusion = &occlusion};
    const auto drawn = culler.cull(world, {&seen, 1}, options, {ids, {}});
    if (!drawn) return fail(drawn.error());
    std::printf("frame %d: draw %zu of %zu boxes; occlusion alone dropped %llu\n", frame, drawn->count,
                world.size(), static_cast<unsigned long long>(drawn->culled_occlusion));
  }
}
