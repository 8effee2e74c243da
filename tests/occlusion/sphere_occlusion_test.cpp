// Spheres as occluders and as queries, held against exact rays.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/exact_rays.hpp"
#include "support/small_scenes.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;

// Of those that the near plane does not cut.
std::vector<double> exact_depths(const ExactRays& rays, const View& view, std::span<const Sphere> spheres) {
  std::vector<double> nearness(std::size_t{view.width} * view.height, ExactRays::kMiss);
  const Plane front = make_frustum(view).planes[Frustum::front];
  for (const Sphere& sphere : spheres) {
    if (signed_distance(front, sphere.centre.x, sphere.centre.y, sphere.centre.z) < sphere.radius) continue;
    for (std::uint32_t i = 0; i < nearness.size(); ++i) {
      nearness[i] = std::max(nearness[i], rays.hit(i % view.width + 0.5, i / view.width + 0.5, sphere));
    }
  }
  return nearness;
}

TEST(Occlusion, DrawsSpheresNowhereNearerThanTheyAreAndFillsMostOfThem) {
  Random random(13);
  std::size_t covered = 0, drawn_at = 0;
  for (int round = 0; round < 200; ++round) {
    const View view = test::small_view(random);
    std::vector<Sphere> spheres;
    for (int i = 0; i < 12; ++i) spheres.push_back(test::sphere_of(random, round % 3 == 0 ? 15.0f : 4.0f));
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_spheres(spheres));
    std::vector<float> drawn(std::size_t{view.width} * view.height);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    const std::vector<double> exact = exact_depths(ExactRays(view), view, spheres);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      ASSERT_LE(drawn[i], exact[i]) << "round " << round << " pixel " << i % view.width << ' '
                                    << i / view.width;
      covered += exact[i] > ExactRays::kMiss;
      drawn_at += drawn[i] > -std::numeric_limits<float>::infinity();
    }
  }
  EXPECT_GT(covered, 20000u);
  EXPECT_GT(static_cast<double>(drawn_at), 0.8 * static_cast<double>(covered));
}

TEST(Occlusion, NeverHidesASphereThatAPixelCentreSees) {
  Random random(14);
  std::size_t hidden = 0, dropped_by_sphere = 0;
  for (int round = 0; round < 200; ++round) {
    const View view = test::small_view(random);
    std::vector<Sphere> spheres;
    for (int i = 0; i < 12; ++i) spheres.push_back(test::sphere_of(random, 8));
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_spheres(spheres));
    const ExactRays rays(view);
    const std::vector<double> exact = exact_depths(rays, view, spheres);
    std::vector<Sphere> queries;
    std::array<std::vector<float>, 4> lanes;
    Boxes boxes;
    for (int i = 0; i < 21; ++i) {
      const Sphere s = test::sphere_of(random, 2);
      queries.push_back(s);
      lanes[0].push_back(s.centre.x), lanes[1].push_back(s.centre.y), lanes[2].push_back(s.centre.z);
      lanes[3].push_back(s.radius);
      boxes.push_back({{s.centre.x - s.radius, s.centre.y - s.radius, s.centre.z - s.radius},
                       {s.centre.x + s.radius, s.centre.y + s.radius, s.centre.z + s.radius}});
    }
    std::vector<std::uint8_t> visible(queries.size()), by_box(queries.size());
    EXPECT_TRUE(buffer.may_see(
        SphereView::arrays(lanes[0].data(), lanes[1].data(), lanes[2].data(), lanes[3].data(), 21), visible));
    EXPECT_TRUE(buffer.may_see(boxes.view(), by_box));
    const Frustum frustum = make_frustum(view);
    for (std::size_t q = 0; q < queries.size(); ++q) {
      bool seen = false;
      for (std::uint32_t i = 0; i < exact.size() && !seen; ++i) {
        seen = rays.hit(i % view.width + 0.5, i / view.width + 0.5, queries[q]) > exact[i];
      }
      if (seen) ASSERT_TRUE(visible[q]) << "round " << round << " sphere " << q;
      if (!overlaps(frustum, boxes[q])) continue;
      hidden += !visible[q];
      dropped_by_sphere += by_box[q] && !visible[q];
    }
  }
  EXPECT_GT(hidden, 200u);
  EXPECT_GT(dropped_by_sphere, 5u);
}

}  // namespace
}  // namespace sightline
