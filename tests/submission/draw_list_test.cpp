#include "workbench/submission/draw_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include <sightline/workbench/worlds.hpp>

namespace sightline::submission {
namespace {

float depth_of(const Scene& scene, const View& view, ObjectId id) {
  const Vec3 eye = eye_position(view), forward = view_direction(view), at = scene.sphere(id).centre;
  return (at.x - eye.x) * forward.x + (at.y - eye.y) * forward.y + (at.z - eye.z) * forward.z;
}

TEST(DrawList, DrawsEachVisibleObjectOnceInTheOrderOfAFrame) {
  const Scene scene = generate_world("forest?trees=3000");
  const View view = *make_view({.eye = {10, 8.9f, -20}, .forward = {0.3f, 0, 1}}, 640, 360);
  Frame frame;
  for (ObjectId id = 0; id < scene.size(); id += 2) frame.visible.push_back(id);
  const std::vector<ObjectId> asked = frame.visible;
  DrawList(scene).build(scene, view, frame);

  std::vector<ObjectId> drawn = frame.visible;
  std::sort(drawn.begin(), drawn.end());
  EXPECT_EQ(drawn, asked);

  std::uint32_t next = 0;
  bool blending = false;
  float last_blended = std::numeric_limits<float>::infinity();
  std::uint64_t triangles = 0;
  for (const DrawCommand& draw : frame.draws) {
    ASSERT_EQ(draw.first_instance, next);
    float last_opaque = -std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 0; i < draw.instance_count; ++i) {
      const ObjectId id = frame.visible[next++];
      const Mesh& mesh = scene.meshes[scene.mesh[id]];
      ASSERT_EQ(draw.first_index, mesh.first_index);
      ASSERT_EQ(draw.index_count, mesh.index_count);
      const bool blended = scene.surface[id] == Surface::transparent;
      ASSERT_GE(blended, blending) << "an opaque object behind a transparent one";
      blending = blended;
      const float depth = depth_of(scene, view, id);
      if (blended) {
        ASSERT_LE(depth, last_blended + 1e-3f);
        last_blended = depth;
      } else {
        ASSERT_GE(depth, last_opaque - 1e-3f);
        last_opaque = depth;
      }
      triangles += scene.triangles(id);
    }
  }
  EXPECT_EQ(next, frame.visible.size());
  EXPECT_TRUE(blending);
  EXPECT_EQ(frame.stats.triangles, triangles);
  EXPECT_EQ(frame.stats.draw_calls, frame.draws.size());
}

TEST(DrawList, OneCallAMeshForOpaqueThings) {
  const Scene scene = generate_world("regular?columns=10&rows=10&detail=0");
  Frame frame;
  frame.visible.resize(100);
  std::iota(frame.visible.begin(), frame.visible.end(), ObjectId{0});
  DrawList(scene).build(scene, *make_view({.eye = {0, 1, 50}}, 64, 64), frame);
  ASSERT_EQ(frame.draws.size(), 1u);
  EXPECT_EQ(frame.draws[0].instance_count, 100u);
  EXPECT_EQ(frame.stats.triangles, 2000u);
}

TEST(DrawList, NothingVisibleDrawsNothing) {
  const Scene scene = generate_world("regular?columns=2&rows=2&detail=0");
  Frame frame;
  DrawList(scene).build(scene, *make_view({}, 64, 64), frame);
  EXPECT_TRUE(frame.draws.empty());
}

}  // namespace
}  // namespace sightline::submission
