// Camera paths, path files, ways through a level, and files on a full disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/full_disk.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "workbench/camera/camera_path.hpp"
#include "workbench/camera/navigation_graph.hpp"
#include "workbench/camera/path_file.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/scene/level_space.hpp"

namespace sightline::camera {
namespace {

using test::FullDisk;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  try {
    parse_path("views.json", text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

// Neither as deep as a stack is not, nor a member at a time among all others.
TEST(PathFile, RefusesWhatIsDeepOrHasManyMembers) {
  const std::string deep = nested(500'000);
  EXPECT_THAT(refusal_of(R"({"views": )" + deep + R"(, "b": 1})"), HasSubstr("\"b\""));
  EXPECT_THAT(refusal_of(R"({"views": [)" + deep + "]}"), HasSubstr("view 0"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": )" + deep + R"(, "up": 1}]})"), HasSubstr("\"eye\""));
  std::string many = R"({"views": [])";
  for (int i = 0; i < 300'000; ++i) many += ",\"" + std::to_string(i) + "\":0";
  EXPECT_THAT(refusal_of(many + "}"), HasSubstr("unknown member"));
}

TEST(PathFile, ComesBackToTheBit) {
  const Scene scene = generate_world("regular?columns=4&rows=4");
  const std::vector<Camera> cameras = random_cameras(scene, 200, 1);
  const TemporaryFolder folder;
  save_path(folder / "path.json", cameras);
  const std::vector<Camera> read = load_path(folder / "path.json");
  ASSERT_EQ(read.size(), cameras.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(or_throw(make_view(read[i], 640, 360)), or_throw(make_view(cameras[i], 640, 360))) << i;
  }
}

TEST(PathFile, OnlyTheEyeIsRequired) {
  const std::vector<Camera> cameras = parse_path("text", R"({"views": [{"eye": [1, 2, 3]}]})");
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(cameras[0].forward, Camera{}.forward);
}

TEST(PathFile, EyesArePointsOfTheWorld) {
  const WorldPoint origin{1e7, 0, -2e7};
  const std::vector<Camera> cameras =
      parse_path("text", R"({"views": [{"eye": [10000000.5, 2, -20000000.25]}]})", origin);
  EXPECT_EQ(cameras[0].eye, (Vec3{0.5f, 2, -0.25f}));
  EXPECT_EQ(camera_json(cameras[0], origin)["eye"].dump(), "[10000000.5,2.0,-20000000.25]");
  const TemporaryFolder folder;
  save_path(folder / "path.json", cameras, origin);
  EXPECT_EQ(load_path(folder / "path.json", origin)[0].eye, cameras[0].eye);
  // And so does a scene's own path, whichever origin its file got.
  const Scene scene = generate_world("regular?columns=4&rows=4&offset=10000000");
  save_path(folder / "path.json", cameras, {1e7, 0, 1e7});
  EXPECT_EQ(make_path(scene, (folder / "path.json").string(), 0).cameras[0].eye, cameras[0].eye);
}

TEST(PathFile, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal_of("{\"views\": ["), HasSubstr("views.json: not JSON from byte"));
  EXPECT_THAT(refusal_of(""), HasSubstr("not JSON"));
  EXPECT_THAT(refusal_of("[1]"), HasSubstr("an array \"views\""));
  EXPECT_THAT(refusal_of(R"({"views": []})"), HasSubstr("0 views, expected 1 to 100000"));
  EXPECT_THAT(refusal_of(R"({"views": [3]})"), HasSubstr("view 0: expected an object"));
  EXPECT_THAT(refusal_of(R"({"views": [{"forward": [0,0,1]}]})"), HasSubstr("view 0: \"eye\""));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,0]}, {"eye": [0,0]}]})"),
              HasSubstr("view 1: \"eye\": expected an array of 3 numbers"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,"up"]}]})"), HasSubstr("expected a number"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,0], "fov": 60}]})"), HasSubstr("unknown member \"fov\""));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,0], "fov_degrees": 180}]})"), HasSubstr("field of view"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,0], "near": -1}]})"), HasSubstr("0 < near < far"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [1e300,0,0]}]})"), HasSubstr("not finite"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [1e999,0,0]}]})"), HasSubstr("out of range"));
  EXPECT_THAT(refusal_of(R"({"views": [{"eye": [0,0,0], "reversed": 1}]})"), HasSubstr("true or false"));
}

