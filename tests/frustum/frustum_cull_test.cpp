#include <sightline/culling.hpp>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "support/random_views.hpp"

namespace sightline {
namespace {

struct World {
  Boxes boxes;
  std::vector<float> x, y, z, radius;
};

World random_world(scene::Random& random, std::size_t count) {
  World world;
  for (std::size_t i = 0; i < count; ++i) {
    world.boxes.push_back(test::random_box(random, test::kAround));
    const Vec3 at = random.inside(test::kAround);
    world.x.push_back(at.x), world.y.push_back(at.y), world.z.push_back(at.z);
    world.radius.push_back(random.between(0, 20));
  }
  return world;
}

SphereSpan spheres_of(const World& w) {
  return {w.x.data(), w.y.data(), w.z.data(), w.radius.data(), w.x.size()};
}

std::vector<ObjectId> boxes_in(const Frustum& frustum, const World& world) {
  std::vector<ObjectId> out(world.boxes.size() + kCullPadding);
  out.resize(cull_boxes(frustum, span_of(world.boxes), out));
  return out;
}

std::vector<ObjectId> spheres_in(const Frustum& frustum, const World& world) {
  std::vector<ObjectId> out(world.x.size() + kCullPadding);
  out.resize(cull_spheres(frustum, spheres_of(world), out));
  return out;
}

TEST(FrustumCull, EqualsTestingOneByOneForEverySimdTarget) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    scene::Random random(1);
    for (const std::size_t count : {0u, 1u, 7u, 16u, 33u, 1000u, 4099u}) {
      const World world = random_world(random, count);
      for (int v = 0; v < 30; ++v) {
        const Frustum frustum =
            make_frustum(test::random_view(random, test::kAround), {{-600, -600, -600}, {600, 600, 600}});
        std::vector<ObjectId> expected_boxes, expected_spheres;
        for (ObjectId i = 0; i < count; ++i) {
          if (overlaps(frustum, world.boxes[i])) expected_boxes.push_back(i);
          if (overlaps(frustum, Sphere{{world.x[i], world.y[i], world.z[i]}, world.radius[i]}))
            expected_spheres.push_back(i);
        }
        ASSERT_EQ(boxes_in(frustum, world), expected_boxes) << hwy::TargetName(target);
        ASSERT_EQ(spheres_in(frustum, world), expected_spheres) << hwy::TargetName(target);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace sightline
