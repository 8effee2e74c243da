// cull() allocates nothing once it has grown: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include <sightline/instances.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/ranges.hpp>
#include <sightline/shadows.hpp>
#include <sightline/world.hpp>

#include "support/solid_boxes.hpp"
#include "workbench/scene/random.hpp"

// ThreadSanitizer brings its own operators, which cannot be replaced.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SIGHTLINE_TSAN
#endif
#endif

#ifndef SIGHTLINE_TSAN
namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)) return p;
  std::abort();
}

// Never inlined: beside the operator new that the compiler knows, free() looks like a mistake to g++.
[[gnu::noinline]] void give_back(void* p) {
  std::free(p);
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted(size, alignof(std::max_align_t));
}
void operator delete(void* p, const std::nothrow_t&) noexcept {
  give_back(p);
}
void operator delete(void* p) noexcept {
  give_back(p);
}
void operator delete(void* p, std::size_t) noexcept {
  give_back(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  give_back(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  give_back(p);
}

namespace sightline {
namespace {

void run_here(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  for (std::uint32_t i = 0; i < count; ++i) job(data, i);
}

std::vector<Box> metre_boxes(scene::Random& random) {
  std::vector<Box> boxes(20000);
  for (Box& b : boxes) {
    const Vec3 at = random.inside({{-500, 0, -500}, {500, 30, 500}});
    b = {at, {at.x + 1, at.y + 1, at.z + 1}};
  }
  return boxes;
}

TEST(Allocation, CullAllocatesNothingOnceWarm) {
  scene::Random random(1);
  World world;
  std::vector<WorldBox> boxes(20000);
  std::vector<Box> occluders;
  for (WorldBox& b : boxes) {
    const Vec3 at = random.inside({{-3000, 0, -3000}, {3000, 30, 3000}});
    b = {{at.x - 1.0, at.y - 1.0, at.z - 1.0}, {at.x + 1.0, at.y + 1.0, at.z + 1.0}};
    if (occluders.size() < 200) occluders.push_back({{at.x - 20, 0, at.z - 20}, {at.x + 20, 50, at.z + 20}});
  }
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  Culler culler;
  OcclusionBuffer buffer;
  const CullOptions options{.jobs = {run_here, nullptr, 4}};
  const std::array sizes{100.0f, 20.0f, 5.0f};
  const std::vector<LevelTableId> tables(boxes.size(), *world.add_levels(sizes));
  ASSERT_TRUE(world.set_levels(handles, std::span<const LevelTableId>(tables)));
  const std::vector<std::uint32_t> layers(500, 4);
  ASSERT_TRUE(world.set_layers(std::span(handles).first(500), layers));
  std::vector<ObjectId> visible(cull_capacity(world, options));
  std::vector<std::uint8_t> masks(visible.size()), levels(visible.size());
  std::size_t warm = 0, kept = 0;
  for (int frame = 0; frame < 40; ++frame) {
    // The first frame sees everything: nothing after it can need more room.
    Camera camera;
    camera.eye =
        frame == 0 ? Vec3{0, 9000, 0.1f} : Vec3{random.between(-2000, 2000), 5, random.between(-2000, 2000)};
    camera.forward = frame == 0 ? Vec3{0, -1, -0.001f} : random.direction();
    camera.far_plane = 20000;
    const View view = *make_view(camera, 640, 480);
    const std::array views{CullView{.view = {view, {}}, .occlusion = &buffer, .min_area = 1},
                           CullView{.view = {view, {10, 0, 0}}, .layers = 3}};
    if (frame == 1) warm = allocations;
    ASSERT_TRUE(buffer.begin(views[0].view));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    kept += culler.cull(world, views, options, {visible, masks, levels, {}})->count;
    kept += culler.cull(world, views, options, {visible})->count;
    kept += culler.cull(world, views[0], visible)->count;
  }
  EXPECT_EQ(allocations - warm, 0u);
  EXPECT_GT(kept, 1000u);
}

TEST(Allocation, CullingInstancesAllocatesNothingOnceWarm) {
  scene::Random random(6);
  World world;
  std::vector<Box> boxes;
  for (int i = 0; i < 3000; ++i)
    boxes.push_back(test::box_at({random.between(-90, 90), 5, random.between(-90, 90)}, {1, 1, 1}));
  std::vector<Handle> objects(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), objects));
  const std::array sizes{100.0f, 20.0f};
  const std::vector<LevelTableId> tables(boxes.size(), *world.add_levels(sizes));
  ASSERT_TRUE(world.set_levels(objects, std::span<const LevelTableId>(tables)));
  Instances instances;
  const PlacedWorldId name = *instances.add_world(world);
  std::vector<InstancePlacement> placements(100, {name, {}, {}});
  for (InstancePlacement& p : placements)
    p.origin = {random.between(-1500, 1500), 0, random.between(-1500, 1500)};
  std::vector<Handle> handles(placements.size());
  ASSERT_TRUE(instances.insert(placements, handles));
  InstanceCuller culler;
  std::size_t warm = 0;
  std::uint64_t seen = 0;
  for (int frame = 0; frame < 40; ++frame) {
    // The first frame sees everything.
    const Vec3 eye = frame == 0 ? Vec3{0, 9000, 0.1f} : Vec3{random.between(-2000, 2000), 5, 0};
    Camera camera{.eye = eye, .forward = frame == 0 ? Vec3{0, -1, -0.001f} : random.direction()};
    camera.far_plane = 20000;
    const CullView view{.view = {*make_view(camera, 640, 480), {}}, .min_area = 0.001f};
    const std::array views{view, CullView{.view = view.view}};
    if (frame == 1) warm = allocations;
    const InstanceCullOptions options{.jobs = {run_here, nullptr, 4}, .masks = true, .levels = true};
    seen += culler.cull(instances, views, options)->objects;
    seen += culler.cull(instances, view)->objects;
    seen += culler.cull(instances, views[1])->objects;
  }
  EXPECT_EQ(allocations - warm, 0u);
  EXPECT_GT(seen, 1000u);
}

TEST(Allocation, ShadowCastersAllocateNothingOnceWarm) {
  scene::Random random(5);
  std::vector<Box> boxes{{{-3000, -1, -3000}, {3000, 0, 3000}}};
  for (int i = 0; i < 20000; ++i)
    boxes.push_back(test::box_at({random.between(-3000, 3000), 5, random.between(-3000, 3000)}, {2, 5, 2}));
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  Culler culler;
  OcclusionBuffer depth;
  ShadowCasters casters;
  std::vector<ObjectId> ids(cull_capacity(world)), shadows(ids.size());
  std::size_t warm = 0, cast = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const Vec3 eye{random.between(-2000, 2000), 3, random.between(-2000, 2000)};
    const WorldView camera{test::looking(eye, {random.between(-1, 1), 0, -1}), {}};
    const WorldView map = *shadow_view({.direction = {1, -1, 1}}, camera, {0.1f, 300}, 1024);
    if (frame == 3) warm = allocations;
    ASSERT_TRUE(depth.begin(camera));
    ASSERT_TRUE(depth.draw_boxes(BoxView(std::span(boxes).first(500))));
    const CullView seen{.view = camera, .occlusion = &depth}, lit{.view = map, .casters = &casters};
    const std::size_t count = culler.cull(world, seen, ids)->count;
    ASSERT_TRUE(casters.begin(map, camera, {0.1f, 300}));
    ASSERT_TRUE(casters.receive(world, std::span(ids).first(count), &depth));
    cast += culler.cull(world, lit, shadows)->count;
  }
  EXPECT_EQ(allocations - warm, 0u);
  EXPECT_GT(cast, 20u);
}

TEST(Allocation, OcclusionInOneCallAllocatesNothingOnceWarm) {
  scene::Random random(3);
  std::vector<Box> boxes;
  for (int i = 0; i < 6000; ++i) {
    const Vec3 half{random.between(0.2f, 3), random.between(0.2f, 20), random.between(0.2f, 3)};
    boxes.push_back(test::box_at({random.between(-300, 300), half.y, random.between(-300, 300)}, half));
  }
  test::SolidBoxes scene(std::move(boxes));
  // Half of them by triangles, and with triangles to be asked for.
  Occluder quad;
  quad.positions = {{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}},
  quad.indices = {0, 1, 2, 0, 2, 3};
  const OccluderId flat = *scene.world.add_occluder(quad);
  for (std::size_t i = 0; i < scene.boxes.size(); i += 2) {
    const std::array placement{test::filling(scene.boxes[i], flat)};
    const std::array<Vec3, 3> triangle{scene.boxes[i].min, scene.boxes[i].max, scene.boxes[i].min};
    ASSERT_TRUE(scene.world.set_occluders(std::span(scene.handles).subspan(i, 1), placement));
    ASSERT_TRUE(scene.world.set_triangles(scene.handles[i], triangle));
  }
  Culler culler;
  CullOptions options = test::automatic(50000);
  options.jobs = {run_here, nullptr, 4};
  std::vector<ObjectId> visible(cull_capacity(scene.world, options));
  std::size_t warm = 0, dropped = 0;
  for (int frame = 0; frame < 60; ++frame) {
    // The first frames see everything.
    const bool above = frame < 3;
    const Vec3 eye = above ? Vec3{0, 900, 0.1f} : Vec3{3.0f * static_cast<float>(frame) - 100, 2, 0};
    const CullView view{.view = {test::looking(eye, above ? Vec3{0, -1, -0.001f} : Vec3{1, 0, 0.2f}), {}}};
    if (frame == 5) warm = allocations;
    const Result<CullResult> result = culler.cull(scene.world, {&view, 1}, options, {visible});
    ASSERT_TRUE(result);
    if (frame >= 5) dropped += result->culled_occlusion;
  }
  EXPECT_EQ(allocations - warm, 0u);
  EXPECT_GT(dropped, 1000u);
}

TEST(Allocation, RangesAndReportsAllocateNothingOnceWarm) {
  scene::Random random(5);
  World world;
  std::vector<Box> boxes = metre_boxes(random);
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  ObjectOrder order;
  RangeCuller culler;
  std::size_t warm = 0, seen = 0, reported = 0;
  for (int frame = 0; frame < 500; ++frame) {
    if (frame == 300) warm = allocations;
    // To and fro, so that the same is seen and reported again and again.
    const float by = frame % 2 == 0 ? 30.0f : -30.0f;
    for (std::size_t i = 0; i < 200; ++i) boxes[i].min.x += by, boxes[i].max.x += by;
    ASSERT_TRUE(world.move(std::span(handles).first(200), BoxView(std::span(boxes).first(200))));
    const auto report = order.update(world);
    ASSERT_TRUE(report);
    reported += report->size();
    const float turn = 0.1f * static_cast<float>(frame % 60);
    const CullView view{.view = {test::looking({0, 10, 0}, {std::sin(turn), 0, std::cos(turn)}), {}}};
    const auto result =
        culler.cull(world, order, {&view, 1}, {.jobs = {run_here, nullptr, 4}, .masks = frame % 3 == 0});
    ASSERT_TRUE(result);
    seen += result->objects;
  }
  EXPECT_EQ(allocations - warm, 0u);
  EXPECT_GT(seen, 100'000u);
  EXPECT_GT(reported, boxes.size());
}

TEST(Allocation, MovingTheSameObjectsAllocatesNothingOnceWarm) {
  scene::Random random(2);
  World world;
  std::vector<Box> boxes = metre_boxes(random);
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  const CullView view{.view = {*make_view({}, 64, 64), {}}};
  std::vector<ObjectId> visible(cull_capacity(world));
  Culler culler;
  std::size_t warm = 0;
  for (int frame = 0; frame < 700; ++frame) {
    if (frame == 400) warm = allocations;
    for (std::size_t i = 0; i < 500; ++i) {
      const float by = random.between(-1, 1);
      boxes[i].min.x += by, boxes[i].max.x += by;
    }
    ASSERT_TRUE(world.move(std::span(handles).first(500), BoxView(std::span(boxes).first(500))));
    EXPECT_TRUE(culler.cull(world, view, visible));
  }
  EXPECT_EQ(allocations - warm, 0u);
}

}  // namespace
}  // namespace sightline
#endif
