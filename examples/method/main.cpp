// A published method at work, out of the workbench: a scene, a method made for it, and a frame a view. The
// workbench throws what it refuses.
#include <cstdio>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

int main() try {
  // Your own objects go into a Scene by add_mesh and add_object; this one is generated.
  const sightline::Scene forest = sightline::generate_world("forest");
  const auto method = sightline::create_method("object-frustum", forest);
  const sightline::View view =
      sightline::or_throw(sightline::make_view({.eye = {0, 8.9f, 0}, .forward = {0, 0, -1}}, 1280, 720));

  sightline::Frame frame;  // keep it: it is reused without allocating
  sightline::cull(*method, view, frame);
  std::printf("draw %zu of %zu trees in %zu calls; %llu were tested one by one\n", frame.visible.size(),
              forest.size(), frame.draws.size(), static_cast<unsigned long long>(frame.stats.tested));
} catch (const sightline::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
