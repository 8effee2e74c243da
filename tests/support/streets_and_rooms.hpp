// Where occlusion pays: streets between blocks, and a level of rooms whose walls are one mesh.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/world.hpp>

#include "support/solid_boxes.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::test {

// Along which somebody looks who looks a little down.
inline Vec3 heading(float angle) {
  return {std::sin(angle), -0.02f, -std::cos(angle)};
}

// Blocks along streets, and things that stand between them.
inline std::vector<Box> town(std::uint32_t seed, int blocks) {
  scene::Random random(seed);
  std::vector<Box> out;
  for (int x = 0; x < blocks; ++x) {
    for (int z = 0; z < blocks; ++z) {
      const Vec3 at{40.0f * static_cast<float>(x), 10, 40.0f * static_cast<float>(z)};
      out.push_back(box_at(at, {14, random.between(8, 20), 14}));
      for (int i = 0; i < 30; ++i)
        out.push_back(box_at({at.x + 20 + random.between(-3, 3), 1, at.z + random.between(-20, 20)},
                             {0.5f, 0.5f, 0.5f}));
    }
  }
  return out;
}

// Rooms of ten metres, each with a door in every wall.
inline std::vector<Box> walls_of(int rooms) {
  std::vector<Box> out;
  for (int x = 0; x <= rooms; ++x) {
    for (int z = 0; z <= rooms; ++z) {
      const float at_x = 10.0f * static_cast<float>(x), at_z = 10.0f * static_cast<float>(z);
      // Left and right of the door along either axis; the door's place differs from room to room.
      const float door = 1 + static_cast<float>((7 * x + 3 * z) % 7);
      if (x < rooms) {
        out.push_back({{at_x, 0, at_z - 0.1f}, {at_x + door, 4, at_z + 0.1f}});
        out.push_back({{at_x + door + 1, 0, at_z - 0.1f}, {at_x + 10, 4, at_z + 0.1f}});
      }
      if (z < rooms) {
        out.push_back({{at_x - 0.1f, 0, at_z}, {at_x + 0.1f, 4, at_z + door}});
        out.push_back({{at_x - 0.1f, 0, at_z + door + 1}, {at_x + 0.1f, 4, at_z + 10}});
      }
    }
  }
  return out;
}

inline Occluder mesh_of(const std::vector<Box>& boxes) {
  constexpr std::array<std::uint32_t, 36> kCorners{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                                   2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  Occluder out;
  for (const Box& b : boxes) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (std::uint32_t i = 0; i < 8; ++i)
      out.positions.push_back(
          {i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z});
    for (const std::uint32_t corner : kCorners) out.indices.push_back(first + corner);
  }
  out.sides = {Sides::front};
  return out;
}

// Things in the rooms, and one object whose occluder all of the walls are.
struct Level {
  static constexpr int kRooms = 16;
  Level() : walls(walls_of(kRooms)) {
    scene::Random random(4);
    const float size = 10.0f * kRooms;
    while (things.size() < 3000) {
      const Box thing = box_at({random.between(0, size), random.between(0.2f, 3), random.between(0, size)},
                               {0.15f, 0.15f, 0.15f});
      things.push_back(thing);
    }
    std::vector<Box> all = things;
    all.push_back({{-1, 0, -1}, {size + 1, 4, size + 1}});
    handles.resize(all.size());
    EXPECT_TRUE(world.insert(BoxView(all), handles));
    const Occluder mesh = mesh_of(walls);
    EXPECT_GT(mesh.indices.size() / 3, 12000u);
    const auto name = world.add_occluder(mesh);
    EXPECT_TRUE(name);
    const OccluderPlacement placement{*name};
    EXPECT_TRUE(world.set_occluders(std::span(handles).last(1), {&placement, 1}));
  }
  [[nodiscard]] static View from(scene::Random& random, std::uint32_t width = 160,
                                 std::uint32_t height = 90) {
    const float x = 10.0f * static_cast<float>(random.below(kRooms)) + random.between(1, 9),
                z = 10.0f * static_cast<float>(random.below(kRooms)) + random.between(1, 9);
    const float angle = random.between(0, 6.28f);
    return looking({x, 1.7f, z}, {std::sin(angle), 0, -std::cos(angle)}, width, height);
  }

  std::vector<Box> walls, things;
  std::vector<Handle> handles;
  World world;
};

}  // namespace sightline::test
