// The invariant of paper B on the device: iwcpa, bvha and saa hit what toca hits, to the id and to the bit.
#include "workbench/methods/ray_pvs/device_rays.hpp"

#include <filesystem>

#include <sightline/workbench/io.hpp>

#include <sightline/workbench/method.hpp>
#include "device/fixtures.hpp"
#include "support/nasty_boxes.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"

namespace sightline {
namespace {

using DeviceRaysTest = DeviceTest;

// A scene of bare boxes: one mesh of a cube's corners would round, so bounds are set as they are.
Scene scene_of(const Boxes& boxes) {
  Scene scene;
  scene.name = "boxes";
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals(3, Vec3{0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2};
  scene.add_mesh(corners, normals, indices);
  for (std::size_t i = 0; i < boxes.size(); ++i) scene.add_object(0, {});
  scene.bounds = boxes;
  scene.surface.assign(boxes.size(), Surface::opaque);
  return scene;
}

struct Casters {
  std::vector<std::pair<const char*, std::unique_ptr<methods::DeviceRays>>> all;

  Casters(device::Device& device, const Scene& scene) {
    all.emplace_back("iwcpa", methods::make_iwcpa(device, scene));
    all.emplace_back("tuned-iwcpa", methods::make_tuned_iwcpa(device, scene));
    all.emplace_back("bvha", methods::make_bvha(device, scene));
    all.emplace_back("saa", methods::make_saa(device, scene));
  }
};

// Every object whose box a ray meets before the nearest opaque one, and that one.
std::vector<std::uint32_t> met_by(const Scene& scene, const rays::RayGrid& grid) {
  std::vector<std::uint32_t> met(scene.size(), 0);
  for (const PreparedRay& ray : grid.prepared) {
    float nearest = std::numeric_limits<float>::infinity();
    ObjectId stops = kNoObject;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      const float t = intersect(ray, scene.bounds[o]);
      if (scene.surface[o] == Surface::opaque && t >= 0 && t < nearest) nearest = t, stops = o;
    }
    if (stops != kNoObject) met[stops] = 1;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      const float t = intersect(ray, scene.bounds[o]);
      if (scene.surface[o] != Surface::opaque && t >= 0 && t <= nearest) met[o] = 1;
    }
  }
  return met;
}

std::uint64_t compare(const Scene& scene, Casters& casters, const rays::RayGrid& grid,
                      const std::string& where) {
  rays::RayHits expected, found;
  methods::cast_at_all_boxes(casters.all[0].second->targets().solid(), grid.prepared, expected);
  const std::vector<std::uint32_t> met = met_by(scene, grid);
  for (auto& [name, caster] : casters.all) {
    caster->cast(grid, found);
    for (std::size_t r = 0; r < grid.size(); ++r) {
      EXPECT_EQ(found.object[r], expected.object[r]) << name << ", " << where << ", ray " << r;
      EXPECT_EQ(found.distance[r], expected.distance[r]) << name << ", " << where << ", ray " << r;
      if (testing::Test::HasFailure()) return 0;
    }
    for (ObjectId o = 0; o < scene.size(); ++o)
      EXPECT_EQ(caster->marks().mapped<std::uint32_t>()[o], met[o])
          << name << ", " << where << ", object " << o;
  }
  return expected.stats.hits;
}

rays::RayGrid grid_of(std::vector<PreparedRay> rays) {
  rays::RayGrid grid;
  grid.prepared = std::move(rays);
  grid.rays.resize(grid.prepared.size());
  return grid;
}

TEST_F(DeviceRaysTest, HitWhatTheCpuHitsOnNastyScenes) {
  scene::Random random(31);
  std::uint64_t hits = 0;
  for (int round = 0; round < 200; ++round) {
    Scene scene = scene_of(test::nasty_boxes(random, 1 + random.below(300)));
    // Cut-outs and glass in every other scene, and nothing else in some.
    if (round % 2 != 0) {
      for (std::size_t i = 0; i < scene.size(); i += round % 16 == 1 ? 1 : 3)
        scene.surface[i] = i % 2 == 0 ? Surface::cut_out : Surface::transparent;
    }
    Casters casters(device(), scene);
    const rays::RayGrid grid = grid_of(test::nasty_rays(random, scene.bounds, 500));
    hits += compare(scene, casters, grid, "scene " + std::to_string(round));
    ASSERT_FALSE(HasFailure());
    if (round % 20 > 1) continue;
    for (std::size_t i = 0; i < scene.size(); i += 2) {
      scene.bounds.set(i, test::random_box(random, {{-9, -9, -9}, {9, 9, 9}}));
    }
    for (auto& [name, caster] : casters.all) caster->update();
    compare(scene, casters, grid, "moved scene " + std::to_string(round));
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(hits, 25000u);
}

TEST_F(DeviceRaysTest, HitWhatTheCpuHitsOnTheFiveModelsAndTheIrregularWorld) {
  for (const char* world :
       {"strata?triangles=20000&model=1", "strata?triangles=20000&model=2", "strata?triangles=20000&model=3",
        "strata?triangles=20000&model=4", "strata?triangles=20000&model=5", "irregular?detail=0"}) {
    const Scene scene = generate_world(world);
    Casters casters(device(), scene);
    rays::RayGrid grid;
    Camera camera = camera_at(scene, "far");
    camera.far_plane = 1e5f;
    grid.make(view_of(camera), 50, 50);
    EXPECT_GT(compare(scene, casters, grid, world), 50u);
    ASSERT_FALSE(HasFailure());
  }
}

TEST_F(DeviceRaysTest, HitWhatTheCpuHitsInAGameLevel) {
  if (!std::filesystem::exists("/usr/share/games/openarena/baseoa/pak1-maps.pk3")) {
    GTEST_SKIP() << "openarena-081-maps is not installed";
  }
  const Scene scene = load_scene("pak1-maps.pk3:maps/oa_dm1.bsp");
  Casters casters(device(), scene);
  for (std::size_t i = 0; i < std::min<std::size_t>(4, scene.viewpoints.size()); ++i) {
    rays::RayGrid grid;
    grid.make(view_of({.eye = scene.viewpoints[i].eye, .forward = scene.viewpoints[i].forward}), 100, 100);
    EXPECT_GT(compare(scene, casters, grid, scene.viewpoints[i].name), 5000u);
  }
}

// More boxes than one round of either iwcpa holds.
TEST_F(DeviceRaysTest, RoundsOfManyBoxesLeaveNothingOut) {
  scene::Random random(33);
  Boxes boxes;
  for (int i = 0; i < 14000; ++i) boxes.push_back(test::random_box(random, {{-90, -90, -90}, {90, 90, 90}}));
  const Scene scene = scene_of(boxes);
  Casters casters(device(), scene);
  rays::RayGrid grid;
  grid.make(view_of({.eye = {0, 0, 200}}), 100, 100);
  EXPECT_GT(compare(scene, casters, grid, "many boxes"), 3000u);
}

TEST_F(DeviceRaysTest, MethodsDrawWhatBocaFinds) {
  const Scene scene = generate_world("strata?triangles=40000");
  device::Renderer renderer(device(), scene);
  Camera camera = camera_at(scene, "far");
  camera.far_plane = 1e5f;
  const View view = view_of(camera);
  const auto boca = create_method("boca", scene);
  Frame expected;
  cull(*boca, view, expected);
  std::ranges::sort(expected.visible);
  EXPECT_GT(expected.visible.size(), 50u);
  for (const char* name : {"iwcpa", "tuned-iwcpa", "bvha", "saa"}) {
    const auto method = create_method(name, MethodSite{scene, &renderer});
    Frame frame;
    renderer.frame(view, [&](device::Recorder& recorder) {
      FrameContext context{view, frame, &recorder};
      method->record(context);
    });
    method->read_back(frame);
    EXPECT_EQ(frame.visible, expected.visible) << name;
    EXPECT_EQ(frame.stats.draw_calls, expected.visible.size()) << name;
  }
}

}  // namespace
}  // namespace sightline
