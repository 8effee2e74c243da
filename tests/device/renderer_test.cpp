#include "workbench/device/renderer.hpp"

#include <cstdlib>
#include <numeric>

#include <sightline/frustum.hpp>

#include "device/fixtures.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/oracle.hpp"

namespace sightline {
namespace {

using RendererTest = DeviceTest;
using ItemBufferTest = DeviceTest;

device::Picture draw_all(device::Renderer& renderer, const View& view) {
  const auto draws = renderer.draws().make_buffers(renderer.device());
  const device::Buffer flags(renderer.device(), renderer.scene().size() * 4, device::Memory::upload, "flags");
  renderer.frame(view, [&](device::Recorder& frame) {
    renderer.draws().build(frame, flags.address(), device::VisibleDraws::kAll, renderer.transparent_order(),
                           draws);
    renderer.draw_solid(frame, draws, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer.draw_rest(frame, draws);
  });
  return renderer.picture();
}

TEST_F(RendererTest, CommandsOfTheCpuDrawTheSamePictureAsCommandsOfTheDevice) {
  const Scene scene = generate_world("forest?trees=300&size=120");
  device::Renderer renderer(device(), scene);
  const View view = view_of(camera_at(scene, "near"));
  const device::Picture expected = draw_all(renderer, view);
  // All objects one by one: opaque in slot order, then transparent as the renderer sorts them.
  std::vector<ObjectId> list;
  for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    for (ObjectId o = 0; o < scene.size(); ++o) {
      if (scene.mesh[o] == mesh && scene.surface[o] == Surface::opaque) list.push_back(o);
    }
  }
  std::vector<std::pair<float, ObjectId>> blended;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    if (scene.surface[o] == Surface::transparent) blended.push_back({scene.sphere(o).centre.z, o});
  }
  std::ranges::sort(blended);
  for (const auto& [z, o] : blended) list.push_back(o);
  std::vector<DrawCommand> draws;
  for (std::uint32_t i = 0; i < list.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.mesh[list[i]]];
    draws.push_back({mesh.index_count, 1, mesh.first_index, static_cast<std::int32_t>(mesh.first_vertex), i});
  }
  renderer.frame(view, [&](device::Recorder& frame) { renderer.draw(frame, list, draws); });
  const device::Picture picture = renderer.picture();
  EXPECT_TRUE(picture == expected);
  renderer.frame(view, [&](device::Recorder& frame) { renderer.draw(frame, list, draws, true); });
  EXPECT_TRUE(renderer.picture() == expected) << "a call a draw";
  EXPECT_TRUE(std::ranges::all_of(picture.pixels, [](auto p) { return p >> 24 == 255; })) << "see-through";
  EXPECT_GT(std::ranges::count_if(picture.pixels, [&](auto p) { return p != picture.pixels[0]; }), 1000);
  if (const char* folder = std::getenv("SIGHTLINE_TEST_PICTURES"))
    device::save_png(picture, std::string(folder) + "/forest.png");
}

// Of lists that follow one another the changed part is sent: longer, shorter, other in the middle, as before.
TEST_F(RendererTest, ListsThatChangeInPartDrawWhatTheyName) {
  const Scene scene = generate_world("regular?columns=8&rows=8&detail=1");
  device::Renderer renderer(device(), scene);
  const View view = view_of(camera_at(scene, "far"));
  const Mesh& mesh = scene.meshes[0];
  const auto picture = [&](device::Renderer& by, std::span<const ObjectId> list) {
    const DrawCommand draw{mesh.index_count, static_cast<std::uint32_t>(list.size()), mesh.first_index,
                           static_cast<std::int32_t>(mesh.first_vertex), 0};
    by.frame(view, [&](device::Recorder& frame) { by.draw(frame, list, {&draw, list.empty() ? 0u : 1u}); });
    return by.picture();
  };
  using List = std::vector<ObjectId>;
  for (const List& list : {List{}, List{1, 2, 3}, List{1, 2, 3, 20, 40}, List{1, 2}, List{1, 9, 3}, List{9},
                           List{}, List{1, 9, 3}, List{60, 61, 62, 63, 5, 6, 7}}) {
    device::Renderer fresh(device(), scene);
    EXPECT_TRUE(picture(renderer, list) == picture(fresh, list)) << list.size();
  }
}

