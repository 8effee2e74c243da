#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include <glm/glm.hpp>

#include <sightline/occlusion.hpp>

#include "support/small_scenes.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;

std::vector<Vec3> corners_of(Random& random, std::uint32_t triangles) {
  std::vector<Vec3> out;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Box box = test::box_of(random, 2.0f);
    out.insert(out.end(), {box.min, {box.max.x, box.min.y, box.max.z}, box.max});
  }
  return out;
}

TEST(OccludeeTriangles, AreSeenWhereTheirTrianglesAreOneByOneAndInBatches) {
  Random random(23);
  std::size_t hidden = 0, seen = 0;
  for (int round = 0; round < 100; ++round) {
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({test::small_view(random), {}}, {Coverage::centres}));
    std::vector<Box> occluders;
    for (int i = 0; i < 12; ++i) occluders.push_back(test::box_of(random, 6.0f));
    EXPECT_TRUE(buffer.draw_boxes(occluders));

    // Whole blocks, parts of blocks, and nothing; of few triangles, which share a vector; and more than are
    // asked for at once.
    std::vector<std::uint32_t> counts{1, 0, 16, 17, 5, 48, 2};
    while (counts.size() < 70) counts.push_back(random.below(7));
    std::vector<std::vector<Vec3>> its;
    std::vector<Vec3> all;
    for (const std::uint32_t count : counts) {
      its.push_back(corners_of(random, count));
      all.insert(all.end(), its.back().begin(), its.back().end());
    }
    OccludeeTriangles occludees;
    ASSERT_TRUE(occludees.assign(all, counts));
    its[4] = corners_of(random, 5);
    ASSERT_TRUE(occludees.set(4, its[4]));

    std::vector<std::uint32_t> ids(counts.size()), expected;
    std::iota(ids.begin(), ids.end(), 0u);
    for (const std::uint32_t o : ids) {
      EXPECT_EQ(occludees.triangles(o), counts[o]);
      const bool may_see = buffer.may_see(std::span<const Vec3>(its[o]));
      EXPECT_EQ(buffer.may_see(occludees, o), may_see) << "round " << round << " object " << o;
      if (may_see) expected.push_back(o);
      ++(may_see ? seen : hidden);
    }
    ids.resize(buffer.keep_seen(occludees, ids));
    EXPECT_EQ(ids, expected);
  }
  EXPECT_GT(seen, 50u);
  EXPECT_GT(hidden, 50u);
}

TEST(OccludeeTriangles, RefuseWhatDoesNotFitAndStayAsTheyAre) {
  OccludeeTriangles occludees;
  const std::array<Vec3, 6> corners{};
  const std::array<std::uint32_t, 2> counts{1, 1}, more{1, 2};
  ASSERT_TRUE(occludees.assign(corners, counts));
  EXPECT_FALSE(occludees.assign(corners, more));
  const std::array sides{Sides::front, Sides::both, Sides::front};
  EXPECT_EQ(occludees.assign(corners, counts, sides).code(), StatusCode::bad_mesh);
  const std::array odd{Sides::front, static_cast<Sides>(9)};
  EXPECT_EQ(occludees.assign(corners, counts, odd).code(), StatusCode::bad_argument);
  EXPECT_EQ(occludees.assign(corners, counts, odd).index(), 1u);
  EXPECT_EQ(occludees.objects(), 2u);
  EXPECT_EQ(occludees.triangles(1), 1u);
  EXPECT_FALSE(occludees.set(0, corners));
  EXPECT_FALSE(occludees.set(2, std::span(corners).first(3)));
  EXPECT_TRUE(occludees.set(1, std::span(corners).first(3)));
  EXPECT_EQ(occludees.triangles(2), 0u);
}