TEST(PathFile, RefusesWhatRaysDoNotReach) {
  const auto refusal_with = [](const std::string& members) {
    return refusal_of(R"({"views": [{"eye": [0,0,0]}, {"eye": [1,2,3], )" + members + "}]}");
  };
  EXPECT_EQ(refusal_with(R"("orthographic_height": 1e20)"),
            "views.json: view 1: \"orthographic_height\": expected a number from -1e+13 to 1e+13");
  EXPECT_THAT(refusal_with(R"("near": 1e19, "far": "infinite")"), HasSubstr("view 1: \"near\": expected"));
  EXPECT_THAT(refusal_with(R"("near": 1e30, "far": 1e31)"), HasSubstr("\"near\": expected a number"));
  EXPECT_THAT(refusal_with(R"("near": 1, "far": 1e31)"), HasSubstr("\"far\": expected a number"));
  EXPECT_THAT(refusal_with(R"("shift": [0, -1e20])"), HasSubstr("\"shift\": expected a number from -1e+06"));
  EXPECT_THAT(refusal_with(R"("orthographic_height": 10, "near": -1e30, "far": 1e30)"),
              HasSubstr("\"near\""));
  // Each alone is in range.
  EXPECT_THAT(refusal_with(R"("orthographic_height": 1e13, "shift": [1e6, 0])"), HasSubstr("with its shift"));
  EXPECT_THAT(refusal_with(R"("near": 1e12, "far": 1e13, "fov_degrees": 179.99)"), HasSubstr("\"near\""));
  EXPECT_EQ(refusal_with(R"("near": 1e12, "far": 1e13)"), "accepted");
  EXPECT_EQ(refusal_with(R"("orthographic_height": 1e12, "near": -1e12, "far": 1e12)"), "accepted");
}

TEST(PathFile, RefusesImagesOfNoWidth) {
  const auto refusal_with = [](const std::string& members) {
    return refusal_of(R"({"views": [{"eye": [-14.2, 23.5, -28.5], )" + members + "}]}");
  };
  EXPECT_EQ(refusal_with(R"("forward": [1, -0.0, 0.2], "fov_degrees": 1e-20)"),
            "views.json: view 0: \"fov_degrees\": expected a field of view of at least 0.001 degrees");
  EXPECT_THAT(refusal_with(R"("fov_degrees": -60)"), HasSubstr("\"fov_degrees\": expected"));
  EXPECT_EQ(refusal_with(R"("fov_degrees": 0.001)"), "accepted");
  EXPECT_THAT(refusal_with(R"("orthographic_height": 9e-6)"), HasSubstr("at least 1e-05 m"));
  EXPECT_THAT(refusal_with(R"("orthographic_height": -1)"), HasSubstr("at least 1e-05 m"));
  EXPECT_EQ(refusal_with(R"("orthographic_height": 1e-5)"), "accepted");
  EXPECT_EQ(refusal_with(R"("orthographic_height": 10, "fov_degrees": 0)"), "accepted") << "it is ignored";
  EXPECT_EQ(refusal_with(R"("orthographic_height": 0)"), "accepted");
}

TEST(PathFile, MissingFileAndUnknownNameAreRefused) {
  const Scene scene = generate_world("regular?columns=2&rows=2");
  EXPECT_THROW(load_path("/nowhere/at/all.json"), Error);
  EXPECT_THROW(load_path("/"), Error);
  EXPECT_THROW(make_path(scene, "sideways", 3), Error);
}

TEST(CameraPath, NamedPathsMakeViewsInEveryWorld) {
  for (const char* world : {"regular", "irregular", "forest?trees=500", "soup?triangles=1000"}) {
    const Scene scene = generate_world(world);
    EXPECT_EQ(default_path(scene), "near");
    for (const char* name : {"near", "far", "rising", "walk"}) {
      for (const std::size_t frames : {1, 2, 17}) {
        const CameraPath path = make_path(scene, name, frames);
        ASSERT_EQ(path.cameras.size(), frames);
        for (const Camera& camera : path.cameras) EXPECT_TRUE(make_view(camera, 320, 180)) << world << name;
      }
    }
    EXPECT_EQ(make_path(scene, "rising", 9).cameras.front().eye, make_path(scene, "near", 1).cameras[0].eye);
    EXPECT_EQ(make_path(scene, "rising", 9).cameras.back().eye, make_path(scene, "far", 1).cameras[0].eye);
  }
}

