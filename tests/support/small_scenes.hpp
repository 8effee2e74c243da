// Views of few pixels into a room, and boxes and spheres in it: small enough to hold every pixel against
// exact rays.
#pragma once

#include <sightline/workbench/scene.hpp>

#include "support/random_views.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::test {

inline constexpr Box kRoom{{-50, -20, -50}, {50, 20, 50}};

inline View small_view(scene::Random& random) {
  for (;;) {
    // One after the other: compilers call a function's arguments in orders of their own.
    const auto camera = random_camera(random, kRoom);
    const std::uint32_t width = 20 + random.below(80), height = 20 + random.below(60);
    const Result<View> view = make_view(camera, width, height);
    if (view) return *view;
  }
}

inline Box box_of(scene::Random& random, float largest) {
  const Vec3 at = random.inside(kRoom),
             half = random.inside({{0.05f, 0.05f, 0.05f}, {largest, largest, largest}});
  return {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}};
}

inline Sphere sphere_of(scene::Random& random, float largest) {
  return {random.inside(kRoom), random.between(0.05f, largest)};
}

}  // namespace sightline::test
