// Levels that nobody here made. Skipped, with a word, where the package openarena-081-maps is absent.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>
#include <zip.h>

#include <sightline/workbench/io.hpp>

#include "workbench/reproduce/draw_calls/draw_call_levels.hpp"

namespace sightline {
namespace {

constexpr const char* kArchive = "/usr/share/games/openarena/baseoa/pak1-maps.pk3";

std::vector<std::string> level_names() {
  std::vector<std::string> names;
  zip_t* archive = zip_open(kArchive, ZIP_RDONLY, nullptr);
  for (zip_int64_t i = 0; archive != nullptr && i < zip_get_num_entries(archive, 0); ++i) {
    const std::string name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    if (name.ends_with(".bsp")) names.push_back(name);
  }
  if (archive != nullptr) zip_discard(archive);
  return names;
}

class OpenArena : public testing::Test {
protected:
  void SetUp() override {
    if (!std::filesystem::exists(kArchive)) GTEST_SKIP() << "install openarena-081-maps for the real levels";
  }
};

TEST_F(OpenArena, AllLevelsLoadWithPlacesInFreeSpace) {
  const std::vector<std::string> names = level_names();
  ASSERT_EQ(names.size(), 50u);
  std::vector<std::pair<std::uint64_t, std::string>> by_triangles;
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene("pak1-maps.pk3:" + name);
    by_triangles.emplace_back(triangle_count(scene), "pak1-maps.pk3:" + name);
    ASSERT_TRUE(scene.level);
    EXPECT_NO_THROW(check(scene));
    EXPECT_GE(scene.viewpoints.size(), 4u);
    EXPECT_GE(scene.waypoints.size(), scene.viewpoints.size() / 2);
    std::vector<std::uint8_t> mask(scene.size());
    for (const Viewpoint& view : scene.viewpoints) {
      const LevelPvs::Leaf& leaf = scene.level->leaves[scene.level->leaf_at(view.eye)];
      EXPECT_GE(leaf.cluster, 0);
      EXPECT_TRUE(scene.level->may_see(leaf.cluster, leaf.cluster)) << view.name;
    }
  }

  // The levels of `reproduce draw-calls` are what their rule makes of all fifty.
  std::erase_if(by_triangles,
                [](const auto& level) { return level.first < reproduce::kLeastLevelTriangles; });
  std::ranges::sort(by_triangles);
  for (std::size_t choice = 0; choice < 3; ++choice) {
    const std::array deciles{1, 5, 9};
    EXPECT_EQ(by_triangles[(by_triangles.size() - 1) * deciles[choice] / 10].second,
              reproduce::kDrawCallLevels[choice].specification);
  }
}

TEST_F(OpenArena, FiguresOfOneLevel) {
  const Scene scene = load_scene("pak1-maps.pk3:maps/oasago2.bsp");
  EXPECT_EQ(scene.size(), 3869u);
  EXPECT_EQ(scene.level->leaves.size(), 5144u);
  EXPECT_EQ(scene.level->clusters, 2280u);
  std::vector<std::uint8_t> mask(scene.size());
  std::size_t fewest = scene.size();
  for (const Viewpoint& view : scene.viewpoints) {
    scene.level->potentially_visible(view.eye, mask);
    fewest = std::min(fewest, static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1)));
  }
  EXPECT_GT(fewest, scene.size() / 20);
  EXPECT_LT(fewest, scene.size() / 2);
}

struct Hit {
  ObjectId object = kNoObject;
  int side = 0;  ///< of the nearest triangle along the ray: its front (1) or its back (-1); 0 for a miss
};

Hit nearest_hit(const Scene& scene, const Vec3& from, const Vec3& along) {
  double nearest = 1e30;
  Hit hit;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const Mesh& mesh = scene.meshes[scene.mesh[o]];
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      const auto at = [&](std::uint32_t k) {
        return scene.positions[mesh.first_vertex + scene.indices[mesh.first_index + i + k]];
      };
      // Möller and Trumbore 1997; the determinant's sign says which side.
      const Vec3 a = at(0), b = at(1), c = at(2);
      const double e1[3]{b.x - a.x, b.y - a.y, b.z - a.z}, e2[3]{c.x - a.x, c.y - a.y, c.z - a.z};
      const double p[3]{along.y * e2[2] - along.z * e2[1], along.z * e2[0] - along.x * e2[2],
                        along.x * e2[1] - along.y * e2[0]};
      const double determinant = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
      if (std::abs(determinant) < 1e-12) continue;
      const double s[3]{from.x - a.x, from.y - a.y, from.z - a.z};
      const double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / determinant;
      const double q[3]{s[1] * e1[2] - s[2] * e1[1], s[2] * e1[0] - s[0] * e1[2],
                        s[0] * e1[1] - s[1] * e1[0]};
      const double v = (along.x * q[0] + along.y * q[1] + along.z * q[2]) / determinant;
      const double t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || t <= 0 || t >= nearest) continue;
      nearest = t;
      hit = {o, determinant > 0 ? 1 : -1};
    }
  }
  return hit;
}

