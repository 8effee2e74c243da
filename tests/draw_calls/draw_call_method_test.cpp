// The methods of paper D draw the picture that all triangles draw: nothing less, down to the triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <sightline/frustum.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/random_views.hpp"
#include "support/triangles.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/verify.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline {
namespace {

const std::array<std::string, 11> kAll{
    "simple-grid",          "simple-octree",         "simple-kd-tree", "drawcall-wise-grid",
    "drawcall-wise-octree", "drawcall-wise-kd-tree", "zhang-grid",     "zhang-octree",
    "zhang-kd-tree",        "cluster-cone",          "adaptive"};

// Forms of them that draw more, less or otherwise.
const std::array<std::string, 10> kForms{"simple-grid?cells=tight&height=3",
                                         "simple-octree?least=11&cells=tight&height=3",
                                         "drawcall-wise-grid?cells=tight",
                                         "drawcall-wise-octree?least=11&cells=tight&height=3",
                                         "drawcall-wise-kd-tree?least=11&cells=tight",
                                         "drawcall-wise-grid?occlusion=masked",
                                         "drawcall-wise-octree?occlusion=masked",
                                         "drawcall-wise-kd-tree?occlusion=masked&cells=tight",
                                         "zhang-octree?planes=xy",
                                         "zhang-grid?planes=both&cells=tight"};

std::set<std::uint32_t> submitted(const Method& method, const Frame& frame) {
  std::set<std::uint32_t> out;
  for (const DrawCommand& draw : frame.draws) {
    const auto sources = method.geometry()->sources.subspan(draw.first_instance, draw.index_count / 3);
    out.insert(sources.begin(), sources.end());
  }
  return out;
}

TEST(DrawCalls, LoseNoPixelOfAwkwardScenes) {
  std::vector<std::string> names(kAll.begin(), kAll.end());
  names.insert(names.end(), kForms.begin(), kForms.end());
  for (const auto& [name, triangles] : test::awkward_triangles()) {
    Scene scene = test::scene_of(triangles);
    for (const RasterState state : {RasterState::both_sides, RasterState::front_faces}) {
      set_raster_state(scene, state);
      measure::Bench bench(scene, names);
      const auto cameras = camera::random_cameras(scene, 25, 7);
      const measure::Verification result = measure::verify(bench, cameras, 96, 64);
      for (const auto& verdict : result.methods) {
        EXPECT_EQ(verdict.guarantee, Guarantee::exact);
        EXPECT_EQ(verdict.lost_pixels, 0u) << name << ' ' << verdict.method;
        if (name != "single" && name != "degenerate") EXPECT_GT(verdict.visible, 0u) << name;
      }
    }
  }
}

// Independent of the judge's own book-keeping: rays against a scene of only the submitted triangles.
TEST(DrawCalls, ASceneOfOnlyTheSubmittedTrianglesLooksTheSame) {
  Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
  // Every other object from its front alone.
  for (ObjectId object = 0; object < scene.size(); object += 2)
    scene.sides[object] = scene.material_sides[object] = Sides::front;
  const Scene triangles = oracle::one_object_a_triangle(scene);
  const oracle::EmbreeJudge judge(triangles);
  const auto cameras = camera::random_cameras(scene, 6, 9);
  for (const std::string& name : kAll) {
    const auto method = create_method(name, scene);
    for (const Camera& camera : cameras) {
      const View view = *make_view(camera, 120, 80);
      Frame frame;
      cull(*method, view, frame);
      const std::set<std::uint32_t> drawn = submitted(*method, frame);
      Scene only;
      std::vector<std::uint32_t> number;
      for (const std::uint32_t t : drawn) {
        const Mesh& mesh = triangles.meshes[t];
        const std::uint32_t added =
            only.add_mesh(std::span(triangles.positions).subspan(mesh.first_vertex, 3),
                          std::span(triangles.normals).subspan(mesh.first_vertex, 3),
                          std::span(triangles.indices).subspan(mesh.first_index, 3));
        only.add_object(added, {}, triangles.material(t));
        number.push_back(t);
      }
      const oracle::ItemBuffer truth = judge.render(view);
      if (only.empty()) {
        EXPECT_EQ(truth.visible_count(), 0u);
        continue;
      }
      const oracle::ItemBuffer picture = oracle::EmbreeJudge(only).render(view);
      for (std::size_t p = 0; p < truth.ids.size(); ++p) {
        const ObjectId shown = picture.ids[p] == kNoObject ? kNoObject : number[picture.ids[p]];
        ASSERT_EQ(shown, truth.ids[p]) << name << " pixel " << p;
      }
    }
  }
}

// Brute force: a triangle whose box overlaps the frustum is submitted by simple and drawcall-wise whatever
// the structure, its height and the submission.
TEST(DrawCalls, EveryTriangleWithACornerInViewIsSubmitted) {
  for (const auto& [name, triangles] : test::awkward_triangles()) {
    const Scene scene = test::scene_of(triangles);
    for (const char* structure : {"grid", "octree", "kd-tree"}) {
      for (const char* height : {"1", "3", "6"}) {
        std::vector<std::unique_ptr<Method>> methods;
        for (const std::string strategy : {"simple-", "drawcall-wise-"}) {
          for (const std::string submission : {"calls", "multi-draw", "merged"}) {
            methods.push_back(create_method(
                strategy + structure + "?height=" + height + "&submission=" + submission, scene));
          }
        }
        scene::Random random(61);
        for (int v = 0; v < 12; ++v) {
          const View view = test::random_view(random, {{-60, -25, -60}, {60, 25, 60}});
          const Frustum frustum = make_frustum(view);
          std::vector<std::set<std::uint32_t>> drawn;
          std::vector<Frame> frames(methods.size());
          for (std::size_t m = 0; m < methods.size(); ++m) {
            cull(*methods[m], view, frames[m]);
            drawn.push_back(submitted(*methods[m], frames[m]));
            ASSERT_EQ(drawn[m], drawn[0]) << name << ' ' << structure << height << " method " << m;
          }
          for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const bool corner_in_view = std::ranges::any_of(triangles[t], [&](const Vec3& corner) {
              return overlaps(frustum, Box{corner, corner});
            });
            if (corner_in_view) ASSERT_TRUE(drawn[0].contains(t)) << name << ' ' << structure << ' ' << t;
          }
          // Merging never adds calls; what is merged in the global list is drawn once.
          EXPECT_LE(frames[1].stats.draw_calls, std::min<std::size_t>(2, frames[1].draws.size()));
          EXPECT_LE(frames[2].stats.draw_calls, frames[0].stats.draw_calls);
          EXPECT_EQ(frames[2].stats.triangles, drawn[2].size());
          EXPECT_LE(frames[5].stats.draw_calls, frames[3].stats.draw_calls);
          EXPECT_EQ(frames[5].stats.triangles, frames[3].stats.triangles);
        }
      }
    }
  }
}

