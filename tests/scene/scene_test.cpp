#include <sightline/workbench/scene.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include <sightline/workbench/worlds.hpp>

#include "support/refusal.hpp"

namespace sightline {
namespace {

using testing::HasSubstr;

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
  const Scene scene = generate_world("irregular?spheres=200");
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
  EXPECT_NO_THROW(check(triangle()));
}

TEST(Scene, RefusesBadBounds) {
  for (const Box& bad :
       {Box{{kNaN, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, kInfinity, 1}}, Box{{0, 0, 2}, {1, 1, 1}},
        Box{{0, 0, 0}, {1, 1, 2e11f}}, Box{{-2e11f, 0, 0}, {1, 1, 1}}}) {
    Scene scene = triangle();
    scene.bounds.set(0, bad);
    EXPECT_THAT(test::refusal([&] { check(scene); }), HasSubstr("object 0"));
  }
}

TEST(Scene, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW(check(Scene{}), Error);
  const auto spoilt = [](auto&& spoil) {
    Scene scene = triangle();
    spoil(scene);
    return !test::refusal([&] { check(scene); }).empty();
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
  EXPECT_TRUE(spoilt([](Scene& s) { s.positions[2].y = kNaN; }));
}

TEST(Scene, RefusesMaterialsThatDoNotFit) {
  const auto refusal_of = [](auto&& spoil) {
    Scene scene = triangle();
    scene.add_alpha_image({2, 1, {0, 255}});
    scene.alpha_image[0] = 0;
    scene.texture_coordinates.resize(3);
    EXPECT_NO_THROW(check(scene));
    spoil(scene);
    return test::refusal([&] { check(scene); });
  };
  for (const auto spoil : {+[](Scene& s) { s.sides.clear(); }, +[](Scene& s) { s.material_sides.clear(); },
                           +[](Scene& s) { s.layers.clear(); }, +[](Scene& s) { s.alpha_image.clear(); },
                           +[](Scene& s) { s.alpha_cutoff.clear(); }}) {
    EXPECT_THAT(refusal_of(spoil), HasSubstr("length"));
  }
  EXPECT_THAT(refusal_of([](Scene& s) { s.alpha_image[0] = 1; }), HasSubstr("alpha image is out of range"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.alpha_images[0].height = 2; }), HasSubstr("alpha image 0"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.alpha_images[0] = {}; }), HasSubstr("alpha image 0"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.surface[0] = Surface{3}; }), HasSubstr("surface"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.sides[0] = Sides{2}; }), HasSubstr("sides"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.texture_coordinates.pop_back(); }),
              HasSubstr("texture coordinate"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.texture_coordinates[2].v = kNaN; }), HasSubstr("not finite"));
  EXPECT_THAT(refusal_of([](Scene& s) { s.origin.y = 1e12; }), HasSubstr("origin"));
}

TEST(Scene, TheRasterStateComesAndGoes) {
  Scene scene = triangle();
  const std::uint64_t before = fingerprint(scene);
  scene.add_object(0, {}, {Surface::opaque, Sides::front});
  using enum Sides;
  EXPECT_EQ(scene.sides, (std::vector{both, front}));
  set_raster_state(scene, RasterState::front_faces);
  EXPECT_EQ(scene.sides, (std::vector{front, front}));
  scene.add_object(0, {}, Surface::transparent);
  EXPECT_EQ(scene.sides, (std::vector{front, front, front}));
  EXPECT_EQ(scene.material(2), Material(Surface::transparent));
  set_raster_state(scene, RasterState::both_sides);
  EXPECT_EQ(scene.sides, (std::vector{both, both, both}));
  set_raster_state(scene, RasterState::materials);
  EXPECT_EQ(scene.sides, (std::vector{both, front, both}));
  EXPECT_EQ(scene.raster_state, RasterState::materials);
  EXPECT_NO_THROW(check(scene));
  // Another state is another scene to what was baked.
  Scene one_sided = triangle();
  EXPECT_EQ(fingerprint(one_sided), before);
  set_raster_state(one_sided, RasterState::front_faces);
  EXPECT_NE(fingerprint(one_sided), before);
}

TEST(Scene, MeshesWithAndWithoutTextureCoordinatesShareTheArray) {
  Scene scene = triangle();
  EXPECT_TRUE(scene.texture_coordinates.empty());
  const std::vector<Vec3> positions(scene.positions), normals(scene.normals);
  const std::uint32_t indices[]{0, 1, 2};
  const TextureCoordinate coordinates[]{{0, 0}, {1, 0}, {0, -2}};
  scene.add_mesh(positions, normals, indices, coordinates);
  scene.add_mesh(positions, normals, indices);
  ASSERT_EQ(scene.texture_coordinates.size(), 9u);
  EXPECT_EQ(scene.texture_coordinates[0], TextureCoordinate{});
  EXPECT_EQ(scene.texture_coordinates[5], (TextureCoordinate{0, -2}));
  EXPECT_EQ(scene.texture_coordinates[8], TextureCoordinate{});
  EXPECT_NO_THROW(check(scene));
  const std::span<const TextureCoordinate> two(coordinates, 2);
  EXPECT_THAT(test::refusal([&] { return scene.add_mesh(positions, normals, indices, two); }),
              HasSubstr("2 texture coordinates for 3 positions"));
}

TEST(Scene, RefusesObjectsAndMeshesThatThereAreNot) {
  Scene scene = triangle();
  EXPECT_THAT(test::refusal([&] { return scene.add_object(1, {}); }), HasSubstr("mesh 1"));
  EXPECT_THAT(test::refusal([&] {
                return scene.add_object(0, {}, {Surface::cut_out, Sides::both, 0});
              }),
              HasSubstr("alpha image 0"));
  EXPECT_THAT(test::refusal([&] { scene.move_object(1, {}); }), HasSubstr("object 1"));
  const Vec3 positions[]{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, normals[]{{0, 0, 1}, {0, 0, 1}};
  const std::uint32_t indices[]{0, 1, 2};
  EXPECT_THAT(test::refusal([&] { return scene.add_mesh(positions, normals, indices); }),
              HasSubstr("2 normals for 3 positions"));
  EXPECT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_NO_THROW(check(scene));
}

TEST(Scene, ComputesTheNormalsThatAMeshLacks) {
  // Two walls of one square metre and of two that share an edge along y, and a point nobody uses.
  const Vec3 positions[]{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 2}, {0, 1, 2}, {9, 9, 9}};
  const std::uint32_t indices[]{0, 2, 1, 1, 2, 3, 0, 1, 4, 4, 1, 5};
  Scene scene;
  scene.name = "corner";
  scene.add_object(scene.add_mesh(positions, {}, indices), {});
  ASSERT_NO_THROW(check(scene));
  EXPECT_EQ(scene.normals[3], (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.normals[5], (Vec3{1, 0, 0}));
  EXPECT_EQ(scene.normals[6], (Vec3{0, 1, 0}));
  // By area: a triangle of half a square metre of the first wall, and one twice as large of the second.
  EXPECT_NEAR(scene.normals[0].x, 1 / std::sqrt(1.25f), 1e-6);
  EXPECT_NEAR(scene.normals[0].z, 0.5f / std::sqrt(1.25f), 1e-6);
  // What is out of range is check()'s to refuse.
  const std::uint32_t astray[]{0, 1, 7};
  EXPECT_NO_THROW(scene.add_mesh(positions, {}, astray));
  EXPECT_THROW(check(scene), Error);
}

}  // namespace
}  // namespace sightline
