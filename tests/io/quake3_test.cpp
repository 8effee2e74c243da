// Levels made in memory: what each kind of face becomes, and what a broken level is refused for.
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "workbench/io/quake3_patch.hpp"

namespace sightline {
namespace {

using namespace samples;
using io::quake3::Surfel;
using testing::HasSubstr;
using testing::StartsWith;

constexpr float kUnit = 0.0254f;

Scene read(const Level& level) {
  return read_bsp(to_bsp(level), "sample.bsp");
}
std::string refusal(const Level& level) {
  return error_of([&] { read(level); });
}
std::string refusal_of_bsp(const Blob& bytes) {
  return error_of([&] { read_bsp(bytes, "sample.bsp"); });
}

TEST(Quake3, ObjectsAreTheFacesInOrder) {
  const Scene scene = read(two_rooms());
  ASSERT_EQ(scene.size(), 6u);
  EXPECT_NO_THROW(check(scene));
  const std::vector<std::uint64_t> triangles{2, 72, 1, 8, 0, 1};
  for (ObjectId o = 0; o < scene.size(); ++o) {
    EXPECT_EQ(scene.mesh[o], o);
    EXPECT_EQ(scene.triangles(o), triangles[o]) << o;
  }
}

TEST(Quake3, UnitsBecomeMetresAndZBecomesUp) {
  const Box wall = read(two_rooms()).bounds[0];
  EXPECT_EQ(wall, (Box{{128 * kUnit, 0, -64 * kUnit}, {128 * kUnit, 64 * kUnit, 64 * kUnit}}));
}

TEST(Quake3, TrianglesAreWoundAgainstTheClockSeenFromTheirNormals) {
  const Scene scene = read(two_rooms());
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const Mesh& mesh = scene.meshes[o];
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      const auto at = [&](std::uint32_t k) {
        return mesh.first_vertex + scene.indices[mesh.first_index + i + k];
      };
      const Vec3 a = scene.positions[at(0)], b = scene.positions[at(1)], c = scene.positions[at(2)];
      const Vec3 n = scene.normals[at(0)];
      const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
      const float turn =
          n.x * (u.y * v.z - u.z * v.y) + n.y * (u.z * v.x - u.x * v.z) + n.z * (u.x * v.y - u.y * v.x);
      EXPECT_GT(turn, 0) << "object " << o << " triangle " << i / 3;
    }
  }
}

TEST(Quake3, TranslucentFacesAndFlaresAreTransparent) {
  const Scene scene = read(two_rooms());
  const std::vector<Surface> expected{Surface::opaque,      Surface::opaque, Surface::transparent,
                                      Surface::transparent, Surface::opaque, Surface::opaque};
  EXPECT_EQ(scene.surface, expected);
}

TEST(Quake3, FlareIsAMarkerAtItsOrigin) {
  const Sphere sphere = read(two_rooms()).sphere(3);
  EXPECT_NEAR(sphere.centre.x, 100 * kUnit, 1e-5);
  EXPECT_NEAR(sphere.centre.y, 25 * kUnit, 1e-5);
  EXPECT_NEAR(sphere.centre.z, -50 * kUnit, 1e-5);
  EXPECT_NEAR(sphere.radius, 0.1, 1e-5);
}