// Triangles seen from all around: from behind those with a front are not there but where they reach beside or
// behind the eye, from the front it makes no difference.
TEST(OccludeeTriangles, OfOneSideAreNotSeenFromBehind) {
  Random random(25);
  std::size_t behind = 0, before = 0, still = 0;
  for (int round = 0; round < 200; ++round) {
    OcclusionBuffer buffer;
    const View view = test::small_view(random);
    ASSERT_TRUE(buffer.begin({view, {}}, {round % 2 == 0 ? Coverage::centres : Coverage::area}));
    ASSERT_TRUE(buffer.draw_boxes(std::array{test::box_of(random, 6.0f)}));
    const std::vector<Vec3> corners = corners_of(random, 8);
    const std::vector<std::uint32_t> counts(8, 1);
    OccludeeTriangles both, fronts, mixed;
    ASSERT_TRUE(both.assign(corners, counts));
    ASSERT_TRUE(fronts.assign(corners, counts, std::array{Sides::front}));
    ASSERT_TRUE(mixed.assign(corners, counts,
                             std::vector<Sides>{Sides::both, Sides::front, Sides::both, Sides::front,
                                                Sides::both, Sides::front, Sides::both, Sides::front}));
    for (std::uint32_t o = 0; o < 8; ++o) {
      const Vec3 *p = &corners[3 * o], eye = eye_position(view), ahead = view_direction(view);
      const auto in_double = [](const Vec3& v) { return glm::dvec3(v.x, v.y, v.z); };
      const glm::dvec3 normal =
          glm::cross(in_double(p[1]) - in_double(p[0]), in_double(p[2]) - in_double(p[0]));
      const bool flat = view.eye_to_clip.m[11] == 0;
      const double side =
          flat ? -glm::dot(normal, in_double(ahead)) : glm::dot(normal, in_double(eye) - in_double(p[0]));
      const bool seen = buffer.may_see(both, o);
      const bool front_seen = buffer.may_see(fronts, o);
      EXPECT_TRUE(front_seen ? seen : !(seen && side > 0)) << "round " << round << " triangle " << o;
      EXPECT_EQ(buffer.may_see(mixed, o), o % 2 == 0 ? seen : front_seen);
      behind += seen && side < 0, before += seen && side > 0, still += front_seen && side < 0;
    }
  }
  EXPECT_GT(behind, 100u);
  EXPECT_GT(before, 100u);
  EXPECT_LT(20 * still, behind);
}

// A rasteriser moves corners by parts of a pixel, which may turn over a triangle almost edge on, and draw it.
TEST(OccludeeTriangles, OfOneSideAlmostEdgeOnMayBeSeenFromBehind) {
  const View view = *make_view(Camera{}, 64, 49);  // whose middle row has the horizon through its centres
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {coverage}));
    for (const bool turned : {false, true}) {
      // Under a ceiling, or over a floor: its nearest corner is so many pixels off the horizon.
      for (const float wide : {1e-4f, 1e-3f, 2.0f, 20.0f}) {
        const float height = (turned ? 1.0f : -1.0f) * wide * 4 / 42.4f;
        std::array<Vec3, 3> corners{Vec3{0, height, -4}, {-3, height, -40}, {3, height, -40}};
        if (turned) std::swap(corners[1], corners[2]);
        OccludeeTriangles behind, before;
        ASSERT_TRUE(behind.assign(corners, std::array{1u}, std::array{Sides::front}));
        std::swap(corners[1], corners[2]);
        ASSERT_TRUE(before.assign(corners, std::array{1u}, std::array{Sides::front}));
        EXPECT_TRUE(buffer.may_see(before, 0)) << wide;
        EXPECT_EQ(buffer.may_see(behind, 0), wide < 1) << wide;
      }
    }
  }
}

// What lies to the lower left of the image's diagonal is hidden, from 5 m on.
OcclusionBuffer half_hidden(const View& view, Coverage coverage) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({view, {}}, {coverage}));
  const std::array corners{Vec3{-20, 20, -5}, Vec3{-20, -20, -5}, Vec3{20, -20, -5}};
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(corners, std::array{0u, 1u, 2u})));
  return buffer;
}

