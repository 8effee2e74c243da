#include <cstdio>

#include "raster_occlusion/examine.hpp"
#include "workbench/camera/random_views.hpp"

namespace sightline {
namespace {

class Exactness : public DeviceTest, public testing::WithParamInterface<const char*> {};

std::vector<std::string> with_exact_contribution() {
  std::vector<std::string> out;
  for (const std::string& name : kOcclusionMethods) out.push_back(name + "?contribution=exact");
  out.insert(out.end(), {"vertex-chunk?faces=facing&contribution=exact", "vfc-vc?contribution=exact"});
  return out;
}

// Every random view is a camera cut: none of the last frame's visible objects says anything about it.
TEST_P(Exactness, NothingIsLostAfterACameraCut) {
  Scene scene = generate_world(GetParam());
  Examination examination(device(), scene, kOcclusionMethods);
  std::size_t index = 0;
  for (const Camera& camera : camera::random_cameras(scene, 24, 3)) {
    examination.look(view_of(camera, 192, 108), "in view " + std::to_string(index++));
  }
  std::printf("kept %.2f times the visible\n",
              static_cast<double>(examination.kept()) /
                  static_cast<double>(examination.visible() * kOcclusionMethods.size()));
}

TEST_P(Exactness, NothingIsLostWithTheExactContributionTest) {
  Scene scene = generate_world(GetParam());
  Examination examination(device(), scene, with_exact_contribution());
  std::size_t index = 0;
  for (const Camera& camera : camera::random_cameras(scene, 8, 4)) {
    examination.look(view_of(camera, 96, 54), "in view " + std::to_string(index++));
  }
}

TEST_P(Exactness, NothingIsLostWhileObjectsAndCameraMove) {
  Scene scene = generate_world(GetParam());
  Examination examination(device(), scene, kOcclusionMethods);
  scene::Random random(8);
  Camera camera = camera_at(scene, "near");
  for (int step = 0; step < 12; ++step) {
    camera.eye.z -= 2;
    camera.forward.x += 0.02f;
    camera.depth = step < 6 ? Depth::standard : Depth::reversed;
    examination.move(0.1, random);
    examination.look(view_of(camera), "in step " + std::to_string(step));
  }
}

// Orthographic along an axis, with trees' triangles edge on: a rasteriser that takes their depth from
// positions off its own grid draws them at the near plane, before the boxes that hold them.
using EdgeOn = DeviceTest;
TEST_F(EdgeOn, TrianglesStayWithinTheirBoxes) {
  Scene scene = generate_world("forest?trees=3000&size=300");
  Camera camera;
  camera.eye = {-199.25568f, 16.579414f, -79.85297f};
  camera.forward = {1, 0, 4.371139e-8f};
  camera.up = {5.6993077e-9f, -0.9914634f, -0.13038497f};
  camera.near_plane = 0.96965945f;
  camera.far_plane = 236.63557f;
  camera.orthographic_height = 114.486374f;
  camera.depth = Depth::reversed;
  Examination examination(device(), scene, kOcclusionMethods);
  for (int frame = 0; frame < 3; ++frame) {
    examination.look(view_of(camera, 160, 120), "in frame " + std::to_string(frame));
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, Exactness,
                         testing::Values("regular?columns=30&rows=30&detail=2",
                                         "irregular?spheres=1500&size=100&detail=2",
                                         "forest?trees=1500&size=200"),
                         [](const auto& info) {
                           const std::string_view name = info.param;
                           return std::string(name.substr(0, name.find('?')));
                         });

}  // namespace
}  // namespace sightline
