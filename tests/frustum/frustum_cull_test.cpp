#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

SphereView spheres_of(const World& w) {
  return SphereView::arrays(w.x.data(), w.y.data(), w.z.data(), w.radius.data(), w.x.size());
}

std::vector<ObjectId> boxes_in(const Frustum& frustum, const World& world) {
  std::vector<ObjectId> out(world.boxes.size() + kCullPadding);
  out.resize(*cull_boxes(frustum, world.boxes.view(), out));
  return out;
}

std::vector<ObjectId> spheres_in(const Frustum& frustum, const World& world) {
  std::vector<ObjectId> out(world.x.size() + kCullPadding);
  out.resize(*cull_spheres(frustum, spheres_of(world), out));
  return out;
}

TEST(FrustumCull, EqualsTestingOneByOneForEverySimdTarget) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    scene::Random random(1);
    for (const std::size_t count : {0u, 1u, 7u, 16u, 33u, 1000u, 4099u}) {
      const World world = random_world(random, count);
      for (int v = 0; v < 30; ++v) {
        const Frustum frustum = make_frustum(test::random_view(random, test::kAround));
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

// Arrays of somebody else begin with any element of a cache line, each with another.
TEST(FrustumCull, BeginsAnywhereInACacheLine) {
  scene::Random random(5);
  const World world = random_world(random, 300);
  for (std::size_t first = 0; first <= 16; ++first) {
    std::array<std::vector<float>, 6> apart;
    const Boxes::Array* const columns[] = {&world.boxes.min_x, &world.boxes.min_y, &world.boxes.min_z,
                                           &world.boxes.max_x, &world.boxes.max_y, &world.boxes.max_z};
    for (std::size_t k = 0; k < 6; ++k) {
      apart[k].resize(first + k);
      apart[k].insert(apart[k].end(), columns[k]->begin(), columns[k]->end());
    }
    const auto at = [&](std::size_t k) { return apart[k].data() + first + k; };
    const BoxView moved = BoxView::arrays(at(0), at(1), at(2), at(3), at(4), at(5), 300);
    const std::size_t whole = 300 - first;
    const SphereView rest =
        SphereView::arrays(&world.x[first], &world.y[first], &world.z[first], &world.radius[first], whole);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      const Frustum frustum = make_frustum(test::random_view(random, test::kAround));
      std::vector<ObjectId> boxes(300 + kCullPadding), spheres(boxes.size());
      boxes.resize(*cull_boxes(frustum, moved, boxes));
      EXPECT_EQ(boxes, boxes_in(frustum, world)) << first << ' ' << hwy::TargetName(target);
      spheres.resize(*cull_spheres(frustum, rest, spheres));
      std::vector<ObjectId> expected = spheres_in(frustum, world);
      std::erase_if(expected, [&](ObjectId id) { return id < first; });
      for (ObjectId& id : expected) id -= static_cast<ObjectId>(first);
      EXPECT_EQ(spheres, expected) << first << ' ' << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST(FrustumCull, ReadsAnyLayoutAndKeepsWhatIsLargerThanTheView) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    scene::Random random(2);
    World world = random_world(random, 333);
    for (std::size_t i = 0; i < 333; i += 10) {
      const float far = i % 20 ? 1e30f : 1e6f;
      world.boxes.set(i, {{-far, -far, -far}, {far, far, far}});
      world.x[i] = i % 20 ? far : 600;
      world.radius[i] = i % 20 ? far * 1.01f : 1e4f;
    }
    std::vector<Box> structs;
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < 333; ++i) {
      structs.push_back(world.boxes[i]);
      spheres.push_back({{world.x[i], world.y[i], world.z[i]}, world.radius[i]});
    }
    std::vector<ObjectId> out(333 + kCullPadding);
    for (int v = 0; v < 10; ++v) {
      const Frustum frustum = make_frustum(test::random_view(random, test::kAround));
      const std::vector<ObjectId> boxes = boxes_in(frustum, world), round = spheres_in(frustum, world);
      for (ObjectId i = 0; i < 333; i += 10) {
        ASSERT_TRUE(std::ranges::binary_search(boxes, i));
        ASSERT_TRUE(std::ranges::binary_search(round, i));
      }
      ASSERT_LT(boxes.size(), 333u);
      ASSERT_EQ(std::vector(out.begin(), out.begin() + *cull_boxes(frustum, structs, out)), boxes);
      ASSERT_EQ(std::vector(out.begin(), out.begin() + *cull_spheres(frustum, spheres, out)), round);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Nobody promises anything of them, but what one processor keeps the others keep, wherever in the array it
// stands.
TEST(FrustumCull, JudgesWhatIsNoNumberAlikeForEverySimdTarget) {
  scene::Random random(4);
  World world = random_world(random, 777);
  const float odd[] = {std::nanf(""),
                       -std::nanf(""),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::max(),
                       -0.0f};
  for (std::size_t i = 0; i < 777; i += 2) {
    const auto some = [&] { return odd[random.below(6)]; };
    Boxes& b = world.boxes;
    Boxes::Array* const columns[] = {&b.min_x, &b.min_y, &b.min_z, &b.max_x, &b.max_y, &b.max_z};
    for (std::uint32_t n = 1 + random.below(3); n > 0; --n) (*columns[random.below(6)])[i] = some();
    (random.below(2) ? world.x : world.radius)[i] = some();
  }
  for (int v = 0; v < 40; ++v) {
    const Frustum frustum = make_frustum(test::random_view(random, test::kAround));
    std::vector<ObjectId> expected_boxes, expected_spheres;
    for (ObjectId i = 0; i < 777; ++i) {
      if (overlaps(frustum, world.boxes[i])) expected_boxes.push_back(i);
      if (overlaps(frustum, Sphere{{world.x[i], world.y[i], world.z[i]}, world.radius[i]}))
        expected_spheres.push_back(i);
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      ASSERT_EQ(boxes_in(frustum, world), expected_boxes) << hwy::TargetName(target);
      ASSERT_EQ(spheres_in(frustum, world), expected_spheres) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(FrustumCull, RefusesShortOutputsAndUnsoundViews) {
  const Frustum frustum = make_frustum(*make_view(Camera{}, 64, 64));
  scene::Random random(3);
  const World world = random_world(random, 100);
  std::vector<ObjectId> out(100 + kCullPadding);
  const auto boxes = [&](const BoxView& view, std::size_t room) {
    return cull_boxes(frustum, view, std::span(out).first(room)).error().code();
  };
  EXPECT_EQ(boxes(world.boxes.view(), out.size()), StatusCode::ok);
  EXPECT_EQ(boxes(world.boxes.view(), out.size() - 1), StatusCode::buffer_too_small);
  const float* none = nullptr;
  EXPECT_EQ(boxes(BoxView::min_max(none, 24, 3), out.size()), StatusCode::bad_argument);
  EXPECT_EQ(boxes(BoxView::min_max(world.boxes.min_x.data(), 8, 3), out.size()), StatusCode::bad_argument);
  const auto too_many = static_cast<std::size_t>(-1);
  EXPECT_EQ(boxes(BoxView::min_max(world.boxes.min_x.data(), 24, too_many), out.size()),
            StatusCode::bad_argument);
  EXPECT_EQ(cull_spheres(frustum, spheres_of(world), std::span(out).first(100)).error().code(),
            StatusCode::buffer_too_small);
  EXPECT_EQ(cull_spheres(frustum, SphereView(none, none, 16, 1), out).error().code(),
            StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
