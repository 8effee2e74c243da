// The cases that break occlusion culling, each a small world of its own.
#include <cmath>

#include "raster_occlusion/examine.hpp"
#include "support/refusal.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline {
namespace {

using EdgeCases = DeviceTest;

std::uint32_t add_cube(Scene& scene) {
  std::vector<Vec3> corners, normals;
  for (int i = 0; i < 8; ++i) {
    const Vec3 at{i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f};
    corners.push_back(at);
    const float unit = 1 / std::sqrt(3.0f);
    normals.push_back({at.x * unit, at.y * unit, at.z * unit});
  }
  const std::vector<std::uint32_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                                           1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7};
  return scene.add_mesh(corners, normals, indices);
}

std::uint32_t add_sphere(Scene& scene) {
  const scene::Shape shape = scene::sphere(2);
  return scene.add_mesh(shape.positions, shape.normals, shape.indices);
}

Affine at(float x, float y, float z, float sx = 1, float sy = 1, float sz = 1) {
  Affine out;
  out.rows = {Vec4{sx, 0, 0, x}, Vec4{0, sy, 0, y}, Vec4{0, 0, sz, z}};
  return out;
}

TEST_F(EdgeCases, CameraInsideABoxAndBoxesAcrossTheNearPlane) {
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  scene.add_object(cube, at(0, 0, 0, 20, 20, 20));               // holds the eye and everything else
  scene.add_object(cube, at(0.3f, 0, -0.6f, 0.5f, 0.5f, 0.5f));  // across the near plane
  scene.add_object(cube, at(0, 0, -5));
  scene.add_object(cube, at(0, -1.5f, 0, 20, 0.001f, 20));  // a floor below the eye
  scene.add_object(cube, at(0, 0, -10, 3, 3, 0.1f));
  Examination examination(device(), scene, kOcclusionMethods);
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    for (int step = 0; step < 6; ++step) {
      Camera camera;
      camera.near_plane = 0.3f;
      camera.depth = depth;
      camera.forward = {std::sin(1.0f * step), 0.1f * step - 0.3f, -std::cos(1.0f * step)};
      examination.look(view_of(camera), "in step " + std::to_string(step));
    }
  }
}

TEST_F(EdgeCases, BoxesAtTheNearPlaneOfAWideWorld) {
  // The wider the world, the farther the frustum's planes are pushed outwards, half a metre for ±1,000 km;
  // what the true near plane cuts has no face left to test.
  for (const float reach : {1e3f, 1e4f, 1e5f, 1e6f, 1e7f}) {
    for (const float behind : {0.6f * 4.8e-7f * reach, 0.101f}) {  // the plane; the second holds the eye
      Scene scene;
      const std::uint32_t cube = add_cube(scene), sphere = add_sphere(scene);
      scene.add_object(cube, at(0, 0, -1.1f + behind));
      scene.add_object(cube, at(0, -50, 0, reach, 0.01f, reach));
      scene.add_object(cube, at(0, 0, -30));
      scene.add_object(sphere, at(0, 0, -1.1f + behind));
      scene.add_object(cube, at(0.01f, 0, -1.1f + behind, 0.05f, 0.05f, 0.05f));  // within the sphere
      std::vector<std::string> methods = kOcclusionMethods;
      methods.emplace_back("masked");
      Examination examination(device(), scene, methods);
      const std::string where = "at the near plane of a world of " + std::to_string(reach) + " m";
      for (int frame = 0; frame < 2; ++frame) examination.look(view_of({}, 160, 120), where);
    }
  }
}

// A wall of small cubes, each dropped as the camera goes back, before one that is not. The other methods draw
// last frame's visible objects into the picture.
TEST_F(EdgeCases, WhatIsDroppedByAreaHidesNothingFromThatFrameOn) {
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  for (int i = 0; i < 144; ++i) scene.add_object(cube, at(i % 12 - 5.5f, i / 12 - 5.5f, 0, 0.5f, 0.5f, 0.5f));
  scene.add_object(cube, at(0, 0, -8, 3, 3, 3));
  const std::string by_area = "contribution=area&threshold=300";
  std::vector<std::string> methods;
  for (const char* name : {"roc?", "hroc?", "ioc?", "ihzb?", "vertex-chunk?"})
    methods.push_back(name + by_area);
  Examination examination(device(), scene, methods, "vfc-vc?" + by_area);
  std::vector<std::uint64_t> kept;
  for (const float z : {10.0f, 10.0f, 20.0f, 20.0f, 10.0f}) {
    Camera camera;
    camera.eye = {0, 0, z};
    const std::uint64_t before = examination.kept();
    examination.look(view_of(camera, 320, 180), "from " + std::to_string(z) + " m");
    kept.push_back((examination.kept() - before) / methods.size());
  }
  EXPECT_THAT(kept, testing::ElementsAre(144u, 144u, 1u, 1u, testing::Ge(144u)));
}