TEST(CameraPath, StandsWhereTheSceneSays) {
  const Scene scene = generate_world("regular?columns=4&rows=4");
  for (const Viewpoint& viewpoint : scene.viewpoints) {
    const Camera camera = make_path(scene, viewpoint.name, 1).cameras[0];
    EXPECT_EQ(camera.eye, viewpoint.eye);
    EXPECT_EQ(camera.forward, viewpoint.forward);
  }
}

/// Two rooms, x < -1 and x > 1, joined by a door 0 < z < 2 through the wall between; all else is open.
Scene walled_scene() {
  Scene scene;
  const std::vector<Vec3> corners{{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20}};
  const std::vector<Vec3> normals(4, Vec3{0, 1, 0});
  const std::vector<std::uint32_t> indices{0, 2, 1, 0, 3, 2};
  scene.add_object(scene.add_mesh(corners, normals, indices), {});
  LevelPvs level;
  level.nodes = {
      {{{1, 0, 0}, 1}, 1, -1}, {{{1, 0, 0}, -1}, -2, 2}, {{{0, 0, 1}, 0}, 3, -3}, {{{0, 0, 1}, -2}, -4, -5}};
  const auto leaf = [](std::int32_t cluster, Vec3 low, Vec3 high) {
    return LevelPvs::Leaf{cluster, {low, high}, 0, 0};
  };
  level.leaves = {leaf(0, {-20, 0, -20}, {-1, 3, 20}), leaf(1, {1, 0, -20}, {20, 3, 20}),
                  leaf(-1, {-1, 0, -20}, {1, 3, 0}), leaf(-1, {-1, 0, 2}, {1, 3, 20}),
                  leaf(2, {-1, 0, 0}, {1, 3, 2})};
  level.clusters = 3;
  level.in_some_leaf = {0}, level.in_world_model = {1};
  scene.level = level;
  scene.viewpoints = {{"spawn", {-10, 1.5f, -10}, {1, 0, 0}}, {"spawn", {10, 1.5f, -10}, {1, 0, 0}}};
  return scene;
}

TEST(LevelSpace, MeasuresSolidAlongASegment) {
  const Scene scene = walled_scene();
  const LevelPvs& level = *scene.level;
  EXPECT_DOUBLE_EQ(scene::solid_length(level, {-5, 1, 1}, {5, 1, 1}), 0);
  EXPECT_NEAR(scene::solid_length(level, {-5, 1, -5}, {5, 1, -5}), 2, 1e-6);
  EXPECT_NEAR(scene::solid_length(level, {5, 1, 5}, {-5, 1, 5}), 2, 1e-6);
  EXPECT_NEAR(scene::solid_length(level, {0, 1, -4}, {0, 1, 6}), 8, 1e-6);
  EXPECT_EQ(scene::solid_length(level, {0, 1, 1}, {0, 1, 1}), 0);
  EXPECT_EQ(scene::open_leaves(level), (std::vector<std::uint32_t>{0, 1, 4}));
}

TEST(CameraPath, WalkGoesThroughTheDoor) {
  const Scene scene = walled_scene();
  EXPECT_EQ(default_path(scene), "walk");
  EXPECT_FALSE(is_clear(*scene.level, scene.viewpoints[0].eye, scene.viewpoints[1].eye));
  const CameraPath path = make_path(scene, "walk", 50);
  for (const Camera& camera : path.cameras) {
    EXPECT_TRUE(scene::is_open(*scene.level, camera.eye)) << camera.eye.x << " " << camera.eye.z;
    EXPECT_TRUE(make_view(camera, 64, 64));
  }
  EXPECT_EQ(path.cameras.front().eye, scene.viewpoints[0].eye);
  EXPECT_NEAR(path.cameras.back().eye.x, 10, 1e-4);
  EXPECT_NEAR(path.cameras.back().eye.z, -10, 1e-4);
}

