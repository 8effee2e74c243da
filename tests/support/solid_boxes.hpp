// Worlds of solid boxes that all hide what is behind them, and culls that find out by themselves.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <utility>
#include <vector>

#include <sightline/world.hpp>

#include "support/cull.hpp"

namespace sightline::test {

inline Box box_at(const Vec3& at, const Vec3& half) {
  return {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}};
}

// The unit box, and where it fills another.
inline const Occluder kUnitBox{.positions = {},
                               .indices = {},
                               .sides = {},
                               .solid_triangles = 0,
                               .boxes = {{{0, 0, 0}, {1, 1, 1}}},
                               .yield = OccluderYield::whole};
inline OccluderPlacement filling(const Box& box, OccluderId occluder) {
  OccluderPlacement out{occluder};
  auto& m = out.transform.m;
  m[0] = box.max.x - box.min.x, m[5] = box.max.y - box.min.y, m[10] = box.max.z - box.min.z;
  m[12] = box.min.x, m[13] = box.min.y, m[14] = box.min.z;
  return out;
}

// Solid boxes, all of which carry themselves.
struct SolidBoxes {
  explicit SolidBoxes(std::vector<Box> given) : boxes(std::move(given)), handles(boxes.size()) {
    EXPECT_TRUE(world.insert(BoxView(boxes), handles));
    const auto occluder = world.add_occluder(kUnitBox);
    EXPECT_TRUE(occluder);
    std::vector<OccluderPlacement> placements;
    for (const Box& box : boxes) placements.push_back(filling(box, *occluder));
    EXPECT_TRUE(world.set_occluders(handles, placements));
    unit = *occluder;
  }

  std::vector<Box> boxes;
  std::vector<Handle> handles;
  World world;
  OccluderId unit = kNoOccluder;
};

inline View looking(const Vec3& eye, const Vec3& forward, std::uint32_t width = 160,
                    std::uint32_t height = 120) {
  return *make_view(Camera{.eye = eye, .forward = forward, .near_plane = 0.05f, .far_plane = 3000}, width,
                    height);
}
struct Culled {
  CullResult result;
  std::vector<ObjectId> ids;
  std::vector<std::uint8_t> masks;
};

inline Culled cull_with(Culler& culler, const World& world, std::span<const CullView> views,
                        const CullOptions& options, bool masks = false) {
  Culled out;
  out.ids.resize(cull_capacity(world, options));
  if (masks) out.masks.resize(out.ids.size());
  out.result = cull(culler, world, views, out.ids, out.masks, options);
  out.ids.resize(out.result.count);
  if (masks) out.masks.resize(out.result.count);
  return out;
}

inline constexpr CullOptions kAutomatic{.occlusion = Occlusion::automatic};

inline CullOptions automatic(float object) {
  CullOptions out = kAutomatic;
  out.costs.object = object;
  return out;
}

}  // namespace sightline::test