TEST(Quake3, TreeAndVisibilityComeAlong) {
  const Scene scene = read(two_rooms());
  ASSERT_TRUE(scene.level);
  const LevelPvs& level = *scene.level;
  EXPECT_EQ(level.leaf_at({1, 0, 0}), 0u);
  EXPECT_EQ(level.leaf_at({-1, 0, 0}), 1u);
  EXPECT_FALSE(level.may_see(0, 1));
  EXPECT_TRUE(level.may_see(1, 0));
  EXPECT_EQ(level.in_some_leaf, (std::vector<std::uint8_t>{1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(level.in_world_model, (std::vector<std::uint8_t>{1, 1, 1, 1, 1, 0}));
  std::vector<std::uint8_t> mask(scene.size());
  level.potentially_visible({1, 0, 0}, mask);
  EXPECT_EQ(mask, (std::vector<std::uint8_t>{1, 0, 0, 1, 1, 1}));
  level.potentially_visible({-1, 0, 0}, mask);
  EXPECT_EQ(mask, std::vector<std::uint8_t>(6, 1));
  EXPECT_EQ(level.leaves[0].bounds,
            (Box{{0, -128 * kUnit, -128 * kUnit}, {128 * kUnit, 128 * kUnit, 128 * kUnit}}));
}

TEST(Quake3, MovingPartsStandWhereTheirEntityIsAndAreAlwaysPotentiallyVisible) {
  const Scene scene = read(two_rooms());
  EXPECT_FLOAT_EQ(scene.bounds[5].max.z, -100 * kUnit);
  EXPECT_EQ(scene.level->in_some_leaf[5], 0);
  EXPECT_EQ(scene.level->leaves[2].object_count, 0u) << "no view is ever in the leaf of a moving part";
  // Nor does it matter which cluster the file gives that leaf.
  Level level = two_rooms();
  level.leaves[2].cluster = 1;
  const Scene other = read(level);
  std::vector<std::uint8_t> mask(other.size());
  other.level->potentially_visible({1, 0, 0}, mask);
  EXPECT_EQ(mask[5], 1);
}

TEST(Quake3, WithoutVisibilityAllSeeAll) {
  Level level = two_rooms();
  level.visibility.clear();
  const Scene scene = read(level);
  EXPECT_EQ(scene.level->clusters, 2u);
  EXPECT_TRUE(scene.level->may_see(0, 1));
}

TEST(Quake3, SpawnPointsAreViewpointsAndItemsWaypoints) {
  const Scene scene = read(two_rooms());
  ASSERT_EQ(scene.viewpoints.size(), 2u);
  EXPECT_EQ(scene.viewpoints[0].name, "info_player_deathmatch_1");
  EXPECT_NEAR(scene.viewpoints[0].eye.y, 50 * kUnit, 1e-5);
  EXPECT_NEAR(scene.viewpoints[0].forward.z, -1, 1e-6);
  EXPECT_NEAR(scene.viewpoints[1].forward.x, -1, 1e-6);
  EXPECT_EQ(scene.waypoints.size(), 3u);
}

TEST(Quake3, TheFarPlaneIsKept) {
  Level level = two_rooms();
  EXPECT_TRUE(std::isinf(read(level).level->far_plane));
  const auto far_of = [&](const std::string& value) {
    level.entities =
        "{ \"classname\" \"light\" \"_farplanedist\" \"1\" }\n"
        "{ \"classname\" \"worldspawn\" \"_farplanedist\" \"" +
        value + "\" }";
    return read(level).level->far_plane;
  };
  EXPECT_FLOAT_EQ(far_of("2048"), 2048 * kUnit);
  for (const char* none : {"0", "-5", "far", "nan", ""}) EXPECT_TRUE(std::isinf(far_of(none))) << none;
}

TEST(Quake3, PlacesInSolidAreLeftOut) {
  Level level = two_rooms();
  level.leaves[1].cluster = -1;
  EXPECT_EQ(read(level).viewpoints.size(), 1u);
}

TEST(Quake3, PatchBordersAreTheSameBitsFromBothEnds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-100, 100);
  for (const std::uint32_t level : {1u, 3u, 6u, 10u}) {
    std::vector<Surfel> a(9), b(9);
    for (Surfel& s : a) s.position = {coordinate(random), coordinate(random), coordinate(random)};
    for (Surfel& s : b) s.position = {coordinate(random), coordinate(random), coordinate(random)};
    // The last row of a, turned round, is the first column of b.
    for (std::size_t k = 0; k < 3; ++k) b[3 * k] = a[8 - k];
    const auto grid_a = io::quake3::tessellate(a, 3, 3, level),
               grid_b = io::quake3::tessellate(b, 3, 3, level);
    const std::size_t side = level + 1;
    for (std::size_t i = 0; i < side; ++i) {
      EXPECT_EQ(grid_a.vertices[side * side - 1 - i].position, grid_b.vertices[i * side].position);
    }
  }
}

TEST(Quake3, PatchPassesThroughItsCornersAndMiddle) {
  std::vector<Surfel> control(15);
  for (std::size_t i = 0; i < 15; ++i) {
    control[i].position = {static_cast<float>(i % 5), i % 2 == 1 ? 1.0f : 0.0f, static_cast<float>(i / 5)};
  }
  const auto grid = io::quake3::tessellate(control, 5, 3, 4);
  ASSERT_EQ(grid.vertices.size(), 9u * 5u);
  EXPECT_EQ(grid.indices.size(), 8u * 4u * 6u);
  EXPECT_EQ(grid.vertices[0].position, control[0].position);
  EXPECT_EQ(grid.vertices[4].position, control[2].position);
  EXPECT_EQ(grid.vertices.back().position, control[14].position);
  // The middle of the first border curve: ends and control point weigh 1/4, 1/2, 1/4.
  EXPECT_EQ(grid.vertices[2].position, (Vec3{1, 0.5f, 0}));
}

TEST(Quake3Hostile, EveryTruncationIsRefused) {
  const Blob whole = to_bsp(two_rooms());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string said =
        refusal_of_bsp({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_THAT(said, StartsWith("sample.bsp: ")) << size;
  }
}

TEST(Quake3Hostile, WrongMagicAndVersion) {
  Blob bytes = to_bsp(two_rooms());
  bytes[4] = std::byte{47};
  EXPECT_THAT(refusal_of_bsp(bytes), HasSubstr("version 47, expected 46"));
  bytes[0] = std::byte{'V'};
  EXPECT_THAT(refusal_of_bsp(bytes), HasSubstr("'IBSP'"));
  EXPECT_THAT(refusal_of_bsp({}), HasSubstr("0 bytes long"));
}

TEST(Quake3Hostile, ReferencesOutOfRange) {
  constexpr std::int32_t kHuge = std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t bad : {-1, 1000, kHuge, -kHuge - 1}) {
    const std::vector<std::pair<const char*, std::function<void(Level&)>>> breaks{
        {"face 0", [&](Level& l) { l.faces[0].shader = bad; }},
        {"face 0", [&](Level& l) { l.faces[0].first_vertex = bad; }},
        {"face 0", [&](Level& l) { l.faces[0].vertex_count = bad; }},
        {"face 0", [&](Level& l) { l.faces[0].first_mesh_vertex = bad; }},
        {"face 0", [&](Level& l) { l.faces[0].mesh_vertex_count = bad; }},
        {"face 0", [&](Level& l) { l.mesh_vertices[1] = bad; }},
        {"face 0", [&](Level& l) { l.faces[0].type = bad; }},
        {"face 1", [&](Level& l) { l.faces[1].patch_width = bad; }},
        {"face 1", [&](Level& l) { l.faces[1].patch_height = bad; }},
        {"node 0", [&](Level& l) { l.nodes[0].plane = bad; }},
        {"leaf 0", [&](Level& l) { l.leaves[0].first_face = bad; }},
        {"leaf 0", [&](Level& l) { l.leaves[0].face_count = bad; }},
        {"leaf face 2", [&](Level& l) { l.leaf_faces[2] = bad; }},
        {"model 0", [&](Level& l) { l.models[0].first_face = bad; }},
        {"model 0", [&](Level& l) { l.models[0].face_count = bad; }},
        {"model 1", [&](Level& l) { l.models[1].first_face = bad; }},
        {"model 1", [&](Level& l) { l.models[1].face_count = bad; }},
    };
    for (std::size_t i = 0; i < breaks.size(); ++i) {
      Level level = two_rooms();
      breaks[i].second(level);
      EXPECT_THAT(refusal(level), HasSubstr(breaks[i].first)) << "break " << i << ", value " << bad;
    }
  }
}

TEST(Quake3Hostile, TreeWithACircleOrAHoleIsRefused) {
  for (const std::int32_t child : {0, 1, 7, -4, std::numeric_limits<std::int32_t>::min()}) {
    Level level = two_rooms();
    level.nodes[0].back = child;
    EXPECT_THAT(refusal(level), HasSubstr("node 0")) << child;
  }
}

TEST(Quake3Hostile, ClustersBeyondTheVisibility) {
  Level level = two_rooms();
  level.leaves[0].cluster = 1'000'000'000;
  EXPECT_THAT(refusal(level), HasSubstr("leaf 0 has cluster 1000000000"));
  level = two_rooms();
  level.visibility = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_THAT(refusal(level), HasSubstr("visibility for 1 clusters"));
  level = two_rooms();
  level.visibility.resize(4);
  EXPECT_THAT(refusal(level), HasSubstr("visibility lump of 4 bytes"));
  for (const std::size_t byte : {0u, 4u}) {
    level = two_rooms();
    for (std::size_t i = 0; i < 4; ++i) level.visibility[byte + i] = 0xff;
    EXPECT_THAT(refusal(level), HasSubstr("visibility lump of 10 bytes"));
  }
}

TEST(Quake3Hostile, NumbersThatAreNone) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Level level = two_rooms();
    level.vertices[14].position[1] = bad;
    EXPECT_THAT(refusal(level), HasSubstr("face 2 has vertex 1"));
    level = two_rooms();
    level.planes[0].normal[0] = bad;
    EXPECT_THAT(refusal(level), HasSubstr("node 0 has a plane"));
    level = two_rooms();
    level.vertices[0].normal[0] = bad;
    EXPECT_EQ(refusal(level), "");
    level = two_rooms();
    level.faces[3].light_map_origin[2] = bad;
    EXPECT_EQ(refusal(level), "");
  }
  Level level = two_rooms();
  level.vertices[0].position[0] = -std::numeric_limits<float>::max();
  level.vertices[1].position[0] = std::numeric_limits<float>::max();
  EXPECT_THAT(refusal(level), HasSubstr("object 0"));
}