TEST_F(EdgeCases, EverythingBehindTheCamera) {
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  for (int i = 0; i < 40; ++i) scene.add_object(cube, at(static_cast<float>(3 * i), 0, 10));
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 3; ++frame) examination.look(view_of({}), "with all behind");
  EXPECT_EQ(examination.visible(), 0u);
  EXPECT_EQ(examination.kept(), 0u);
}

TEST_F(EdgeCases, OneObject) {
  Scene scene;
  scene.add_object(add_cube(scene), at(0, 0, -5));
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 3; ++frame) examination.look(view_of({}), "with one object");
  EXPECT_EQ(examination.visible(), 3u);
}

TEST_F(EdgeCases, NoObjectIsRefusedBeforeItReachesADevice) {
  EXPECT_THAT(test::refusal([] { check(Scene{}); }), testing::HasSubstr("object"));
}

TEST_F(EdgeCases, OnlyTransparentObjects) {
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  for (int i = 0; i < 9; ++i)
    scene.add_object(cube, at(static_cast<float>(i) - 4, 0, -6.0f - i), Surface::transparent);
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 2; ++frame) examination.look(view_of({}), "with glass alone");
}

TEST_F(EdgeCases, EqualDepthsHaveOneWinnerWhateverIsDrawnFirst) {
  // Pairs of equal cubes in different colours at the same place: which shows is the order of drawing's to
  // say.
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  for (int i = 0; i < 60; ++i) {
    scene.add_object(
        cube, at(static_cast<float>(2 * (i % 10)) - 9, static_cast<float>(i / 20) - 1, -12.0f - i % 3));
  }
  for (int i = 59; i >= 0; --i) {
    scene.add_object(
        cube, at(static_cast<float>(2 * (i % 10)) - 9, static_cast<float>(i / 20) - 1, -12.0f - i % 3));
  }
  Examination examination(device(), scene, kOcclusionMethods);
  for (int step = 0; step < 12; ++step) {
    Camera camera;
    camera.forward = {std::sin(0.25f * step - 1.2f), 0, -std::cos(0.25f * step - 1.2f)};
    examination.look(view_of(camera), "in step " + std::to_string(step));
  }
}

TEST_F(EdgeCases, EqualDepthsHaveOneWinnerThoughOneComesLate) {
  // The first cube comes from behind the eye to where the second stands: drawn late, and yet before it.
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  scene.add_object(cube, at(0, 0, 9));
  scene.add_object(cube, at(0, 0, -8));
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 3; ++frame) examination.look(view_of({}), "before it comes");
  examination.move_to(0, at(0, 0, -8));
  for (int frame = 0; frame < 3; ++frame) examination.look(view_of({}), "since it has come");
}

TEST_F(EdgeCases, AWideBoxThatComesOutFromBehindAWall) {
  // What shows first is a strip at one end of the box, in other tiles of depth than the rest of it.
  for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
    Scene scene;
    const std::uint32_t cube = add_cube(scene);
    scene.add_object(cube, at(-10 * side.x, -10 * side.y, -5, side.x ? 10 : 20, side.y ? 10 : 20, 0.1f));
    scene.add_object(cube, at(-3 * side.x, -3 * side.y, -20, 2.5f, 2.5f, 0.1f));
    Examination examination(device(), scene, kOcclusionMethods);
    for (int step = 0; step < 15; ++step) {
      Camera camera;
      camera.eye = {0.02f * step * side.x, 0.02f * step * side.y, 0};
      examination.look(view_of(camera, 320, 240), "in step " + std::to_string(step));
    }
    EXPECT_GT(examination.visible(), 15u + 2);  // the box shows in some frames,
    EXPECT_LT(examination.visible(), 30u - 2);  // and in others does not
  }
}

