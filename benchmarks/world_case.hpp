// The boxes and views that Sightline and its peers are measured on.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/world.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::benchmarks {

inline constexpr float kReach = 1000;

// Random boxes about the origin; beyond a million, the rest stands around them, out of all views.
struct Case {
  Boxes flat;
  World world;
  std::vector<Handle> handles;
};

inline Case& case_of(std::size_t count) {
  static std::map<std::size_t, std::unique_ptr<Case>> made;
  std::unique_ptr<Case>& slot = made[count];
  if (slot) return *slot;
  slot = std::make_unique<Case>();
  scene::Random random(1);
  while (slot->flat.size() < count) {
    Vec3 at = random.inside({{-kReach, -50, -kReach}, {kReach, 50, kReach}});
    // Behind the eye.
    if (slot->flat.size() >= 1'000'000) at.z = kReach + 8 * random.between(0, kReach);
    const Vec3 half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
    const Box box{{at.x - half.x, at.y - half.y, at.z - half.z},
                  {at.x + half.x, at.y + half.y, at.z + half.z}};
    slot->flat.push_back(box);
  }
  slot->handles.resize(count);
  or_throw(slot->world.insert(slot->flat.view(), slot->handles));
  return *slot;
}

inline View looking(float heading, float fov) {
  Camera camera;
  camera.eye = {0, 5, 0};
  camera.forward = {std::sin(heading), -0.02f, -std::cos(heading)};
  camera.vertical_fov = fov;
  camera.far_plane = 1400;
  return *make_view(camera, 1280, 720);
}

// The field of view that sees a tenth of a million.
inline float tenth_of_view() {
  static const float found = [] {
    const Case& c = case_of(1'000'000);
    std::vector<ObjectId> visible(c.flat.size() + kCullPadding);
    float low = 0.05f, high = 2.5f;
    for (int i = 0; i < 30; ++i) {
      const float middle = 0.5f * (low + high);
      const Frustum frustum = make_frustum(looking(0.3f, middle));
      (*cull_boxes(frustum, c.flat.view(), visible) < c.flat.size() / 10 ? low : high) = middle;
    }
    return high;
  }();
  return found;
}

}  // namespace sightline::benchmarks
