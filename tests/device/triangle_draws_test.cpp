// Ranges of triangles on the device: what methods submit looks like all triangles, however it is submitted.
#include <algorithm>

#include <sightline/workbench/method.hpp>

#include "device/fixtures.hpp"
#include "support/triangles.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/device/triangle_draws.hpp"
#include "workbench/oracle/embree_judge.hpp"

namespace sightline {
namespace {

class TriangleDrawsTest : public DeviceTest {};

// The whole geometry as one range: drawn without any culling but the rasteriser's own of back faces.
std::vector<DrawCommand> everything(const Scene& scene, const TriangleGeometry& geometry) {
  std::vector<DrawCommand> draws;
  const auto count = static_cast<std::uint32_t>(geometry.objects.size());
  for (std::uint32_t first = 0; first < count;) {
    const Surface surface = scene.surface[geometry.objects[first]];
    std::uint32_t end = first;
    while (end < count && scene.surface[geometry.objects[end]] == surface) ++end;
    if (surface == Surface::opaque) draws.push_back({3 * (end - first), 1, 3 * first, 0, first});
    first = end;
  }
  return draws;
}

TEST_F(TriangleDrawsTest, WhatIsSubmittedLooksLikeAllTriangles) {
  std::vector<Scene> scenes;
  scenes.push_back(generate_world("soup?triangles=4000&size=60"));
  scenes.push_back(test::scene_of(test::awkward_triangles()[0].triangles));
  for (const Scene& scene : scenes) {
    device::Renderer renderer(device(), scene);
    for (const std::string name :
         {"simple-octree", "drawcall-wise-kd-tree", "zhang-grid", "zhang-octree", "cluster-cone"}) {
      const auto method = create_method(name, scene);
      device::TriangleDraws draws(renderer, *method->geometry());
      const auto all = everything(scene, *method->geometry());
      std::size_t shown = 0;
      for (const Camera& camera : camera::random_cameras(scene, 12, 5)) {
        const View view = view_of(camera, 160, 100);
        Frame frame;
        cull(*method, view, frame);
        const auto truth = draws.items(view, all).ids;
        for (const Submission submission : {Submission::calls, Submission::multi_draw}) {
          const auto picture = draws.items(view, frame.draws, submission).ids;
          ASSERT_EQ(std::ranges::mismatch(picture, truth).in1, picture.end()) << name;
        }
        shown += static_cast<std::size_t>(
            std::ranges::count_if(truth, [](ObjectId id) { return id != kNoObject; }));
      }
      EXPECT_GT(shown, 1000u) << name;
    }
  }
}

// Two independent judges of facing: the rasteriser's winding and the rays' normals.
TEST_F(TriangleDrawsTest, BackFacesAreThoseOfTheRayJudge) {
  Scene scene = generate_world("soup?triangles=4000&size=60");
  set_raster_state(scene, RasterState::front_faces);
  device::Renderer renderer(device(), scene);
  const auto zhang = create_method("zhang-octree", scene);
  device::TriangleDraws draws(renderer, *zhang->geometry());
  const oracle::EmbreeJudge judge(scene);
  std::size_t differ = 0, all = 0;
  for (const Camera& camera : camera::random_cameras(scene, 8, 6)) {
    const View view = view_of(camera, 160, 100);
    const auto picture = draws.items(view, everything(scene, *zhang->geometry())).ids;
    const auto rays = judge.render(view).ids;
    for (std::size_t p = 0; p < rays.size(); ++p) differ += picture[p] != rays[p];
    all += rays.size();
  }
  EXPECT_LT(differ, all / 200);  // silhouettes round differently
}

// Opaque triangles, then all transparent objects far to near: what Renderer and DrawList draw without
// culling.
std::vector<DrawCommand> whole_picture(const Scene& scene, const View& view) {
  std::vector<std::pair<float, ObjectId>> far_first;
  std::vector<std::uint32_t> first{0};
  std::vector<DrawCommand> draws;
  const auto draw = [&](ObjectId object) {
    const std::uint32_t count = scene.meshes[scene.mesh[object]].index_count;
    draws.push_back({count, 1, 3 * first[object], 0, first[object]});
  };
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  for (ObjectId object = 0; object < scene.size(); ++object) {
    first.push_back(first.back() + scene.meshes[scene.mesh[object]].index_count / 3);
    if (scene.surface[object] == Surface::opaque) {
      draw(object);
      continue;
    }
    const Box box = scene.bounds[object];
    const float depth = (0.5f * (box.min.x + box.max.x) - eye.x) * forward.x +
                        (0.5f * (box.min.y + box.max.y) - eye.y) * forward.y +
                        (0.5f * (box.min.z + box.max.z) - eye.z) * forward.z;
    far_first.emplace_back(-depth, object);
  }
  std::ranges::sort(far_first);
  for (const auto& [depth, object] : far_first) draw(object);
  return draws;
}

TEST_F(TriangleDrawsTest, TransparentTrianglesBlendAsWithoutCulling) {
  Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
  for (ObjectId object = 0; object < scene.size(); object += 3) scene.surface[object] = Surface::transparent;
  device::Renderer renderer(device(), scene);
  const auto all = create_method("simple-octree", scene);  // its list is the scene's, in order
  for (const std::string name : {"simple-octree", "drawcall-wise-kd-tree", "zhang-grid",
                                 "zhang-octree?height=6", "cluster-cone", "adaptive"}) {
    const auto method = create_method(name, scene);
    device::TriangleDraws draws(renderer, *method->geometry()), truth(renderer, *all->geometry());
    for (const Camera& camera : camera::random_cameras(scene, 8, 15)) {
      const View view = view_of(camera, 160, 100);
      Frame frame;
      cull(*method, view, frame);
      renderer.frame(view, [&](device::Recorder& recorder) {
        draws.draw(recorder, frame.draws, method->geometry()->submission);
      });
      const device::Picture picture = renderer.picture();
      renderer.frame(view, [&](device::Recorder& recorder) {
        truth.draw(recorder, whole_picture(scene, view), Submission::calls);
      });
      ASSERT_EQ(picture, renderer.picture()) << name;
    }
  }
}

// Fragments know their object without triangle numbers, which would want geometry shaders.
TEST(TriangleDraws, NeedNoGeometryShaders) {
  device::DeviceOptions options;
  options.withheld = {"geometryShader"};
  options.validation = true;
  device::Device device(options);
  const Scene scene = generate_world("soup?triangles=500&size=60");
  {
    device::Renderer renderer(device, scene);
    const auto method = create_method("cluster-cone", scene);
    device::TriangleDraws draws(renderer, *method->geometry());
    const View view = view_of({.eye = {0, 0, 90}, .forward = {0, 0, -1}}, 160, 100);
    Frame frame;
    cull(*method, view, frame);
    const auto ids = draws.items(view, frame.draws).ids;
    EXPECT_GT(std::ranges::count_if(ids, [](ObjectId id) { return id != kNoObject; }), 100);
  }
  EXPECT_EQ(device.messages(), 0u) << device.first_message();
}

TEST_F(TriangleDrawsTest, DrawsAPictureWithBlendedTrianglesLast) {
  const Scene scene = test::scene_of(test::awkward_triangles()[0].triangles);
  device::Renderer renderer(device(), scene);
  const auto method = create_method("drawcall-wise-octree", scene);
  device::TriangleDraws draws(renderer, *method->geometry());
  const View view = view_of({.eye = {0, 5, 90}, .forward = {0, 0, -1}});
  Frame frame;
  cull(*method, view, frame);
  std::vector<device::Picture> pictures;
  for (const Submission submission : {Submission::calls, Submission::multi_draw}) {
    renderer.frame(view, [&](device::Recorder& recorder) { draws.draw(recorder, frame.draws, submission); });
    pictures.push_back(renderer.picture());
  }
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_GT(std::ranges::count_if(pictures[0].pixels, [&](auto p) { return p != pictures[0].pixels[0]; }),
            1000);
  EXPECT_GT(draws.bytes(), 0u);
  frame.draws.clear();
  renderer.frame(
      view, [&](device::Recorder& recorder) { draws.draw(recorder, frame.draws, Submission::multi_draw); });
}

}  // namespace
}  // namespace sightline
