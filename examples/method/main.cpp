// A published method at work, out of the workbench: a scene, a method made for it, and a frame a view.
#include <cstdio>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

int main() {
  // Your own objects go into a Scene by add_mesh and add_object; this one is generated.
  const sightline::Result<sightline::Scene> forest = sightline::generate_world("forest");
  if (!forest) return std::fprintf(stderr, "%s\n", forest.failure().message.c_str()), 2;

  const auto method = sightline::create_method("object-frustum", *forest);
  if (!method) return std::fprintf(stderr, "%s\n", method.failure().message.c_str()), 2;

  const auto view = sightline::make_view({.eye = {0, 8.9f, 0}, .forward = {0, 0, -1}}, 1280, 720);
  if (!view) return std::fprintf(stderr, "%s\n", view.failure().message.c_str()), 2;

  sightline::Frame frame;  // keep it: it is reused without allocating
  sightline::cull(**method, *view, frame);
  std::printf("draw %zu of %zu trees in %zu calls; %llu were tested one by one\n", frame.visible.size(),
              forest->size(), frame.draws.size(), static_cast<unsigned long long>(frame.stats.tested));
}
