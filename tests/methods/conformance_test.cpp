// What every method of the registry keeps to, whatever it is: a new one is tested the day it is added.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/random_views.hpp"
#include "support/refusal.hpp"

namespace sightline {
namespace {

using testing::HasSubstr;

constexpr Box kAround{{-60, -5, -60}, {60, 30, 60}};

// Draws are ranges of the method's own triangles, and the visible objects are those of the triangles drawn.
void expect_sound_ranges(const TriangleGeometry& geometry, const Frame& frame,
                         const std::set<ObjectId>& visible, std::string_view name) {
  std::set<ObjectId> drawn;
  std::uint64_t triangles = 0;
  for (const DrawCommand& draw : frame.draws) {
    ASSERT_EQ(draw.instance_count, 1u) << name;
    ASSERT_EQ(draw.first_index, 3 * draw.first_instance) << name;
    ASSERT_LE(std::size_t{draw.first_index} + draw.index_count, geometry.indices.size()) << name;
    const auto objects = geometry.objects.subspan(draw.first_instance, draw.index_count / 3);
    drawn.insert(objects.begin(), objects.end());
    triangles += objects.size();
  }
  ASSERT_EQ(drawn, visible) << name;
  ASSERT_EQ(triangles, frame.stats.triangles) << name;
}

void expect_sound(const Scene& scene, const Frame& frame, const TriangleGeometry* geometry,
                  std::string_view name) {
  const std::set<ObjectId> unique(frame.visible.begin(), frame.visible.end());
  ASSERT_EQ(unique.size(), frame.visible.size()) << name << " draws an object twice";
  if (!unique.empty()) ASSERT_LT(*unique.rbegin(), scene.size()) << name;
  if (geometry) {
    expect_sound_ranges(*geometry, frame, unique, name);
  } else {
    std::uint64_t drawn = 0;
    for (const DrawCommand& draw : frame.draws) {
      ASSERT_EQ(draw.first_instance, drawn) << name;
      drawn += draw.instance_count;
    }
    ASSERT_EQ(drawn, frame.visible.size()) << name;
  }
  ASSERT_EQ(frame.stats.objects, scene.size()) << name;
  if (geometry && geometry->submission == Submission::multi_draw) {
    ASSERT_LE(frame.stats.draw_calls, 2u) << name;  // opaque ranges, transparent ranges
    ASSERT_EQ(frame.stats.draw_calls == 0, frame.draws.empty()) << name;
  } else {
    ASSERT_EQ(frame.stats.draw_calls, frame.draws.size()) << name;
  }
  const CullStats& s = frame.stats;
  ASSERT_EQ(
      s.culled_frustum + s.culled_contribution + s.culled_facing + s.culled_occlusion + frame.visible.size(),
      scene.size())
      << name;
}

class Conformance : public testing::TestWithParam<std::string> {};

TEST_P(Conformance, EveryMethodIsSoundAndRepeatable) {
  const Scene scene = generate_world(GetParam());
  for (const MethodInfo& info : all_methods()) {
    if (!info.cpu.suits(scene)) continue;
    const auto method = create_method(info.name, scene), twin = create_method(info.name, scene);
    scene::Random random(11);
    Frame frame, again;
    for (int v = 0; v < 50; ++v) {
      const View view = test::random_view(random, kAround);
      cull(*method, view, frame);
      expect_sound(scene, frame, method->geometry(), info.name);
      cull(*twin, view, again);
      ASSERT_EQ(frame.visible, again.visible) << info.name;
    }
  }
}

// Conservative and exact methods keep every object with a vertex inside the clip volume that no other hides;
// verification does the hiding, this only what needs no picture: a lone object in view is always
// kept.
TEST_P(Conformance, ALoneObjectInViewIsKept) {
  Scene all = generate_world(GetParam());
  scene::Random random(12);
  for (const MethodInfo& info : all_methods()) {
    if (!info.cpu.suits(all) || info.cpu.guarantee == Guarantee::approximate) continue;
    for (int v = 0; v < 20; ++v) {
      Scene lone;
      const Mesh& mesh = all.meshes[0];
      lone.add_mesh(std::span(all.positions).subspan(mesh.first_vertex, mesh.vertex_count),
                    std::span(all.normals).subspan(mesh.first_vertex, mesh.vertex_count),
                    std::span(all.indices).subspan(mesh.first_index, mesh.index_count));
      const Vec3 eye = random.inside(kAround), way = random.direction();
      const float distance = random.between(5, 60);
      Affine transform;
      transform.rows[0].w = eye.x + way.x * distance;
      transform.rows[1].w = eye.y + way.y * distance;
      transform.rows[2].w = eye.z + way.z * distance;
      lone.add_object(0, transform);
      const Vec3 centre = lone.sphere(0).centre;
      Camera camera{.eye = eye, .forward = {centre.x - eye.x, centre.y - eye.y, centre.z - eye.z}};
      if (std::fabs(way.y) > 0.9f) camera.up = {1, 0, 0};
      Frame frame;
      cull(*create_method(info.name, lone), *make_view(camera, 640, 360), frame);
      ASSERT_EQ(frame.visible.size(), 1u) << info.name;
    }
  }
}

TEST_P(Conformance, MovedObjectsAreFollowed) {
  for (const MethodInfo& info : all_methods()) {
    Scene scene = generate_world(GetParam());
    // "adaptive" picks its structure when it is made, and "world" its occluders among what it saw, so that a
    // fresh one may keep another set; see their own tests.
    if (!info.cpu.suits(scene) || info.name == "adaptive" || info.name == "world") continue;
    const auto method = create_method(info.name, scene);
    scene::Random random(13);
    for (int step = 0; step < 10; ++step) {
      std::vector<ObjectId> moved;
      for (int i = 0; i < 30; ++i) {
        const ObjectId object = random.below(static_cast<std::uint32_t>(scene.size()));
        Affine transform = scene.transform[object];
        const Vec3 to = random.inside(kAround);
        transform.rows[0].w = to.x, transform.rows[1].w = to.y, transform.rows[2].w = to.z;
        scene.move_object(object, transform);
        moved.push_back(object);
      }
      // Cells of triangles are built anew only once many objects have moved; until then what they keep
      // depends on their history. See the methods' own tests for that.
      for (ObjectId object = 0; method->geometry() && object < scene.size(); ++object)
        moved.push_back(object);
      method->update(moved);
      const auto fresh = create_method(info.name, scene);
      const View view = test::random_view(random, kAround);
      Frame frame, expected;
      cull(*method, view, frame);
      cull(*fresh, view, expected);
      std::sort(frame.visible.begin(), frame.visible.end());
      std::sort(expected.visible.begin(), expected.visible.end());
      ASSERT_EQ(frame.visible, expected.visible) << info.name;
    }
  }
}

// Refusals must name what is wrong; what is refused changes nothing.
void expect_refusals(Method& method, Scene& scene, std::string_view name) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  scene::Random random(14);
  const View view = test::random_view(random, kAround);
  Frame before, after;
  cull(method, view, before);
  for (const auto spoil :
       {+[](View& v) { v.world_to_eye.m[12] = kNaN; }, +[](View& v) { v.eye_to_clip = {{}}; },
        +[](View& v) { v.width = 0; }, +[](View& v) { v.height = 1u << 20; }}) {
    View bad = view;
    spoil(bad);
    EXPECT_NE(test::refusal([&] { cull(method, bad, after); }), "") << name;
  }
  const ObjectId beyond[]{static_cast<ObjectId>(scene.size())};
  EXPECT_THAT(test::refusal([&] { method.update(beyond); }), HasSubstr("no such object")) << name;
  const Affine home = scene.transform[3];
  scene.move_object(3, {{Vec4{1, 0, 0, kNaN}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  const ObjectId third[]{3};
  EXPECT_THAT(test::refusal([&] { method.update(third); }), HasSubstr("object 3")) << name;
  scene.move_object(3, home);
  cull(method, view, after);
  EXPECT_EQ(before.visible, after.visible) << name;
}

void expect_refusal_of_a_grown_scene(Method& method, std::string_view name) {
  const ObjectId first[]{0};
  Frame frame;
  scene::Random random(15);
  const View view = test::random_view(random, kAround);
  EXPECT_THAT(test::refusal([&] { method.update(first); }), HasSubstr("make it anew")) << name;
  EXPECT_THAT(test::refusal([&] { cull(method, view, frame); }), HasSubstr("make it anew")) << name;
}

// A world with all that some method needs.
Scene fit_for_all() {
  Scene scene = generate_world("soup?triangles=1000&per-object=50&size=60");
  const auto objects = static_cast<std::uint32_t>(scene.size());
  LevelPvs& level = scene.level.emplace();
  level.leaf_objects.resize(objects);
  std::iota(level.leaf_objects.begin(), level.leaf_objects.end(), 0u);
  level.leaves = {{0, extent(scene), 0, objects}};
  level.in_some_leaf.assign(objects, 1), level.in_world_model.assign(objects, 1);
  CellPvs cells;
  cells.bounds = extent(scene), cells.counts = {1, 1, 1}, cells.objects = objects;
  cells.open = {1}, cells.first = {0, objects}, cells.visible = level.leaf_objects;
  scene.cells = std::make_shared<CellPvs>(cells);
  return scene;
}

TEST(Contract, EveryMethodRefusesWhatItCannotWorkWith) {
  for (const MethodInfo& info : all_methods()) {
    if (!info.cpu.exists()) continue;
    Scene scene = fit_for_all();
    ASSERT_TRUE(info.cpu.suits(scene)) << info.name;
    const auto method = create_method(info.name, scene);
    expect_refusals(*method, scene, info.name);
    Scene with_object = fit_for_all(), with_mesh = fit_for_all();
    const auto second = create_method(info.name, with_object), third = create_method(info.name, with_mesh);
    with_object.add_object(0, {});
    expect_refusal_of_a_grown_scene(*second, info.name);
    with_mesh.add_mesh(with_mesh.positions, {}, with_mesh.indices);
    expect_refusal_of_a_grown_scene(*third, info.name);
    // Made anew it knows all of them.
    with_object.level.reset(), with_object.cells.reset();
    if (!info.cpu.suits(with_object)) continue;
    Frame frame;
    cull(*create_method(info.name, with_object), *make_view({.eye = {0, 0, 100}}, 64, 64), frame);
    EXPECT_EQ(frame.stats.objects, with_object.size()) << info.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, Conformance,
                         testing::Values("regular?columns=20&rows=20&detail=0",
                                         "irregular?spheres=500&size=120&detail=0",
                                         "forest?trees=500&size=120", "soup?triangles=3000&size=100"),
                         [](const auto& info) { return info.param.substr(0, info.param.find('?')); });

}  // namespace
}  // namespace sightline
