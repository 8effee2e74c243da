#include <sightline/workbench/scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <sightline/workbench/worlds.hpp>

namespace sightline {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene triangle() {
  Scene scene;
  const Vec3 positions[]{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const Vec3 normals[]{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const std::uint32_t indices[]{0, 1, 2};
  scene.name = "triangle";
  scene.add_object(scene.add_mesh(positions, normals, indices), {});
  return scene;
}

TEST(Scene, BoundsFollowTheTransform) {
  Scene scene = triangle();
  EXPECT_EQ(scene.bounds[0], (Box{{0, 0, 0}, {1, 2, 0}}));
  scene.move_object(0, {{Vec4{0, -1, 0, 10}, Vec4{1, 0, 0, 20}, Vec4{0, 0, 1, 30}}});
  EXPECT_EQ(scene.bounds[0], (Box{{8, 20, 30}, {10, 21, 30}}));
  EXPECT_NEAR(scene.radius[0], std::sqrt(1.25f), 1e-5);
  EXPECT_EQ(extent(scene), scene.bounds[0]);
}

TEST(Scene, TheSphereHoldsEveryVertex) {
  const Scene scene = *generate_world("irregular?spheres=200");
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Sphere sphere = scene.sphere(object);
    for (const Vec3& vertex : scene.positions) {
      const Vec3 p = transform_point(scene.transform[object], vertex);
      ASSERT_LE(std::hypot(p.x - sphere.centre.x, p.y - sphere.centre.y, p.z - sphere.centre.z),
                sphere.radius * 1.0001f);
    }
  }
}

TEST(Scene, AGoodOneIsAccepted) {
  EXPECT_FALSE(check(triangle()));
}

TEST(Scene, RefusesBadBounds) {
  for (const Box& bad :
       {Box{{kNaN, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, kInfinity, 1}}, Box{{0, 0, 2}, {1, 1, 1}}}) {
    Scene scene = triangle();
    scene.bounds.set(0, bad);
    ASSERT_TRUE(check(scene));
    EXPECT_NE(check(scene)->message.find("object 0"), std::string::npos);
  }
}

TEST(Scene, RefusesWhatDoesNotFitTogether) {
  EXPECT_TRUE(check(Scene{}));
  const auto spoilt = [](auto&& spoil) {
    Scene scene = triangle();
    spoil(scene);
    return check(scene).has_value();
  };
  EXPECT_TRUE(spoilt([](Scene& s) { s.radius.clear(); }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.surface.clear(); }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.bounds.max_z.clear(); }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.radius[0] = -1; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.radius[0] = kNaN; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.mesh[0] = 1; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.normals.clear(); }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.indices[1] = 3; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.meshes[0].index_count = 0xffffffff; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.meshes[0].first_vertex = 0xffffffff; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.meshes[0].index_count = 2; }));
  EXPECT_TRUE(spoilt([](Scene& s) { s.meshes[0].vertex_count = 0; }));
}

}  // namespace
}  // namespace sightline