TEST_F(EdgeCases, FlatObjectsInTheirOwnBoxes) {
  // Walls without thickness along the axes: box and mesh are the same rectangle, rounded differently.
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  const std::vector<Vec3> normals(4, Vec3{0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3};
  const std::uint32_t quad = scene.add_mesh(corners, normals, indices);
  scene::Random random(4);
  for (int i = 0; i < 400; ++i) {
    const Vec3 place{random.between(-20, 20), random.between(-3, 3), random.between(-40, -1)};
    Affine transform = at(place.x, place.y, place.z);
    const float size = random.between(0.005f, 1.5f);
    const float x = transform.rows[0].w, y = transform.rows[1].w, z = transform.rows[2].w;
    if (i % 3 == 0) transform.rows = {Vec4{size, 0, 0, x}, Vec4{0, size, 0, y}, Vec4{0, 0, 1, z}};
    if (i % 3 == 1) transform.rows = {Vec4{0, 0, 1, x}, Vec4{0, size, 0, y}, Vec4{size, 0, 0, z}};
    if (i % 3 == 2) transform.rows = {Vec4{size, 0, 0, x}, Vec4{0, 0, 1, y}, Vec4{0, size, 0, z}};
    scene.add_object(quad, transform);
  }
  Examination examination(device(), scene, kOcclusionMethods);
  for (int step = 0; step < 10; ++step) {
    Camera camera;
    camera.eye.x = 0.37f * step;
    camera.forward.x = 0.11f * step - 0.5f;
    examination.look(view_of(camera), "in step " + std::to_string(step));
  }
}

TEST_F(EdgeCases, FlatObjectsFarFromTheOriginAndANearPlaneCloseToTheEye) {
  // Rounding of clip coordinates grows with the distance from the origin; behind a close near plane it is
  // many units of depth's last place.
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  const std::uint32_t quad = scene.add_mesh(corners, std::vector<Vec3>(4, Vec3{0, 0, 1}),
                                            std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3});
  scene::Random random(5);
  for (int i = 0; i < 3000; ++i) {
    Affine transform;
    const float size = random.between(0.1f, 0.6f);
    const float x = 900 + random.between(-20, 20), y = 300 + random.between(-10, 10);
    transform.rows = {Vec4{size, 0, 0, x}, Vec4{0, size, 0, y}, Vec4{0, 0, 1, random.between(-840, -800)}};
    scene.add_object(quad, transform);
  }
  Examination examination(device(), scene, kOcclusionMethods);
  for (int step = 0; step < 8; ++step) {
    Camera camera;
    camera.eye = {900 + 2.3f * step, 300, -780};
    camera.forward = {0.1f * step - 0.3f, 0.07f * step - 0.2f, -1};
    camera.near_plane = 0.01f;
    for (int frame = 0; frame < 2; ++frame) {
      examination.look(view_of(camera, 160, 120), "in step " + std::to_string(step));
    }
  }
}

TEST_F(EdgeCases, DispatchesWiderThanADeviceAllows) {
  device::DeviceOptions options;
  options.validation = true;
  options.widest_dispatch = 3;
  device::Device narrow(options);
  Scene scene = generate_world("irregular?detail=0");
  {
    Examination examination(narrow, scene, kOcclusionMethods);
    scene::Random random(6);
    for (int frame = 0; frame < 4; ++frame) {
      Camera camera = camera_at(scene, frame < 2 ? "near" : "far");
      camera.eye.x += 0.5f * frame;
      examination.look(view_of(camera, 161, 93), "in frame " + std::to_string(frame));
      examination.move(0.05, random);
    }
  }
  EXPECT_EQ(narrow.messages(), 0u) << narrow.first_message();
}

TEST_F(EdgeCases, AWindowOfOnePixelAndOneOf4096By4096) {
  Scene scene;
  const std::uint32_t cube = add_cube(scene);
  for (int i = 0; i < 50; ++i)
    scene.add_object(cube, at(static_cast<float>(i % 7) * 3 - 9, 0, -4.0f - 2 * i));
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 2; ++frame) examination.look(view_of({}, 1, 1), "in one pixel");
  examination.look(view_of({}, 4096, 4096), "in 4096 x 4096");
  EXPECT_GT(examination.visible(), 0u);
}

TEST_F(EdgeCases, AMillionObjects) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<Vec3> normals(3, Vec3{0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2};
  const std::uint32_t triangle = scene.add_mesh(corners, normals, indices);
  scene.bounds.reserve(1000000);
  for (int i = 0; i < 1000000; ++i) {
    scene.add_object(triangle,
                     at(static_cast<float>(i % 1000) * 3 - 1500, 0, -static_cast<float>(i / 1000) * 3 - 4));
  }
  Examination examination(device(), scene, kOcclusionMethods);
  Camera camera;
  camera.eye.y = 2;
  examination.look(view_of(camera, 160, 90), "of a million objects");
  EXPECT_GT(examination.visible(), 0u);
}

}  // namespace
}  // namespace sightline