// Thin ones are where they are, and not in all of the rectangle around them.
TEST(OccludeeTriangles, ThatAreThinAreHiddenByWhatLiesBeforeThem) {
  const View view = *make_view(Camera{}, 63, 49);  // whose middle pixel has the view's axis in its centre
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    const OcclusionBuffer buffer = half_hidden(view, coverage);
    for (const float width : {0.0f, 1e-6f, 1e-4f}) {
      const auto sliver = [&](float beyond) {
        return std::array{Vec3{beyond - 3, beyond + 3, -10}, Vec3{beyond + 3, beyond - 3, -10},
                          Vec3{beyond + width, beyond + width, -10}};
      };
      EXPECT_FALSE(buffer.may_see(sliver(-0.5f))) << width;
      EXPECT_TRUE(buffer.may_see(std::array{Vec3{0, 3, -4}, Vec3{0, -3, -4}, Vec3{width, 0, -4}})) << width;
      if (coverage == Coverage::area) EXPECT_TRUE(buffer.may_see(sliver(0.5f))) << width;
    }
  }
}

// Whether some pixel's centre lies within a triangle on the image.
bool holds_a_centre(const std::array<glm::dvec2, 3>& p, const View& view) {
  const auto turn = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  const double way = turn(p[0], p[1], p[2]) < 0 ? -1 : 1;
  for (double y = 0.5; y < view.height; ++y) {
    for (double x = 0.5; x < view.width; ++x) {
      bool in = true;
      for (std::size_t k = 0; k < 3; ++k) in = in && way * turn(p[k], p[(k + 1) % 3], {x, y}) >= 0;
      if (in) return true;
    }
  }
  return false;
}

// A rasteriser moves corners by up to 1/256 of a pixel, and what it may draw is seen.
TEST(OccludeeTriangles, ThatAreThinAreSeenWhereARasteriserMayDrawThem) {
  Random random(26);
  const View view = *make_view(Camera{}, 48, 36);
  const double focal = 0.5 * view.height * double{view.eye_to_clip.m[5]};
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
  std::size_t seen = 0, drawn = 0, not_seen = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<Vec3, 3> corners;
    std::array<glm::dvec2, 3> at;
    for (std::size_t k = 0; k < 2; ++k) at[k] = {random.between(-60, 100), random.between(-40, 80)};
    const glm::dvec2 along = at[1] - at[0];
    at[2] = at[0] + double{random.between(-0.2f, 1.2f)} * along +
            std::pow(10.0, random.between(-5, -1)) * glm::dvec2(-along.y, along.x) / glm::length(along);
    for (std::size_t k = 0; k < 3; ++k) {
      const double depth = random.between(1, 50);
      corners[k] = {static_cast<float>((at[k].x - 0.5 * view.width) / focal * depth),
                    static_cast<float>((0.5 * view.height - at[k].y) / focal * depth),
                    static_cast<float>(-depth)};
    }
    const bool may_see = buffer.may_see(corners);
    bool draws = false;
    for (int moved = 0; moved < 4; ++moved) {
      std::array<glm::dvec2, 3> there;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto move = [&] { return (random.below(2) == 0 ? -1 : 1) / 256.0; };
        there[k] = glm::dvec2(0.5 * view.width - focal * corners[k].x / corners[k].z,
                              0.5 * view.height + focal * corners[k].y / corners[k].z) +
                   glm::dvec2(move(), move());
      }
      draws = draws || holds_a_centre(there, view);
    }
    EXPECT_TRUE(may_see || !draws) << i;
    seen += may_see, drawn += draws, not_seen += !may_see;
  }
  EXPECT_GT(drawn, 200u);
  EXPECT_LT(seen, 3 * drawn);
  EXPECT_GT(not_seen, 500u);
}

TEST(OccludeeTriangles, WithTwoEqualCornersShowNothing) {
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin({*make_view(Camera{}, 64, 48), {}}));
  const std::array line{Vec3{-1, -1, -4}, Vec3{1, 1, -4}, Vec3{-1, -1, -4}},
      triangle{Vec3{-1, -1, -4}, Vec3{1, -1, -4}, Vec3{0, 1, -4}};
  EXPECT_FALSE(buffer.may_see(line));
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < 5; ++i) corners.insert(corners.end(), line.begin(), line.end());
  OccludeeTriangles occludees;
  ASSERT_TRUE(occludees.assign(corners, std::array{5u}));
  EXPECT_FALSE(buffer.may_see(occludees, 0));
  EXPECT_EQ(occludees.triangles(0), 5u);
  std::copy(triangle.begin(), triangle.end(), corners.end() - 3);
  ASSERT_TRUE(occludees.set(0, corners));
  EXPECT_TRUE(buffer.may_see(occludees, 0));
}