// Whatever the cells: after the opaque, whole objects far to near, each triangle once and in its mesh's
// order. A triangle that crosses cells would be blended over itself, and cells are in no order of depth.
TEST(DrawCalls, BlendTransparentTrianglesOnceAndFarToNear) {
  const Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
  scene::Random random(63);
  std::size_t blended = 0;
  for (std::string name : kAll) {
    for (const std::string submission : {"calls", "multi-draw", "merged"}) {
      if (name == "adaptive" && submission != "calls") continue;
      const auto method =
          create_method(name == "adaptive" ? name : name + "?submission=" + submission, scene);
      for (int v = 0; v < 20; ++v) {
        const View view = test::random_view(random, {{-60, -25, -60}, {60, 25, 60}});
        const Vec3 eye = eye_position(view), forward = view_direction(view);
        Frame frame;
        cull(*method, view, frame);
        std::vector<std::uint32_t> drawn;
        bool blending = false;
        for (const DrawCommand& draw : frame.draws) {
          for (std::uint32_t t = draw.first_instance; t < draw.first_instance + draw.index_count / 3; ++t) {
            const bool transparent = scene.surface[method->geometry()->objects[t]] == Surface::transparent;
            ASSERT_TRUE(transparent || !blending) << "opaque after transparent";
            blending = transparent;
            if (transparent) drawn.push_back(method->geometry()->sources[t]);
          }
        }
        const auto behind = [&](std::uint32_t triangle) {
          const Box box = scene.bounds[triangle / 5];  // five triangles an object
          return (0.5f * (box.min.x + box.max.x) - eye.x) * forward.x +
                 (0.5f * (box.min.y + box.max.y) - eye.y) * forward.y +
                 (0.5f * (box.min.z + box.max.z) - eye.z) * forward.z;
        };
        for (std::size_t i = 1; i < drawn.size(); ++i) {
          if (drawn[i] / 5 == drawn[i - 1] / 5) {
            ASSERT_GT(drawn[i], drawn[i - 1]) << name;
          } else {
            ASSERT_LE(behind(drawn[i]), behind(drawn[i - 1])) << name;
          }
        }
        blended += drawn.size();
        std::ranges::sort(drawn);
        ASSERT_EQ(std::ranges::adjacent_find(drawn), drawn.end()) << name;
      }
    }
  }
  EXPECT_GT(blended, 1000u);
}