// Each place is held against every other, and each stop against every later one: a file has room for a
// hundred thousand. One in four is kept here, all of them in the first room.
TEST(CameraPath, PlacesOfAWalkAreBounded) {
  Scene scene = walled_scene();
  scene.viewpoints.clear();
  for (std::size_t i = 0; i < 3 * kMaxStops; ++i) {
    const float z = -19 + 0.01f * static_cast<float>(i);
    scene.viewpoints.push_back({"spawn", {i % 4 == 0 ? -10.0f : 10.0f, 1.5f, z}, {1, 0, 0}});
    scene.waypoints.push_back(scene.viewpoints.back().eye);
  }
  EXPECT_EQ(NavigationGraph(scene).places(), 2 * 750 + scene::open_leaves(*scene.level).size());
  const CameraPath path = make_path(scene, "walk", 50);
  for (const Camera& camera : path.cameras) EXPECT_LT(camera.eye.x, 0);
  EXPECT_EQ(path.cameras.front().eye, scene.viewpoints[0].eye);
  EXPECT_NEAR(path.cameras.back().eye.z, scene.viewpoints[2996].eye.z, 1e-3);
}

TEST(CameraPath, EyesOutOfReachAreRefusedByName) {
  Scene scene = walled_scene();
  scene.name = "far.glb";
  scene.viewpoints = {{"camera_1", {2e11f, 0, 0}, {1, 0, 0}}};
  EXPECT_THAT(test::refusal([&] { return make_path(scene, "near", 5); }),
              testing::StartsWith("scene 'far.glb': path 'near': view 0: "));
}

TEST(CameraPath, LevelWithoutAnythingButARoomStands) {
  Scene scene = walled_scene();
  scene.viewpoints.clear();
  EXPECT_EQ(make_path(scene, "walk", 5).cameras.size(), 5u);
}

TEST(File, FullDiskIsAnErrorAndLeavesWhatWas) {
  const TemporaryFolder folder;
  io::write_file(folder / "old.json", "what was");
  {
    const FullDisk full(1000);
    EXPECT_THROW(io::write_file(folder / "old.json", std::string(100'000, 'x')), Error);
    EXPECT_THROW(io::write_file(folder / "new.json", std::string(100'000, 'x')), Error);
  }
  EXPECT_EQ(io::read_file(folder / "old.json", 100), "what was");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(File, DevicesAreWrittenToAndNeverReplaced) {
  EXPECT_THROW(io::write_file("/dev/full", "text"), Error);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_NO_THROW(io::write_file("/dev/null", "text"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(File, IsWrittenWhereALinkLeads) {
  const TemporaryFolder folder;
  io::write_file(folder / "file", "before");
  std::filesystem::create_symlink("file", folder / "link");
  std::filesystem::create_symlink(folder / "none yet", folder / "early");
  std::filesystem::create_symlink("round", folder / "round");
  io::write_file(folder / "link", "after");
  io::write_file(folder / "early", "late");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(io::read_file(folder / "file", 100), "after");
  EXPECT_EQ(io::read_file(folder / "none yet", 100), "late");
  EXPECT_THROW(io::write_file(folder / "round", "text"), Error);
  EXPECT_THROW(io::read_file(folder / "round", 100), Error);
  EXPECT_EQ(folder.files(), 5u);
}

// As `--json /dev/stdout > file` has it: behind what was written there before.
TEST(File, OpenFilesAreWrittenOnTo) {
  const TemporaryFolder folder;
  std::FILE* const open = std::fopen((folder / "file").c_str(), "w");
  ASSERT_NE(open, nullptr);
  std::fputs("first ", open);
  std::fflush(open);
  io::write_file("/dev/fd/" + std::to_string(fileno(open)), "second ");
  std::fputs("third", open);
  std::fclose(open);
  EXPECT_EQ(io::read_file(folder / "file", 100), "first second third");
  EXPECT_THROW(io::write_file("/proc/self/fd/987654", "text"), Error);
}

TEST(File, FolderAndMissingFolderAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(io::write_file(folder.path(), "text"), Error);
  EXPECT_THROW(io::write_file(folder / "none/file", "text"), Error);
  EXPECT_THROW(io::read_file(folder / "file", 100), Error);
  io::write_file(folder / "file", "long text");
  EXPECT_THROW(io::read_file(folder / "file", 4), Error);
}

}  // namespace
}  // namespace sightline::camera