TEST(Quake3Hostile, FacesThatAllClaimTheSameVerticesAreRefused) {
  Level level = two_rooms();
  level.faces.assign(5000, level.faces[1]);
  EXPECT_THAT(refusal(level), HasSubstr("no more than a level of its size needs"));
}

TEST(Quake3Hostile, LeavesThatAllClaimTheSameFacesAreRefused) {
  Level level = two_rooms();
  level.leaves.assign(1000, level.leaves[0]);
  EXPECT_THAT(refusal(level), HasSubstr("that other leaves claim too"));
}

TEST(Quake3Hostile, BrokenEntities) {
  for (const char* text : {"{", "{ \"a\" ", "{ \"a\" \"b\"", "{ \"a\" }", "\"a\"", "x", "{ \"a", "}"}) {
    Level level = two_rooms();
    level.entities = text;
    EXPECT_THAT(refusal(level), HasSubstr("entities")) << text;
  }
  Level level = two_rooms();
  level.entities = "{ \"classname\" \"info_player_start\" \"origin\" \"1e30 1e38 nan\" }";
  EXPECT_EQ(refusal(level), "");
}

TEST(Quake3Hostile, NoFaceOrNoLeafOrNoModel) {
  Level level = two_rooms();
  level.faces.clear();
  EXPECT_NE(refusal(level), "");
  level = two_rooms();
  level.leaves.clear();
  EXPECT_NE(refusal(level), "");
  level = two_rooms();
  level.models.clear();
  EXPECT_THAT(refusal(level), HasSubstr("models"));
  level = two_rooms();
  level.nodes.clear();
  EXPECT_EQ(refusal(level), "") << "a level of one leaf needs no node";
}

TEST(Quake3Hostile, AnyByteMayBeAnything) {
  const Blob whole = to_bsp(two_rooms());
  std::mt19937 random(11);
  for (int round = 0; round < 20'000; ++round) {
    Blob bytes = whole;
    for (int change = 0; change < 1 + round % 4; ++change)
      bytes[random() % bytes.size()] = std::byte(random() & 0xff);
    const std::string said = refusal_of_bsp(bytes);  // either a scene or a sentence
    if (!said.empty()) {
      ASSERT_THAT(said, HasSubstr("sample.bsp"));
    }
  }
  for (int round = 0; round < 1000; ++round) {
    Blob bytes(random() % 4096);
    for (std::byte& b : bytes) b = std::byte(random() & 0xff);
    ASSERT_NE(refusal_of_bsp(bytes), "");
  }
}

TEST(Quake3, PatchLevelIsBounded) {
  for (const std::uint32_t level : {0u, 33u, ~0u}) {
    EXPECT_THAT(error_of([&] { read_bsp(to_bsp(two_rooms()), "sample.bsp", {level}); }),
                HasSubstr("patch level"));
  }
}

}  // namespace
}  // namespace sightline