TEST(DrawCalls, ZhangSubmitsNoMoreThanDrawcallWise) {
  Scene scene = generate_world("soup?triangles=20000&size=60");
  set_raster_state(scene, RasterState::front_faces);
  const auto zhang = create_method("zhang-octree", scene),
             plain = create_method("drawcall-wise-octree", scene);
  scene::Random random(62);
  std::uint64_t fewer = 0, all = 0;
  for (int v = 0; v < 40; ++v) {
    const View view = test::random_view(random, {{-30, -30, -30}, {30, 30, 30}});
    Frame a, b;
    cull(*zhang, view, a), cull(*plain, view, b);
    ASSERT_LE(a.stats.triangles, b.stats.triangles);
    fewer += a.stats.triangles, all += b.stats.triangles;
  }
  EXPECT_LT(static_cast<double>(fewer), 0.85 * static_cast<double>(all));
}

// Dear calls want few of them, dear triangles want few of those.
TEST(DrawCalls, AdaptivePicksByWhatTheDeviceCharges) {
  const Scene scene = generate_world("soup?triangles=6000&size=60");
  const auto dear_calls = create_method("adaptive?call-ns=1000000&command-ns=1000000&triangle-ns=1", scene);
  const auto dear_triangles = create_method("adaptive?call-ns=1&command-ns=1&triangle-ns=1000", scene);
  CullStats a, b;
  for (int v = 0; v < 20; ++v) {
    const float turn = 0.314f * static_cast<float>(v);
    const View view = *make_view({.forward = {std::sin(turn), 0, std::cos(turn)}}, 640, 360);
    Frame frame;
    cull(*dear_calls, view, frame);
    a.draw_calls += frame.draws.size(), a.triangles += frame.stats.triangles;
    cull(*dear_triangles, view, frame);
    b.draw_calls += frame.draws.size(), b.triangles += frame.stats.triangles;
  }
  EXPECT_LT(10 * a.draw_calls, b.draw_calls);
  EXPECT_LT(b.triangles, a.triangles);
}

TEST(DrawCalls, AdaptiveFollowsMovedObjects) {
  Scene scene = generate_world("soup?triangles=3000&size=60");
  const auto method = create_method("adaptive", scene);
  Affine away;
  away.rows[0].w = 500;
  scene.move_object(0, away);
  const std::array<ObjectId, 1> moved{0};
  method->update(moved);
  const Vec3 centre = scene.sphere(0).centre;
  Frame frame;
  cull(*method, *make_view({.eye = {centre.x, centre.y, centre.z + 60}}, 64, 64), frame);
  EXPECT_NE(std::ranges::find(frame.visible, ObjectId{0}), frame.visible.end());
}

