// What hroc rasterises and casts, and that its parameters change what it costs and never what it loses.
#include "raster_occlusion/examine.hpp"

namespace sightline {
namespace {

using HrocTest = DeviceTest;

// The counts of a method's third frame from the near view: in the first nothing hides, so that in the second
// all that was in view passes for visible.
CullStats third_frame(device::Device& device, Scene& scene, const std::string& specification) {
  Examination examination(device, scene, {specification});
  for (int frame = 0; frame < 3; ++frame) examination.look(view_of(camera_at(scene, "near")), specification);
  return examination.last_frame().stats;
}

TEST_F(HrocTest, WithEveryBoxFeedsThePapersVertices) {
  Scene scene = generate_world("regular?detail=0");
  const CullStats boxes = third_frame(device(), scene, "hroc?leaf=boxes&count=on");
  EXPECT_EQ(boxes.cull_vertices, 324864u);
  EXPECT_EQ(boxes.tested, 9024u);
  EXPECT_EQ(boxes.rays, 0u);  // a box by itself is one object's
  EXPECT_LT(third_frame(device(), scene, "hroc").cull_vertices, boxes.cull_vertices / 4);
}

TEST_F(HrocTest, CountsRaysWhenAsked) {
  Scene scene = generate_world("irregular?spheres=1000&size=60&detail=0");
  const CullStats counted = third_frame(device(), scene, "hroc?count=on");
  EXPECT_GT(counted.rays, 0u);
  EXPECT_GT(counted.nodes_visited, counted.rays);  // a group has two nodes at least below its top
  const CullStats stats = third_frame(device(), scene, "hroc");
  EXPECT_EQ(stats.rays, 0u);
  EXPECT_EQ(stats.nodes_visited, 0u);
}

TEST_F(HrocTest, NoParameterLosesAnything) {
  Scene scene = generate_world("irregular?spheres=1200&size=80&detail=1");
  Examination examination(device(), scene,
                          {"hroc?leaf=boxes", "hroc?most=1", "hroc?most=1000000", "hroc?occluder=0",
                           "hroc?occluder=1e9", "hroc?count=on&contribution=exact"});
  scene::Random random(9);
  Camera camera = camera_at(scene, "near");
  for (int step = 0; step < 8; ++step) {
    camera.eye.z -= 3;
    camera.forward.x += 0.05f;
    camera.orthographic_height = step % 4 == 3 ? 20.0f : 0.0f;
    camera.depth = step < 4 ? Depth::standard : Depth::reversed;
    examination.move(0.1, random);
    examination.look(view_of(camera, 160, 120), "in step " + std::to_string(step));
  }
  EXPECT_GT(examination.visible(), 100u);
}

}  // namespace
}  // namespace sightline