TEST_F(RendererTest, SendsOfAListWhatIsNotTheLastFrames) {
  device::SentList<std::uint32_t> list;
  const auto sent = [&](const std::vector<std::uint32_t>& values) {
    return list.send(device(), values, "a list");
  };
  EXPECT_EQ(sent({1, 2, 3, 4}), 4u);
  EXPECT_EQ(sent({1, 2, 3, 4}), 0u);
  EXPECT_EQ(sent({1, 2, 5, 4}), 2u);
  EXPECT_EQ(sent({1, 2}), 0u);
  EXPECT_EQ(sent({1, 2, 5, 4}), 2u);              // what lies behind a list is nobody's
  EXPECT_EQ(sent({1, 2, 5, 4, 6, 7, 8, 9}), 8u);  // in a larger buffer
  EXPECT_EQ(list.buffer().mapped<std::uint32_t>()[7], 9u);
}

TEST_F(RendererTest, UpIsUpAndNearerHidesFartherWithEitherDepth) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<Vec3> normals(3, Vec3{0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2};
  const std::uint32_t mesh = scene.add_mesh(corners, normals, indices);
  Affine above, before;
  above.rows = {Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 3}, Vec4{0, 0, 1, -10}};
  before.rows = {Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 3}, Vec4{0, 0, 1, -8}};
  scene.add_object(mesh, before);
  scene.add_object(mesh, above);
  device::Renderer renderer(device(), scene);
  oracle::RasterItemBuffer judge(renderer);
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    Camera camera;
    camera.depth = depth;
    const oracle::ItemBuffer items = judge.render(view_of(camera, 64, 64));
    const auto first = std::ranges::find_if(items.ids, [](ObjectId id) { return id != kNoObject; });
    ASSERT_NE(first, items.ids.end());
    EXPECT_LT((first - items.ids.begin()) / 64, 20) << "the triangles stand above the middle";
    EXPECT_EQ(items.ids[64 * 16 + 32], 0u);
  }
}

TEST_F(RendererTest, MovedObjectsAreDrawnWhereTheyStand) {
  Scene scene = generate_world("irregular?spheres=200&size=60&detail=1");
  device::Renderer renderer(device(), scene);
  const View view = view_of(camera_at(scene, "near"));
  std::vector<ObjectId> moved;
  for (ObjectId o = 0; o < scene.size(); o += 3) {
    Affine transform = scene.transform[o];
    transform.rows[0].w += 2;
    scene.move_object(o, transform);
    moved.push_back(o);
  }
  renderer.update(moved);
  device::Renderer fresh(device(), scene);
  EXPECT_TRUE(draw_all(renderer, view) == draw_all(fresh, view));
}

// With a near plane at 1 cm, depth a kilometre away tells apart what lies 6 m from each other, and no less.
TEST_F(ItemBufferTest, CountsNoLossThatDepthOfTooFewDigitsShows) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::uint32_t mesh =
      scene.add_mesh(corners, std::vector<Vec3>(3, Vec3{0, 0, 1}), std::vector<std::uint32_t>{0, 1, 2});
  const auto add = [&](float size, float away) {
    scene.add_object(mesh, Affine{{Vec4{size, 0, 0, 0}, Vec4{0, size, 0, 0}, Vec4{0, 0, 1, -away}}});
  };
  add(200, 1000), add(50, 1000.5f);
  device::Renderer renderer(device(), scene);
  const auto oracle = oracle::make_raster_oracle(renderer);
  const View view = view_of({.near_plane = 0.01f, .far_plane = 5000}, 64, 64);
  EXPECT_TRUE(oracle->look(view).sees(1)) << "depth shows what lies behind";
  Frame frame;
  frame.visible = {0};
  EXPECT_TRUE(oracle->judge(view, {frame}).loss.lost.empty());
  frame.visible = {1};
  const oracle::Loss loss = oracle->judge(view, {frame}).loss;
  EXPECT_EQ(loss.lost, std::vector<ObjectId>{0});
  EXPECT_GT(loss.lost_pixels, 100u);
}