TEST_F(OpenArena, PlayersSeeTheFrontsOfWalls) {
  const Scene scene = load_scene("pak1-maps.pk3:maps/oa_dm1.bsp");
  std::mt19937 random(3);
  std::normal_distribution<float> axis;
  int fronts = 0, backs = 0;
  for (const Viewpoint& view : scene.viewpoints) {
    for (int ray = 0; ray < 40; ++ray) {
      const int side = nearest_hit(scene, view.eye, {axis(random), axis(random), axis(random)}).side;
      fronts += side > 0;
      backs += side < 0;
    }
  }
  EXPECT_GT(fronts, 300);
  // Two-sided surfaces such as banners may show their back.
  EXPECT_LT(backs, fronts / 20);
}

/// Whether it is as large as a tessellated patch, of six segments a quadratic curve.
bool is_patch(const Mesh& mesh) {
  for (std::uint32_t across = 6; across <= 48; across += 6) {
    for (std::uint32_t down = 6; down <= 48; down += 6) {
      if (mesh.vertex_count == (across + 1) * (down + 1) && mesh.index_count == 6 * across * down)
        return true;
    }
  }
  return false;
}

/// The stored normals had no say in how triangles are wound: they are the evidence. A compiler makes them of
/// the winding, but those of some models' parts point inwards.
TEST_F(OpenArena, TrianglesTurnAgainstTheClockSeenFromTheirNormals) {
  std::size_t good = 0, bad = 0, patches = 0, bad_patches = 0;
  for (const char* name : {"oa_dm1", "oasago2", "islandctf", "czest2ctf", "ctf_inyard", "am_galmevish"}) {
    const Scene scene = load_scene("pak1-maps.pk3:maps/" + std::string(name) + ".bsp");
    for (const Mesh& mesh : scene.meshes) {
      double agreement = 0;
      for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
        const auto at = [&](std::uint32_t k) {
          return mesh.first_vertex + scene.indices[mesh.first_index + i + k];
        };
        const Vec3 a = scene.positions[at(0)], b = scene.positions[at(1)], c = scene.positions[at(2)];
        const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
        for (std::uint32_t k = 0; k < 3; ++k) {
          const Vec3 n = scene.normals[at(k)];
          agreement += double{n.x} * (u.y * v.z - u.z * v.y) + double{n.y} * (u.z * v.x - u.x * v.z) +
                       double{n.z} * (u.x * v.y - u.y * v.x);
        }
      }
      good += agreement > 0;
      bad += agreement < 0;
      patches += is_patch(mesh);
      bad_patches += agreement < 0 && is_patch(mesh);
    }
  }
  EXPECT_GT(good, 10000u);
  EXPECT_LT(bad * 50, good);
  EXPECT_GT(patches, 100u);
  EXPECT_EQ(bad_patches, 0u);
}

/// A level with doors and lifts, whose faces belong to no leaf.
TEST_F(OpenArena, WhatPlayersSeeIsInTheReferencePvs) {
  const Scene scene = load_scene("pak1-maps.pk3:maps/ce1m7.bsp");
  std::mt19937 random(3);
  std::normal_distribution<float> axis;
  std::vector<std::uint8_t> mask(scene.size());
  int moving = 0;
  for (const Viewpoint& view : scene.viewpoints) {
    scene.level->potentially_visible(view.eye, mask);
    for (int ray = 0; ray < 100; ++ray) {
      const Hit hit = nearest_hit(scene, view.eye, {axis(random), axis(random), axis(random)});
      ASSERT_NE(hit.object, kNoObject) << "the level is closed";
      EXPECT_EQ(mask[hit.object], 1) << view.name << " sees face " << hit.object;
      moving += scene.level->in_world_model[hit.object] == 0;
    }
  }
  EXPECT_GT(moving, 0) << "expected a door in sight";
}

TEST_F(OpenArena, MissingLevelNamesItsNeighbours) {
  try {
    load_scene("pak1-maps.pk3:maps/oasago3.bsp");
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("maps/oasago2.bsp"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sightline
