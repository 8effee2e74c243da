// What drawing and asking refuse, and what they answer before there is anything to answer from.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/exact_rays.hpp"
#include "support/small_scenes.hpp"

namespace sightline {
namespace {

const std::array kTriangle{Vec3{-5, -5, -10}, Vec3{5, -5, -10}, Vec3{0, 5, -10}};
const std::array<std::uint32_t, 3> kCorners{0, 1, 2};
const WorldView kView{*make_view(Camera{}, 64, 48), {}};

TEST(OcclusionRefusals, BeforeBeginNothingIsDrawnAndAllMayBeSeen) {
  OcclusionBuffer buffer;
  const Box box{{-1, -1, -20}, {1, 1, -19}};
  const OccluderMesh mesh = *OccluderMesh::make(kTriangle, kCorners);
  EXPECT_EQ(buffer.draw_boxes(std::array{box}).code(), StatusCode::stale_buffer);
  EXPECT_EQ(buffer.draw_spheres(std::array{Sphere{{0, 0, -9}, 1}}).code(), StatusCode::stale_buffer);
  EXPECT_EQ(buffer.draw_mesh(mesh).code(), StatusCode::stale_buffer);
  std::vector<float> pixels(64 * 48);
  EXPECT_EQ(buffer.read_nearness(pixels).code(), StatusCode::stale_buffer);
  EXPECT_FALSE(buffer.begun());
  EXPECT_TRUE(buffer.may_see(box));
  EXPECT_TRUE(buffer.may_see(kTriangle));
  std::array<std::uint8_t, 1> visible{};
  ASSERT_TRUE(buffer.may_see(std::array{box}, visible));
  EXPECT_EQ(visible[0], 1);
  visible[0] = 0;
  ASSERT_TRUE(buffer.may_see(std::array{Sphere{{0, 0, -9}, 1}}, visible));
  EXPECT_EQ(visible[0], 1);
  OccludeeTriangles triangles;
  ASSERT_TRUE(triangles.assign(kTriangle, std::array{1u}));
  EXPECT_TRUE(buffer.may_see(triangles, 0));
  std::array<std::uint32_t, 2> objects{0, 5};
  EXPECT_EQ(buffer.keep_seen(triangles, objects), 2u);
}

TEST(OcclusionRefusals, ShortSpansAndUnsoundViews) {
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin(kView, {Coverage::centres}));
  const std::vector<Box> boxes(100, Box{{-1, -1, -20}, {1, 1, -19}});
  const std::vector<Sphere> spheres(100, Sphere{{0, 0, -20}, 1});
  std::vector<std::uint8_t> visible(100);
  const float* none = nullptr;
  EXPECT_EQ(buffer.may_see(boxes, std::span(visible).first(99)).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(buffer.may_see(spheres, std::span(visible).first(99)).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(buffer.may_see(BoxView::min_max(none, 24, 3), visible).code(), StatusCode::bad_argument);
  EXPECT_EQ(buffer.may_see(BoxView::min_max(&boxes[0].min.x, 20, 3), visible).code(),
            StatusCode::bad_argument);
  EXPECT_EQ(buffer.may_see(SphereView(none, none, 16, 3), visible).code(), StatusCode::bad_argument);
  EXPECT_EQ(buffer.draw_boxes(BoxView::min_max(none, 24, 3)).code(), StatusCode::bad_argument);
  EXPECT_EQ(buffer.draw_spheres(SphereView(none, none, 16, 3)).code(), StatusCode::bad_argument);
  std::vector<float> pixels(64 * 48 - 1);
  EXPECT_EQ(buffer.read_nearness(pixels).code(), StatusCode::buffer_too_small);
  EXPECT_TRUE(buffer.may_see(boxes, visible));
}

TEST(OcclusionRefusals, MeshesAndTransforms) {
  std::vector<Vec3> positions(kTriangle.begin(), kTriangle.end());
  EXPECT_EQ(OccluderMesh::make(positions, std::array{0u, 1u}).error().code(), StatusCode::bad_mesh);
  EXPECT_EQ(OccluderMesh::make(positions, std::array{0u, 1u, 3u}).error().index(), 2u);
  EXPECT_EQ(OccluderMesh::make({}, kCorners).error().code(), StatusCode::bad_mesh);
  positions[1].y = std::nanf("");
  EXPECT_EQ(OccluderMesh::make(positions, kCorners).error().index(), 1u);
  EXPECT_EQ(OccluderMesh::make({}, {})->triangles(), 0u);
  constexpr auto kNoSides = static_cast<Sides>(9);
  const std::array twice{0u, 1u, 2u, 0u, 2u, 1u};
  const Status no_sides = OccluderMesh::make(kTriangle, twice, std::array{Sides::front, kNoSides}).error();
  EXPECT_EQ(no_sides.code(), StatusCode::bad_argument);
  EXPECT_EQ(no_sides.index(), 1u);
  EXPECT_EQ(OccluderMesh::make(kTriangle, twice, kNoSides).error().index(), 0u);
  EXPECT_EQ(OccluderMesh::make(kTriangle, twice, Sides::both, static_cast<TJunctions>(9)).error().code(),
            StatusCode::bad_argument);
  const OccluderMesh mesh = *OccluderMesh::make(kTriangle, kCorners);
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin(kView, {Coverage::centres}));
  Mat4 projective, infinite;
  projective.m[3] = 1, infinite.m[13] = INFINITY;
  EXPECT_EQ(buffer.draw_mesh(mesh, projective).code(), StatusCode::bad_argument);
  EXPECT_EQ(buffer.draw_mesh(mesh, infinite).code(), StatusCode::bad_argument);
  EXPECT_TRUE(buffer.draw_mesh(OccluderMesh()));
  EXPECT_TRUE(buffer.may_see(Box{{-1, -1, -20}, {1, 1, -19}}));
  EXPECT_TRUE(buffer.draw_mesh(mesh));
  EXPECT_FALSE(buffer.may_see(Box{{-1, -1, -20}, {1, 1, -19}}));
}

// A view says where its boxes stand: about another origin, in doubles, in any layout.
// At 1e16 m a float's step is wider than a box.
TEST(OcclusionRefusals, BoxesThatReachTooFarCoverNothing) {
  scene::Random random(7);
  for (const float reach : {1e3f, 1e6f, 1e9f, 1e13f, 1e17f, 1e20f, 3e38f}) {
    std::size_t covered = 0;
    for (int round = 0; round < 100; ++round) {
      Camera camera{.eye = random.inside({{-5, -5, -5}, {5, 5, 5}}), .forward = random.direction()};
      camera.orthographic_height = round % 2 == 0 ? 20.0f : 0;
      const View view = *make_view(camera, 24, 16);
      Box box = test::box_of(random, 20);
      for (float* side : {&box.min.x, &box.min.y, &box.min.z})
        if (random.below(3) == 0) *side = -reach;
      for (float* side : {&box.max.x, &box.max.y, &box.max.z})
        if (random.below(3) == 0) *side = reach;
      OcclusionBuffer buffer;
      ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
      EXPECT_TRUE(buffer.draw_boxes(std::span(&box, 1)));
      std::vector<float> drawn(24 * 16);
      ASSERT_TRUE(buffer.read_nearness(drawn));
      const test::ExactRays rays(view);
      for (std::uint32_t p = 0; p < drawn.size(); ++p) {
        if (drawn[p] == -INFINITY) continue;
        ++covered;
        ASSERT_GT(rays.hit(p % 24 + 0.5, p / 24 + 0.5, box), test::ExactRays::kMiss) << box.min.x;
      }
    }
    if (reach < 1e11f) EXPECT_GT(covered, 500u) << reach;
  }
}

TEST(OcclusionRefusals, BoxesStandWhereTheirViewSays) {
  const WorldPoint far{1e7, 0, -1e7};
  const WorldView view{kView.view, far};
  const auto moved = [&](const Box& b) {
    return WorldBox{{b.min.x + far.x, b.min.y + far.y, b.min.z + far.z},
                    {b.max.x + far.x, b.max.y + far.y, b.max.z + far.z}};
  };
  const Box wall{{-50, -50, -11}, {50, 50, -10}}, behind{{-1, -1, -20}, {1, 1, -19}},
      before{{-1, -1, -9}, {1, 1, -8}};
  OcclusionBuffer doubles, floats;
  ASSERT_TRUE(doubles.begin(view, {Coverage::centres}));
  ASSERT_TRUE(floats.begin(view, {Coverage::centres}));
  ASSERT_TRUE(doubles.draw_boxes(std::array{moved(wall)}));
  ASSERT_TRUE(floats.draw_boxes(BoxView(std::array{wall}, far)));
  std::vector<float> a(64 * 48), b(64 * 48);
  ASSERT_TRUE(doubles.read_nearness(a));
  ASSERT_TRUE(floats.read_nearness(b));
  EXPECT_EQ(a, b);
  std::array<std::uint8_t, 2> visible{};
  const std::array wide{moved(behind), moved(before)};
  const std::array relative{behind, before};
  for (const BoxView& boxes : {BoxView(wide), BoxView(relative, far)}) {
    ASSERT_TRUE(floats.may_see(boxes, visible));
    EXPECT_EQ(visible, (std::array<std::uint8_t, 2>{0, 1}));
  }
}

}  // namespace
}  // namespace sightline