// With a near plane at 1 cm, depth in single precision ends some 2 km before or after a far plane at 18 km.
TEST_F(ItemBufferTest, ShowsNothingBeyondTheFarPlane) {
  Scene scene;
  const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::uint32_t mesh =
      scene.add_mesh(corners, std::vector<Vec3>(3, Vec3{0, 0, 1}), std::vector<std::uint32_t>{0, 1, 2});
  constexpr int kAcross = 20;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const float away = 15000 + 15 * static_cast<float>(i), size = away * 0.02f;
    const float x = away * 0.05f * (static_cast<float>(i % kAcross) - kAcross / 2),
                y = away * 0.05f * (static_cast<float>(i) / kAcross - kAcross / 2);
    scene.add_object(mesh, Affine{{Vec4{size, 0, 0, x}, Vec4{0, size, 0, y}, Vec4{0, 0, 1, -away}}});
  }
  device::Renderer renderer(device(), scene);
  oracle::RasterItemBuffer judge(renderer);
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    const Camera camera{.near_plane = 0.01f, .far_plane = 18000, .depth = depth};
    const View view = view_of(camera, 512, 512);
    const oracle::ItemBuffer items = judge.render(view);
    const Frustum frustum = make_frustum(view);
    int seen = 0, beyond = 0;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      seen += items.sees(o);
      beyond += items.sees(o) && !overlaps(frustum, scene.bounds[o]);
    }
    EXPECT_EQ(beyond, 0);
    EXPECT_GT(seen, depth == Depth::reversed ? 180 : 50);
  }
}

TEST_F(ItemBufferTest, AgreesWithRaysThroughPixelCentresButForSilhouettes) {
  std::uint64_t pixels = 0, different = 0, objects = 0, disputed = 0;
  for (const char* world : {"regular?columns=12&rows=12&detail=2", "irregular?spheres=400&size=60&detail=2",
                            "forest?trees=300&size=120"}) {
    const Scene scene = generate_world(world);
    device::Renderer renderer(device(), scene);
    oracle::RasterItemBuffer pass(renderer);
    const oracle::EmbreeJudge embree(scene);
    for (const Camera& camera : camera::random_cameras(scene, 12, 5)) {
      const View view = view_of(camera, 160, 120);
      const oracle::ItemBuffer ours = pass.render(view);
      const oracle::ItemBuffer rays = embree.render(view);
      std::uint64_t here = 0;
      for (std::size_t i = 0; i < ours.ids.size(); ++i) here += ours.ids[i] != rays.ids[i];
      different += here;
      pixels += ours.ids.size();
      for (ObjectId o = 0; o < scene.size(); ++o) {
        objects += rays.sees(o);
        disputed += (ours.sees(o)) != rays.sees(o);
      }
    }
  }
  RecordProperty("different_pixels", static_cast<int>(different));
  RecordProperty("disputed_objects", static_cast<int>(disputed));
  std::printf("%llu of %llu pixels, %llu of %llu objects differ\n",
              static_cast<unsigned long long>(different), static_cast<unsigned long long>(pixels),
              static_cast<unsigned long long>(disputed), static_cast<unsigned long long>(objects));
  EXPECT_LT(different * 1000, pixels);
  EXPECT_LT(disputed * 100, objects);
}

}  // namespace
}  // namespace sightline
