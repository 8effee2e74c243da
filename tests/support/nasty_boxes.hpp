// Scenes of boxes that break ray casting: touching, nested, flat, points, twins, around the eye; and rays
// along their faces, edges and through their corners.
#pragma once

#include <cmath>
#include <vector>

#include <sightline/rays.hpp>
#include <sightline/workbench/scene.hpp>

#include "support/random_views.hpp"

namespace sightline::test {

/// Coordinates on a coarse lattice, so that faces coincide.
inline Boxes nasty_boxes(scene::Random& random, std::size_t count) {
  const auto lattice = [&] { return static_cast<float>(random.below(17)) - 8; };
  Boxes boxes;
  while (boxes.size() < count) {
    const Vec3 low{lattice(), lattice(), lattice()};
    const auto side = [&] { return static_cast<float>(random.below(4)); };
    const Box box{low, {low.x + side(), low.y + side(), low.z + side()}};
    switch (random.below(6)) {
      case 0:  // a row of boxes that touch
        for (int i = 0; i < 4; ++i) {
          const float step = (box.max.x - box.min.x) * static_cast<float>(i);
          boxes.push_back(
              {{box.min.x + step, box.min.y, box.min.z}, {box.max.x + step, box.max.y, box.max.z}});
        }
        break;
      case 1:  // boxes in boxes, sharing faces
        for (int i = 0; i < 4; ++i) {
          const float grown = static_cast<float>(i);
          boxes.push_back({box.min, {box.max.x + grown, box.max.y + grown, box.max.z}});
        }
        break;
      case 2:  // twins
        boxes.push_back(box), boxes.push_back(box);
        break;
      case 3:  // around everything
        if (random.below(4) == 0) boxes.push_back({{-20, -20, -20}, {20, 20, 20}});
        break;
      case 4:  // anywhere, of any size
        boxes.push_back(random_box(random, {{-9, -9, -9}, {9, 9, 9}}));
        break;
      default:
        boxes.push_back(box);
    }
  }
  return boxes;
}

/// Rays of lattice points along axes, diagonals and anything else; some through box corners.
inline std::vector<PreparedRay> nasty_rays(scene::Random& random, const Boxes& boxes, std::size_t count) {
  std::vector<PreparedRay> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const auto lattice = [&] { return static_cast<float>(random.below(25)) - 12; };
    Ray ray;
    ray.origin = {lattice(), lattice(), lattice()};
    switch (random.below(4)) {
      case 0: {  // along an axis
        const float sign = random.below(2) ? 1.0f : -1.0f;
        const std::uint32_t axis = random.below(3);
        ray.direction = {axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : -0.0f};
        break;
      }
      case 1:  // in a plane of the lattice
        ray.direction = {lattice(), 0, lattice()};
        break;
      case 2: {  // through a corner
        const Box box = boxes[random.below(static_cast<std::uint32_t>(boxes.size()))];
        ray.direction = {box.min.x - ray.origin.x, box.max.y - ray.origin.y, box.min.z - ray.origin.z};
        break;
      }
      default:
        ray.direction = random.direction();
        if (random.below(3) == 0) ray.max_distance = random.between(0, 20);
    }
    if (ray.direction == Vec3{} || ray.direction == Vec3{-0.0f, -0.0f, -0.0f}) ray.direction = {0, 1, 0};
    rays.emplace_back(ray);
  }
  return rays;
}

}  // namespace sightline::test