// After each move every triangle that is drawn stands where its object stands, and none in view is missing.
TEST(DrawCalls, DrawMovedObjectsWhereTheyAre) {
  for (const std::string name :
       {"simple-octree", "simple-grid?submission=merged", "drawcall-wise-kd-tree?height=6",
        "drawcall-wise-grid?submission=merged", "drawcall-wise-octree?occlusion=masked",
        "zhang-octree?planes=both", "zhang-octree", "cluster-cone", "adaptive"}) {
    Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
    const auto method = create_method(name, scene);
    scene::Random random(64);
    for (int move = 0; move < 8; ++move) {
      std::vector<ObjectId> moved;
      for (int i = 0; i < 6; ++i) {
        const ObjectId object = random.below(static_cast<std::uint32_t>(scene.size()));
        if (std::ranges::find(moved, object) != moved.end()) continue;
        Affine away;
        away.rows[0].w = random.between(-40, 40), away.rows[2].w = random.between(-40, 40);
        scene.move_object(object, away);
        moved.push_back(object);
      }
      method->update(moved);
      oracle::TriangleJudge judge(scene);
      const Scene triangles = oracle::one_object_a_triangle(scene);
      for (int v = 0; v < 4; ++v) {
        View view = test::random_view(random, {{-60, -25, -60}, {60, 25, 60}});
        view.width = 48, view.height = 32;
        Frame frame;
        cull(*method, view, frame);
        const TriangleGeometry& geometry = *method->geometry();
        for (const DrawCommand& draw : frame.draws) {
          for (std::uint32_t t = draw.first_instance; t < draw.first_instance + draw.index_count / 3; ++t) {
            const Mesh& mesh = triangles.meshes[geometry.sources[t]];
            for (std::uint32_t c = 0; c < 3; ++c) {
              ASSERT_EQ(geometry.positions[geometry.indices[3 * t + c]],
                        triangles.positions[mesh.first_vertex + c])
                  << name << " move " << move << " triangle " << geometry.sources[t];
            }
            ASSERT_EQ(geometry.objects[t], geometry.sources[t] / 5);
          }
        }
        const auto verdict = judge.judge(view, geometry, frame);
        ASSERT_EQ(verdict.loss.lost_pixels, 0u) << name << " move " << move;
        auto visible = frame.visible;
        std::ranges::sort(visible);
        ASSERT_EQ(std::ranges::adjacent_find(visible), visible.end()) << name;
      }
    }
  }
}

// What stands still stays where it was: an update's cost is that of what moved.
TEST(DrawCalls, MovingAnObjectLeavesTheOthersAlone) {
  for (const std::string name : {"drawcall-wise-octree", "zhang-kd-tree", "cluster-cone"}) {
    Scene scene = generate_world("soup?triangles=20000&per-object=20&size=60");
    const auto method = create_method(name, scene);
    const std::vector<std::uint32_t> before(method->geometry()->sources.begin(),
                                            method->geometry()->sources.end());
    Affine away;
    away.rows[0].w = 500;  // the scene's extent, by which a new structure would be cut, changes
    scene.move_object(7, away);
    const std::array<ObjectId, 1> moved{7};
    method->update(moved);
    const auto after = method->geometry()->sources;
    ASSERT_EQ(after.size(), before.size() + 20);
    EXPECT_TRUE(std::ranges::equal(after.first(before.size()), before)) << name;
    for (int again = 0; again < 3; ++again) method->update(moved);
    EXPECT_EQ(method->geometry()->sources.size(), before.size() + 20);
  }
}

TEST(DrawCalls, ThePrintedRuleLosesPixelsAndSaysThatItMay) {
  Scene scene = generate_world("soup?triangles=5000&size=60");
  set_raster_state(scene, RasterState::front_faces);
  const std::vector<std::string> names{"zhang-octree?facing=printed", "zhang-octree"};
  measure::Bench bench(scene, names);
  const auto result = measure::verify(bench, camera::random_cameras(scene, 20, 3), 96, 64);
  EXPECT_EQ(result.methods[0].guarantee, Guarantee::approximate);
  EXPECT_GT(result.methods[0].lost_pixels, 0u);
  EXPECT_EQ(result.methods[1].lost_pixels, 0u);
}

TEST(DrawCalls, AllocateNothingOnceTheyHaveGrown) {
  const Scene scene = generate_world("soup?triangles=5000&size=60");
  std::vector<std::string> names(kAll.begin(), kAll.end());
  names.insert(names.end(), kForms.begin(), kForms.end());
  for (const std::string& name : names) {
    const auto method = create_method(name, scene);
    const View view = *make_view({.eye = {0, 0, 0}}, 320, 200);
    Frame frame;
    cull(*method, view, frame);
    const auto* draws = frame.draws.data();
    const auto* visible = frame.visible.data();
    for (int i = 0; i < 3; ++i) cull(*method, view, frame);
    EXPECT_EQ(frame.draws.data(), draws);
    EXPECT_EQ(frame.visible.data(), visible);
  }
}

}  // namespace
}  // namespace sightline