// A corner close to the eye is uncertain on the image by whole pixels, but far beside it.
TEST(OccludeeTriangles, ThatReachCloseToTheEyeAreHiddenByWhatLiesBeforeThem) {
  const View view = *make_view(Camera{}, 640, 480);
  const OcclusionBuffer buffer = half_hidden(view, Coverage::centres);
  const auto wedge = [](float beyond) {
    return std::array{Vec3{-40, -40, -0.2f}, Vec3{beyond - 3, beyond + 3, -40},
                      Vec3{beyond + 3, beyond - 3, -40}};
  };
  const float pixel = 40 / (0.5f * static_cast<float>(view.height) * view.eye_to_clip.m[5]);
  EXPECT_FALSE(buffer.may_see(wedge(-0.25f * pixel)));
  EXPECT_TRUE(buffer.may_see(wedge(pixel)));
}

// Rounding turns the plane of one that reaches much farther than it is wide.
TEST(OccludeeTriangles, OfOneSideAreSeenFromTheirFrontHoweverThinAndFar) {
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin({*make_view(Camera{}, 640, 480), {}}, {Coverage::centres}));
  for (const std::array<Vec3, 3>& corners :
       {std::array{Vec3{950.042542f, 1159.05383f, -3000}, Vec3{3.76306963f, -1.442276f, -9.32407379f},
                   Vec3{3.35636759f, 0.198760986f, -8.88724232f}},
        std::array{Vec3{-24667.418f, -17656.5391f, -50000}, Vec3{3.89132786f, -0.929787755f, -9.1333189f},
                   Vec3{-3.60053682f, 2.24720669f, -10.7146978f}}}) {
    OccludeeTriangles fronts;
    ASSERT_TRUE(fronts.assign(corners, std::array{1u}, std::array{Sides::front}));
    EXPECT_TRUE(buffer.may_see(fronts, 0));
  }
}

// The prepared near plane lies the farther before the true one the farther away the eye is.
TEST(OccludeeTriangles, AreSeenJustBeforeTheNearPlaneOfAnEyeFarAway) {
  for (const float near : {0.01f, 0.1f}) {
    Camera camera;
    camera.eye = {1e5f, 0, 0}, camera.near_plane = near;
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({*make_view(camera, 640, 480), {}}, {Coverage::centres}));
    const float tip = -1.005f * near;
    EXPECT_TRUE(buffer.may_see(
        std::array{Vec3{1e5f, -1, 1}, Vec3{1e5f - 0.0625f, 0, tip}, Vec3{1e5f + 0.0625f, 0, tip}}));
  }
}

// What the near plane cuts, too.
TEST(OccludeeTriangles, OfOneSideThatReachBehindTheEyeAreNotSeenFromBehind) {
  const View view = *make_view(Camera{}, 64, 49);
  for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {coverage}));
    std::array corners{Vec3{-5, -1, 1}, Vec3{5, -1, 1}, Vec3{0, -1, -40}};
    OccludeeTriangles floor;
    ASSERT_TRUE(floor.assign(corners, std::array{1u}, std::array{Sides::front}));
    EXPECT_TRUE(buffer.may_see(floor, 0));
    std::swap(corners[0], corners[1]);
    ASSERT_TRUE(floor.assign(corners, std::array{1u}, std::array{Sides::front}));
    EXPECT_FALSE(buffer.may_see(floor, 0));
  }
}

TEST(OccludeeTriangles, ThatDoNotExistMayBeSeen) {
  Random random(24);
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin({test::small_view(random), {}}, {Coverage::centres}));
  EXPECT_TRUE(buffer.may_see(OccludeeTriangles{}, 0));
}

}  // namespace
}  // namespace sightline
