// Random and nasty cameras for property tests: every projection kind, all headings, far from and near the
// origin.
#pragma once

#include <cmath>
#include <limits>

#include <sightline/view.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::test {

inline constexpr Box kAround{{-300, -300, -300}, {300, 300, 300}};

inline Camera random_camera(scene::Random& random, const Box& around) {
  Camera camera;
  camera.eye = random.inside(around);
  camera.forward = random.direction();
  camera.up = std::fabs(camera.forward.y) > 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const float size = around.max.x - around.min.x;
  camera.vertical_fov = random.between(0.05f, 2.6f);
  camera.near_plane = random.between(0.01f, 1);
  camera.far_plane =
      random.below(3) == 0 ? std::numeric_limits<float>::infinity() : random.between(0.1f, 2) * size;
  camera.far_plane = std::fmax(camera.far_plane, 2 * camera.near_plane);
  if (random.below(4) == 0) camera.shift_x = random.between(-1, 1), camera.shift_y = random.between(-1, 1);
  if (random.below(3) == 0) camera.depth = Depth::reversed;
  if (random.below(5) == 0) {
    camera.orthographic_height = random.between(0.05f, 1) * size;
    camera.near_plane = -random.between(0, 0.5f) * size;
    camera.far_plane = random.between(0.1f, 1) * size;
  }
  return camera;
}

inline View random_view(scene::Random& random, const Box& around) {
  const std::uint32_t width = 1 + random.below(1920), height = 1 + random.below(1080);
  const Result<View> view = make_view(random_camera(random, around), width, height);
  return view ? *view : random_view(random, around);
}

/// Boxes of all sizes, some flat, some points, some huge.
inline Box random_box(scene::Random& random, const Box& around) {
  const Vec3 at = random.inside(around);
  const float size = (around.max.x - around.min.x) * std::exp(random.between(-9, -0.5f));
  Vec3 half{size * random.unit(), size * random.unit(), size * random.unit()};
  if (random.below(6) == 0) half.y = 0;
  if (random.below(20) == 0) half = {0, 0, 0};
  return {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}};
}

}  // namespace sightline::test
