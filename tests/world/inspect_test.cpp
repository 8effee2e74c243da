// What an inspection says beside culls that have one test more each, and its shapes beside what was culled.
#include <sightline/inspect.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "library/geometry/linear.hpp"
#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/rounds.hpp"
#include "support/solid_boxes.hpp"

namespace sightline {
namespace {

using scene::Random;

constexpr Box kInspected{{-300, -40, -300}, {300, 40, 300}};

// Worlds of the same objects with a column more each.
struct Columned {
  World plain, layered, all;
  std::size_t count = 0;

  // Many are small, so that some of their chunks lie wholly in view, or behind something.
  explicit Columned(Random& random, bool many = false) : count(many ? 4000 : 50 + random.below(600)) {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> layers;
    std::vector<DistanceRange> distances;
    for (std::size_t i = 0; i < count; ++i) {
      boxes.push_back(test::random_box(random, kInspected));
      if (many) boxes[i].max = {boxes[i].min.x + 1, boxes[i].min.y + 1, boxes[i].min.z + 1};
      if (random.below(20) == 0) boxes[i].min.x -= 3200, boxes[i].max.x -= 3200;
      const bool own = random.below(30) == 0;
      layers.push_back(own ? 1 + random.below(15) : boxes[i].min.x > 0 ? 3 : 12);
      distances.push_back({0, own ? random.between(0, 300) : boxes[i].min.z > 0 ? 200.0f : 500.0f});
    }
    std::vector<Handle> handles(count);
    EXPECT_TRUE(plain.insert(BoxView(boxes), handles));
    EXPECT_TRUE(layered.insert(BoxView(boxes), handles, {.layers = std::span<const std::uint32_t>(layers)}));
    EXPECT_TRUE(all.insert(BoxView(boxes), handles,
                           {.layers = std::span<const std::uint32_t>(layers),
                            .distances = std::span<const DistanceRange>(distances)}));
    // Holes and movers.
    for (World* world : {&plain, &layered, &all})
      EXPECT_TRUE(world->move(std::span(handles).first(count / 20), BoxView(boxes).part(0, count / 20)));
  }
};

std::uint64_t written_for(const World& world, const CullView& view, std::uint64_t* tested = nullptr) {
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  const CullResult result = test::cull(culler, world, {&view, 1}, ids);
  if (tested) *tested = result.tested;
  return result.count;
}

TEST(Inspector, CountsWhatEachTestDropsInAThousandRandomViews) {
  CullInspector inspector;
  ViewStats sum;
  for (std::uint32_t seed = 0; seed < test::rounds(350); ++seed) {
    Random random(seed);
    const Columned worlds(random, seed % 10 == 0);
    std::vector<CullView> views;
    OcclusionBuffer buffer;
    for (std::uint32_t v = 0; v < 3; ++v) {
      CullView view{.view = {test::random_view(random, kInspected), {}}};
      if (v == 1 && random.below(3) == 0) view.view = views[0].view;
      if (random.below(2)) view.layers = random.below(16);
      if (random.below(4) == 0) view.min_area = random.between(0.1f, 80);
      views.push_back(view);
    }
    ASSERT_TRUE(buffer.begin(views[2].view, {Coverage::centres}));
    const Box wall{{-60, -40, -3}, {60, 40, 3}};
    ASSERT_TRUE(buffer.draw_boxes(BoxView(std::span(&wall, 1))));
    views[2].occlusion = &buffer;
    const auto looked = inspector.inspect(worlds.all, views);
    ASSERT_TRUE(looked) << looked.error().message();
    ASSERT_EQ(looked->views.size(), views.size());
    std::uint64_t in_sectors = 0;
    for (const DebugBox& box : looked->boxes)
      in_sectors += box.kind == DebugBoxKind::sector ? box.objects : 0;
    ASSERT_EQ(in_sectors, worlds.count);
    for (std::size_t v = 0; v < views.size(); ++v) {
      const ViewStats& s = looked->views[v];
      ASSERT_EQ(s.chunks,
                s.chunks_outside + s.chunks_dropped + s.chunks_hidden + s.chunks_whole + s.chunks_opened);
      ASSERT_EQ(s.objects,
                s.outside + s.by_layers + s.by_distances + s.by_casters + s.by_area + s.hidden + s.visible);
      CullView view = views[v];
      std::uint64_t tested = 0;
      ASSERT_EQ(s.visible, written_for(worlds.all, view, &tested)) << "seed " << seed << " view " << v;
      ASSERT_EQ(s.objects_tested, tested);
      view.occlusion = nullptr;
      const std::uint64_t unhidden = written_for(worlds.all, view);
      ASSERT_EQ(s.hidden, unhidden - s.visible);
      view.min_area = 0;
      const std::uint64_t of_any_size = written_for(worlds.all, view),
                          at_any_distance = written_for(worlds.layered, view);
      ASSERT_EQ(s.by_area, of_any_size - unhidden);
      ASSERT_EQ(s.by_distances, at_any_distance - of_any_size);
      if (view.layers != 0) ASSERT_EQ(s.by_layers, written_for(worlds.plain, view) - at_any_distance);
      ASSERT_EQ(s.by_casters, 0u);
      sum.by_layers += s.by_layers, sum.by_distances += s.by_distances, sum.by_area += s.by_area;
      sum.hidden += s.hidden, sum.outside += s.outside, sum.chunks_whole += s.chunks_whole;
      sum.chunks_dropped += s.chunks_dropped, sum.chunks_hidden += s.chunks_hidden;
      sum.sectors += s.sectors, sum.sectors_in_view += s.sectors_in_view;
    }
  }
  for (const std::uint64_t some : {sum.by_layers, sum.by_distances, sum.by_area, sum.hidden, sum.outside,
                                   sum.chunks_whole, sum.chunks_dropped})
    EXPECT_GT(some, 0u);
  EXPECT_GT(sum.chunks_hidden, 0u);
  EXPECT_GT(sum.sectors, sum.sectors_in_view);
}

TEST(Inspector, CountsWhatCastsNoShadowThatIsSeen) {
  Random random(2);
  std::vector<Box> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(test::random_box(random, kInspected));
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  const WorldView camera{test::looking({0, 5, 0}, {0, 0, -1}), {}},
      light{test::looking({0, 200, 0}, {0.1f, -1, 0}), {}};
  ShadowCasters casters;
  ASSERT_TRUE(casters.begin(light, camera, {0.1f, 100}));
  CullView view{.view = light, .casters = &casters};
  CullInspector inspector;
  const auto looked = inspector.inspect(world, {&view, 1});
  ASSERT_TRUE(looked);
  const std::uint64_t cast = written_for(world, view);
  EXPECT_EQ(looked->views[0].visible, cast);
  view.casters = nullptr;
  EXPECT_EQ(looked->views[0].by_casters, written_for(world, view) - cast);
  EXPECT_GT(looked->views[0].by_casters, 100u);
}

TEST(Inspector, ShapesHoldWhatWasCulled) {
  Random random(3);
  const Columned worlds(random, true);
  const std::array views{CullView{.view = {test::looking({0, 5, 250}, {0, 0, -1}), {}}},
                         CullView{.view = {test::looking({0, 5, 250}, {1, 0, 0}), {}}, .layers = 3}};
  CullInspector inspector;
  const auto looked = inspector.inspect(worlds.all, views);
  ASSERT_TRUE(looked);
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(worlds.all));
  std::vector<std::uint8_t> masks(ids.size());
  const std::size_t count = test::cull(culler, worlds.all, views, ids, masks).count;
  ASSERT_GT(count, 20u);
  const auto holds = [](const WorldBox& outer, const WorldBox& inner) {
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const WorldBox box = worlds.all.box(worlds.all.handle(ids[i]));
    for (const DebugBoxKind kind : {DebugBoxKind::sector, DebugBoxKind::chunk})
      ASSERT_TRUE(std::ranges::any_of(looked->boxes, [&](const DebugBox& b) {
        return b.kind == kind && (b.seen & masks[i]) == masks[i] && holds(b.box, box);
      }));
  }
  std::array<std::uint64_t, 2> whole{};
  for (const DebugBox& b : looked->boxes) {
    ASSERT_EQ(b.whole & ~b.seen, 0);
    for (std::size_t v = 0; v < 2; ++v) whole[v] += b.kind == DebugBoxKind::chunk && (b.whole >> v & 1);
  }
  for (std::size_t v = 0; v < 2; ++v) EXPECT_EQ(whole[v], looked->views[v].chunks_whole);
  EXPECT_GT(whole[0] + whole[1], 0u);
}

TEST(Inspector, ShowsWhatAutomaticOcclusionDrew) {
  std::vector<Box> boxes{{{-20, 0, -12}, {20, 30, -10}}};
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 at = random.inside({{-100, 0, -200}, {100, 10, -20}});
    boxes.push_back({at, {at.x + 1, at.y + 1, at.z + 1}});
  }
  test::SolidBoxes scene(std::move(boxes));
  const CullView view{.view = {test::looking({0, 5, 0}, {0, 0, -1}), {}}};
  Culler culler;
  CullInspector inspector;
  std::vector<std::uint8_t> picture(160 * 120);
  EXPECT_EQ(depth_image(culler, 0, picture).code(), StatusCode::stale_buffer);
  EXPECT_EQ(inspector.inspect(scene.world, {&view, 1}, &culler)->views[0].hidden, 0u);
  test::Culled culled;
  for (int frame = 0; frame < 4; ++frame)
    culled = test::cull_with(culler, scene.world, {&view, 1}, test::automatic(50'000));
  ASSERT_GT(culled.result.culled_occlusion, 500u);
  const auto looked = inspector.inspect(scene.world, {&view, 1}, &culler);
  ASSERT_TRUE(looked);
  EXPECT_EQ(looked->views[0].hidden, culled.result.culled_occlusion);
  EXPECT_EQ(looked->views[0].visible, culled.result.count);
  const auto wall = std::ranges::find_if(
      looked->boxes, [](const DebugBox& b) { return b.kind == DebugBoxKind::occluder && b.objects == 0; });
  ASSERT_NE(wall, looked->boxes.end());
  EXPECT_EQ(wall->seen, 1);
  EXPECT_EQ(wall->box.max.y, 30);
  ASSERT_TRUE(depth_image(culler, 0, picture));
  EXPECT_EQ(*std::ranges::max_element(picture), 255);
  EXPECT_EQ(*std::ranges::min_element(picture), 0);
  EXPECT_EQ(depth_image(culler, 0, std::span(picture).first(9)).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(depth_image(culler, 9, picture).code(), StatusCode::stale_buffer);
  // Another world, in which nothing hides, and a culler that was told so by a cull.
  World bare;
  ASSERT_TRUE(bare.insert(BoxView(scene.boxes), scene.handles));
  const auto all = test::cull_with(culler, bare, {&view, 1}, test::automatic(50'000));
  EXPECT_EQ(depth_image(culler, 0, picture).code(), StatusCode::stale_buffer);
  const auto bare_looked = inspector.inspect(bare, {&view, 1}, &culler);
  ASSERT_TRUE(bare_looked);
  EXPECT_EQ(bare_looked->views[0].visible, all.result.count);
  EXPECT_EQ(depth_image(OcclusionBuffer(), picture).code(), StatusCode::stale_buffer);
}

// The cull draws once for both.
TEST(Inspector, ShowsTheSameOfTwoPlacesOfOneView) {
  std::vector<Box> boxes{{{-20, 0, -12}, {20, 30, -10}}};
  Random random(5);
  for (int i = 0; i < 3000; ++i)
    boxes.push_back(test::box_at(random.inside({{-100, 0, -200}, {100, 10, -20}}), {.5f, .5f, .5f}));
  test::SolidBoxes scene(std::move(boxes));
  const CullView view{.view = {test::looking({0, 5, 0}, {0, 0, -1}), {}}},
      other{.view = {test::looking({0, 6, 0}, {0, 0, -1}), {}}};
  Culler culler;
  CullInspector inspector;
  CullOptions options = test::automatic(50'000);
  options.buffer.coverage = Coverage::centres;  // the wall is a few pixels high
  std::array<std::vector<std::uint8_t>, 2> pictures;
  for (auto& picture : pictures) picture.resize(160 * 120);
  const auto expect_same_of_both = [&] {
    const std::array same{view, view};
    const auto culled = test::cull_with(culler, scene.world, same, options);
    ASSERT_GT(culled.result.culled_occlusion, 100u);
    const auto looked = inspector.inspect(scene.world, same, &culler);
    ASSERT_TRUE(looked);
    EXPECT_EQ(looked->views[0], looked->views[1]);
    EXPECT_EQ(looked->views[0].hidden, culled.result.culled_occlusion);
    for (const DebugBox& box : looked->boxes) EXPECT_TRUE(box.seen == 0 || box.seen == 3);
    for (std::size_t place = 0; place < 2; ++place) ASSERT_TRUE(depth_image(culler, place, pictures[place]));
    EXPECT_EQ(pictures[0], pictures[1]);
  };
  expect_same_of_both();
  // Now the second place has what it drew for the same view when the wall stood elsewhere.
  const std::array others{other, view};
  for (int frame = 0; frame < 2; ++frame) test::cull_with(culler, scene.world, others, options);
  const Box away = test::box_at({0, 15, -700}, {20, 15, 1});
  ASSERT_TRUE(scene.world.move(std::span(scene.handles).first(1), BoxView(std::span(&away, 1))));
  const OccluderPlacement placement = test::filling(away, scene.unit);
  ASSERT_TRUE(scene.world.set_occluders(std::span(scene.handles).first(1), std::span(&placement, 1)));
  expect_same_of_both();
}

TEST(Inspector, CornersOfAViewProjectToTheImages) {
  Random random(5);
  for (int round = 0; round < 1000; ++round) {
    const WorldView view{test::random_view(random, kInspected), {1e6, 0, -3e5}};
    const auto corners = view_corners(view, 1e4);
    ASSERT_TRUE(corners) << corners.error().message();
    const glm::dmat4 to_eye = geometry::to_double(view.view.world_to_eye),
                     to_clip = geometry::to_double(view.view.eye_to_clip);
    for (std::size_t c = 0; c < 8; ++c) {
      const WorldPoint& p = (*corners)[c];
      const glm::dvec4 eye = to_eye * glm::dvec4(p.x - 1e6, p.y, p.z + 3e5, 1);
      const glm::dvec4 clip = to_clip * eye;
      EXPECT_NEAR(clip.x / clip.w, c & 1 ? 1 : -1, 1e-3);
      EXPECT_NEAR(clip.y / clip.w, c & 2 ? 1 : -1, 1e-3);
      EXPECT_LE(-eye.z, 1.0001e4);
      const double depth = clip.z / clip.w;
      if (c < 4) EXPECT_NEAR(std::min(depth, 1 - depth), 0, 1e-2);
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << round;
  }
  EXPECT_EQ(view_corners({*make_view({}, 64, 64), {}}, 0.05).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(view_corners({*make_view({}, 64, 64), {}}, std::nan("")).error().code(),
            StatusCode::bad_argument);
  WorldView of_no_size;
  of_no_size.view.width = 0;
  EXPECT_EQ(view_corners(of_no_size, 9).error().code(), StatusCode::bad_view);
}

TEST(Inspector, InfinitelyFarCornersAreThoseOfTheFarPlaneWhereThereIsOne) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    for (int round = 1; round < 100; ++round) {
      Camera camera{.vertical_fov = 0.03f * static_cast<float>(round), .far_plane = 50, .depth = depth};
      const auto corners = view_corners({*make_view(camera, 64, 48), {}}, kInfinite);
      ASSERT_TRUE(corners) << corners.error().message();
      for (std::size_t c = 4; c < 8; ++c) EXPECT_NEAR((*corners)[c].z, -50, 0.01);
      camera.far_plane = std::numeric_limits<float>::infinity();
      const auto none = view_corners({*make_view(camera, 64, 48), {}}, kInfinite);
      ASSERT_FALSE(none);
      EXPECT_EQ(none.error().code(), StatusCode::bad_argument);
      EXPECT_STREQ(none.error().message(),
                   "view: it has no far plane, expected a farthest distance that is finite");
    }
  }
}

TEST(Inspector, RefusesWhatACullRefuses) {
  World world;
  CullInspector inspector;
  EXPECT_EQ(inspector.inspect(world, {}).error().code(), StatusCode::bad_argument);
  CullView view{.view = {*make_view({}, 64, 64), {}}};
  ASSERT_TRUE(inspector.inspect(world, {&view, 1}));
  const OcclusionBuffer never;
  view.occlusion = &never;
  EXPECT_EQ(inspector.inspect(world, {&view, 1}).error().code(), StatusCode::stale_buffer);
}

}  // namespace
}  // namespace sightline
