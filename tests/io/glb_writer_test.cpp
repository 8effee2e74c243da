// What is written and read again is the same scene; what cannot be written leaves nothing behind.
#include <cmath>
#include <csignal>
#include <fstream>

#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "support/cards.hpp"
#include "workbench/io/gltf_transform.hpp"

namespace sightline {
namespace {

using namespace samples;
using testing::HasSubstr;

void expect_near(const Vec3& a, const Vec3& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

void expect_same(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(triangle_count(a), triangle_count(b));
  for (ObjectId o = 0; o < a.size(); ++o) {
    ASSERT_EQ(a.triangles(o), b.triangles(o)) << o;
    const Box x = a.bounds[o], y = b.bounds[o];
    expect_near(x.min, y.min, 1e-4f);
    expect_near(x.max, y.max, 1e-4f);
    if (testing::Test::HasFailure()) FAIL() << "object " << o;
  }
  ASSERT_EQ(a.viewpoints.size(), b.viewpoints.size());
  for (std::size_t i = 0; i < a.viewpoints.size(); ++i) {
    EXPECT_EQ(a.viewpoints[i].name, b.viewpoints[i].name);
    expect_near(a.viewpoints[i].eye, b.viewpoints[i].eye, 0);
  }
}

TEST(GlbWriter, WorldsComeBackTheSame) {
  const TemporaryFolder folder;
  for (const char* world : {"world:regular", "world:irregular", "world:forest?trees=500", "world:soup"}) {
    SCOPED_TRACE(world);
    const Scene scene = load_scene(world);
    const std::string path = (folder / "world.glb").string();
    write_glb(scene, path);
    const Scene again = load_scene(path);
    expect_same(scene, again);
    EXPECT_EQ(again.meshes.size(), scene.meshes.size());
    // Vertices that no triangle uses are not read back.
    EXPECT_LE(again.positions.size(), scene.positions.size());
    EXPECT_EQ(again.indices.size(), scene.indices.size());
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "no temporary file stays";
}

TEST(GlbWriter, MaterialsComeBackToTheBit) {
  const TemporaryFolder folder;
  std::vector<Scene> scenes = test::card_scenes();
  scenes.push_back(load_scene("world:foliage?plants=50&hedges=20&grates=20&boxes=40"));
  scenes.push_back(load_scene("world:city?objects=1000"));
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    write_glb(scene, folder / "scene.glb");
    const Scene again = load_scene((folder / "scene.glb").string());
    expect_same(scene, again);
    EXPECT_EQ(again.material_sides, scene.material_sides);
    EXPECT_EQ(again.sides, scene.sides);
    EXPECT_EQ(again.alpha_image, scene.alpha_image);
    EXPECT_EQ(again.alpha_cutoff, scene.alpha_cutoff);
    EXPECT_EQ(again.alpha_images, scene.alpha_images);
    EXPECT_EQ(again.positions, scene.positions);
    EXPECT_EQ(again.normals, scene.normals);
    EXPECT_EQ(again.indices, scene.indices);
    for (ObjectId o = 0; o < scene.size(); ++o) {
      EXPECT_EQ(again.transform[o], scene.transform[o]) << o;
      if (scene.alpha_image[o] == kNoAlphaImage) continue;
      const Mesh& mesh = scene.meshes[scene.mesh[o]];
      for (std::uint32_t v = mesh.first_vertex; v < mesh.first_vertex + mesh.vertex_count; ++v)
        EXPECT_EQ(again.texture_coordinates[v], scene.texture_coordinates[v]) << v;
    }
  }
}

// What says nothing of it is of metal, by the format's default, and black where there is nothing to reflect.
TEST(GlbWriter, NoMaterialIsOfMetal) {
  const TemporaryFolder folder;
  for (const Scene& scene : {load_scene("world:forest?trees=2"), test::card_scenes().front()}) {
    write_glb(scene, folder / "scene.glb");
    std::ifstream file(folder / "scene.glb", std::ios::binary);
    std::uint32_t head[5];  // the file's three, and the length and the kind of the first chunk
    ASSERT_TRUE(file.read(reinterpret_cast<char*>(head), sizeof head));
    std::string text(head[3], ' ');
    ASSERT_TRUE(file.read(text.data(), head[3]));
    const nlohmann::json document = nlohmann::json::parse(text);
    ASSERT_FALSE(document["materials"].empty());
    for (const auto& material : document["materials"])
      EXPECT_EQ(material["pbrMetallicRoughness"].value("metallicFactor", 1.0), 0.0) << material;
  }
}

TEST(GlbWriter, FarWorldsComeBackToTheBit) {
  const TemporaryFolder folder;
  const Scene scene = load_scene("world:forest?trees=200&offset=10000000"),
              near = load_scene("world:forest?trees=200");
  EXPECT_EQ(scene.origin, (WorldPoint{1e7, 0, 1e7}));
  write_glb(scene, folder / "far.glb");
  const Scene again = load_scene((folder / "far.glb").string());
  EXPECT_EQ(again.origin, scene.origin);
  expect_same(near, again);
  EXPECT_EQ(again.transform, near.transform);
  EXPECT_NE(fingerprint(scene), fingerprint(near));
}

TEST(GlbWriter, LevelComesBackButForWhatHasNoTriangle) {
  const TemporaryFolder folder;
  const Scene level = read_bsp(to_bsp(two_rooms()), "two rooms");
  write_glb(level, folder / "level.glb");
  const Scene again = load_scene((folder / "level.glb").string());
  EXPECT_EQ(again.size(), level.size() - 1);
  EXPECT_EQ(triangle_count(again), triangle_count(level));
  ASSERT_EQ(again.viewpoints.size(), level.viewpoints.size());
  for (std::size_t i = 0; i < again.viewpoints.size(); ++i) {
    expect_near(again.viewpoints[i].forward, level.viewpoints[i].forward, 1e-6f);
  }
}

TEST(GlbWriter, AnyAffineTransformSurvives) {
  const TemporaryFolder folder;
  Scene scene = load_scene("world:forest?trees=2");
  const std::uint32_t mesh = scene.mesh[0];
  scene.add_object(mesh, {{Vec4{1, 0.5f, 0, 1}, Vec4{0, 1, 0, 2}, Vec4{0, 0, 1, 3}}});  // shear
  scene.add_object(mesh, {{Vec4{-1, 0, 0, 1}, Vec4{0, 1, 0, 2}, Vec4{0, 0, 1, 3}}});    // mirror
  scene.add_object(mesh, {{Vec4{2, 0, 0, 1}, Vec4{0, 3, 0, 2}, Vec4{0, 0, 4, 3}}});     // uneven scale
  scene.add_object(mesh, {{Vec4{1, 0, 0, 1}, Vec4{0, 0, 0, 2}, Vec4{0, 0, 1, 3}}});     // flat
  scene.add_object(mesh, {{Vec4{0, -1, 0, 1}, Vec4{-1, 0, 0, 2}, Vec4{0, 0, -1, 3}}}, Surface::transparent);
  scene.add_object(mesh, {{Vec4{-1, 0, 0, 1}, Vec4{0, -1, 0, 2}, Vec4{0, 0, 1, 3}}}, Surface::transparent);
  write_glb(scene, folder / "scene.glb");
  expect_same(scene, load_scene((folder / "scene.glb").string()));
}

TEST(GlbWriter, DecompositionKnowsWhatItCannotHold) {
  using namespace io::gltf;
  Parts parts;
  EXPECT_FALSE(decompose({{Vec4{1, 0.5f, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}}}, parts));
  EXPECT_FALSE(decompose({{Vec4{0, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}}}, parts));
  EXPECT_TRUE(decompose({{Vec4{0, -2, 0, 5}, Vec4{2, 0, 0, 6}, Vec4{0, 0, 2, 7}}}, parts));
  EXPECT_NEAR(parts.scale[0], 2, 1e-12);
  EXPECT_NEAR(parts.rotation[2], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(parts.translation, (std::array<double, 3>{5, 6, 7}));
}

TEST(GlbWriter, NamesThatAreNotUtf8DoNotStopIt) {
  const TemporaryFolder folder;
  Scene scene = load_scene("world:forest?trees=2");
  scene.viewpoints.push_back({"\xff\xfe", {0, 0, 0}, {0, 1, 0}});
  write_glb(scene, folder / "scene.glb");
  EXPECT_EQ(load_scene((folder / "scene.glb").string()).viewpoints.size(), scene.viewpoints.size());
}

TEST(GlbWriter, FullDeviceIsAnError) {
  const Scene scene = load_scene("world:forest?trees=2");
  EXPECT_THAT(error_of([&] { write_glb(scene, "/dev/full"); }),
              HasSubstr("/dev/full: cannot be written: No space"));
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

/// A disk that fills up half way, by way of the limit on a file's size.
TEST(GlbWriter, HalfWrittenFileIsRemovedAndTheOldOneStays) {
  const TemporaryFolder folder;
  const Scene small = load_scene("world:forest?trees=2"), large = load_scene("world:regular");
  const std::filesystem::path path = folder / "scene.glb";
  write_glb(small, path);
  const auto size = std::filesystem::file_size(path);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit limit = before;
  limit.rlim_cur = size;
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const std::string said = error_of([&] { write_glb(large, path); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(said, HasSubstr("scene.glb: cannot be written"));
  EXPECT_EQ(std::filesystem::file_size(path), size);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(GlbWriter, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  const Scene scene = load_scene("world:forest?trees=2");
  EXPECT_THAT(error_of([&] { write_glb(scene, folder.path()); }), HasSubstr("is a folder"));
  EXPECT_THAT(error_of([&] { write_glb(scene, folder / "no/such/folder.glb"); }), HasSubstr("No such file"));
  EXPECT_THAT(error_of([&] { write_glb(Scene{}, folder / "empty.glb"); }), HasSubstr("no object"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace sightline
