// Occlusion among the cells of paper D, and the paper's own rules beside ours.
#include <gtest/gtest.h>

#include <algorithm>

#include <sightline/workbench/io.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/random_views.hpp"
#include "support/triangles.hpp"
#include "workbench/camera/camera_path.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline {
namespace {

std::uint32_t add_square(Scene& scene, float side) {
  const float h = 0.5f * side;
  const std::vector<Vec3> positions{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  const std::vector<Vec3> normals(4, Vec3{0, 0, 1});
  return scene.add_mesh(positions, normals, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
}

Affine at(float x, float y, float z) {
  Affine out;
  out.rows[0].w = x, out.rows[1].w = y, out.rows[2].w = z;
  return out;
}

/// A wall, object 0, before rows of small squares, and one small square before the wall.
Scene behind_a_wall() {
  Scene scene;
  const std::uint32_t wall = add_square(scene, 40), small = add_square(scene, 1);
  scene.add_object(wall, at(0, 0, -10));
  scene.add_object(small, at(2.4f, 1.7f, -8));
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column)
      scene.add_object(small, at(static_cast<float>(column) - 4.5f, static_cast<float>(row) - 4.5f, -30));
  }
  return scene;
}

const View kOntoTheWall = *make_view({.eye = {0, 0, 0}, .vertical_fov = 0.6f}, 160, 120);

TEST(HiddenCells, WhatAWallHidesIsNotDrawn) {
  const Scene scene = behind_a_wall();
  for (const std::string structure : {"grid", "octree", "kd-tree"}) {
    const auto plain = create_method("drawcall-wise-" + structure, scene),
               masked = create_method("drawcall-wise-" + structure + "?occlusion=masked", scene);
    Frame all, left;
    cull(*plain, kOntoTheWall, all), cull(*masked, kOntoTheWall, left);
    EXPECT_EQ(all.visible.size(), scene.size()) << structure;
    std::ranges::sort(left.visible);
    EXPECT_EQ(left.visible, (std::vector<ObjectId>{0, 1})) << structure;
    EXPECT_EQ(left.stats.culled_occlusion, scene.size() - 2);
    EXPECT_LT(left.stats.triangles, all.stats.triangles / 4);
  }
}

// What moves is hidden where it is, and hides nothing where it was.
TEST(HiddenCells, WhatMovesHidesNothingWhereItWas) {
  Scene scene = behind_a_wall();
  const auto method = create_method("drawcall-wise-octree?occlusion=masked", scene);
  const std::array<ObjectId, 1> wall{0}, small{50};
  Frame frame;
  scene.move_object(50, at(0, 3, -40));
  method->update(small);
  cull(*method, kOntoTheWall, frame);
  EXPECT_EQ(frame.visible.size(), 2u);
  scene.move_object(50, at(0, 1, -5));
  method->update(small);
  cull(*method, kOntoTheWall, frame);
  EXPECT_NE(std::ranges::find(frame.visible, ObjectId{50}), frame.visible.end());
  scene.move_object(0, at(500, 0, -10));
  method->update(wall);
  cull(*method, kOntoTheWall, frame);
  EXPECT_GT(frame.visible.size(), scene.size() - 10);  // but for a few behind the square in front
}

// Where a scene occludes as one, its occluder is made anew once something of it moves.
TEST(HiddenCells, AMovedWallOfAWholeSceneHidesNothingWhereItWas) {
  Scene scene;
  const std::uint32_t wall = add_square(scene, 40), small = add_square(scene, 1);
  scene.add_object(wall, at(0, 0, -10));
  scene.add_object(small, at(0, 0, -30));
  scene.add_object(small, at(1, 1, -8));
  const auto masked = create_method("masked", scene);
  Frame frame;
  cull(*masked, kOntoTheWall, frame);
  EXPECT_EQ(frame.visible.size(), 2u);
  scene.move_object(0, at(500, 0, -10));
  const ObjectId moved[]{0};
  masked->update(moved);
  cull(*masked, kOntoTheWall, frame);
  std::ranges::sort(frame.visible);
  EXPECT_EQ(frame.visible, (std::vector<ObjectId>{1, 2}));
}

// A cut-out may be looked through.
TEST(HiddenCells, OnlyOpaqueSurfacesHide) {
  Scene scene = behind_a_wall();
  scene.surface[0] = Surface::cut_out;
  Frame frame;
  cull(*create_method("drawcall-wise-octree?occlusion=masked", scene), kOntoTheWall, frame);
  EXPECT_EQ(frame.visible.size(), scene.size());
}

// Hidden triangles between two ranges are drawn along where a call is worth more than they: six, not twelve.
TEST(HiddenCells, SmallGapsAreDrawnAlong) {
  Scene scene;
  const std::uint32_t wall = add_square(scene, 40), small = add_square(scene, 1);
  const auto add = [&](std::size_t count, float z) {
    for (std::size_t i = 0; i < count; ++i) scene.add_object(small, at(0, static_cast<float>(i % 3) - 1, z));
  };
  scene.add_object(wall, at(0, 0, -10));
  add(1, -8), add(3, -30), add(1, -7), add(6, -30), add(1, -6);
  Frame frame;
  // Too few triangles for more than one cell.
  cull(*create_method("drawcall-wise-octree?occlusion=masked&least=11&cells=tight", scene), kOntoTheWall,
       frame);
  EXPECT_EQ(frame.visible, (std::vector<ObjectId>{0, 1, 2, 3, 4, 5, 12}));
  EXPECT_EQ(frame.stats.draw_calls, 2u);
  EXPECT_EQ(frame.stats.triangles, 14u);
  EXPECT_EQ(frame.stats.culled_occlusion, 6u);
}

class Levels : public testing::TestWithParam<const char*> {};

// The three levels of the paper's reproduction.
TEST_P(Levels, OcclusionKeepsHalfAtMostAndLosesNothing) {
  const Scene scene = load_scene(std::string("pak1-maps.pk3:maps/") + GetParam() + ".bsp");
  const auto path = camera::make_path(scene, "walk", 8);
  oracle::TriangleJudge judge(scene);
  for (const std::string structure : {"grid", "octree", "kd-tree"}) {
    const auto plain = create_method("drawcall-wise-" + structure, scene),
               masked = create_method("drawcall-wise-" + structure + "?occlusion=masked", scene);
    std::size_t objects = 0, left = 0;
    std::uint64_t triangles = 0, triangles_left = 0;
    for (const Camera& camera : path.cameras) {
      const View view = *make_view(camera, 160, 90);
      Frame frame;
      cull(*plain, view, frame);
      objects += frame.visible.size(), triangles += frame.stats.triangles;
      cull(*masked, view, frame);
      left += frame.visible.size(), triangles_left += frame.stats.triangles;
      EXPECT_EQ(judge.judge(view, *masked->geometry(), frame).loss.lost_pixels, 0u) << structure;
    }
    EXPECT_LE(2 * left, objects) << structure;
    EXPECT_LE(2 * triangles_left, triangles) << structure;
  }
}

INSTANTIATE_TEST_SUITE_P(OpenArena, Levels, testing::Values("ce1m7", "wrackdm17", "ctf_inyard"),
                         [](const auto& test) { return std::string(test.param); });

// Who names a method of the paper gets its cells: every node split to the height, and regions.
TEST(CellRules, TheDefaultsAreThePapers) {
  const Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
  scene::Random random(65);
  for (const std::string strategy : {"simple-", "drawcall-wise-", "zhang-"}) {
    for (const std::string structure : {"grid", "octree", "kd-tree"}) {
      const auto plain = create_method(strategy + structure, scene),
                 told = create_method(strategy + structure + "?least=0&cells=printed", scene);
      for (int v = 0; v < 10; ++v) {
        const View view = test::random_view(random, {{-60, -25, -60}, {60, 25, 60}});
        Frame a, b;
        cull(*plain, view, a), cull(*told, view, b);
        ASSERT_EQ(a.visible, b.visible);
        ASSERT_EQ(a.stats.triangles, b.stats.triangles);
        ASSERT_EQ(a.draws.size(), b.draws.size());
      }
    }
  }
}

// The stop rule saves calls; without culling in y and by equal cells more is drawn.
TEST(CellRules, ThePapersRulesDrawMore) {
  const Scene scene = generate_world("soup?triangles=4000&size=60&edge=0.5");
  const auto count = [&](const char* specification) {
    const auto method = create_method(specification, scene);
    scene::Random random(66);
    CullStats sum;
    Frame frame;
    for (int v = 0; v < 20; ++v) {
      cull(*method, test::random_view(random, {{-30, -30, -30}, {30, 30, 30}}), frame);
      sum.draw_calls += frame.stats.draw_calls, sum.triangles += frame.stats.triangles;
    }
    return sum;
  };
  const CullStats ours = count("drawcall-wise-octree?least=11&cells=tight"),
                  split = count("drawcall-wise-octree?cells=tight"), printed = count("drawcall-wise-octree");
  EXPECT_GT(split.draw_calls, 2 * ours.draw_calls);
  EXPECT_LT(split.triangles, ours.triangles);
  EXPECT_GT(printed.draw_calls, split.draw_calls);
  EXPECT_GT(printed.triangles, split.triangles);
}

}  // namespace
}  // namespace sightline
