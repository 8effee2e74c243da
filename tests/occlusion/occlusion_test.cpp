#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <algorithm>
#include <cmath>

#include <sightline/projection.hpp>

#include "support/exact_rays.hpp"
#include "support/small_scenes.hpp"
#include "workbench/scene/random.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;

std::vector<double> exact_depths(const ExactRays& rays, const View& view, std::span<const Box> occluders,
                                 bool front_only = false) {
  std::vector<double> nearness(std::size_t{view.width} * view.height, ExactRays::kMiss);
  for (std::uint32_t y = 0; y < view.height; ++y) {
    for (std::uint32_t x = 0; x < view.width; ++x) {
      double& best = nearness[std::size_t{y} * view.width + x];
      for (const Box& box : occluders) best = std::max(best, rays.hit(x + 0.5, y + 0.5, box, front_only));
    }
  }
  return nearness;
}

TEST(Occlusion, DrawsBoxesNowhereNearerThanTheyAreAndAlmostEverywhereTheyAre) {
  Random random(3);
  std::size_t covered = 0, missed = 0;
  for (int round = 0; round < 150; ++round) {
    const View view = test::small_view(random);
    std::vector<Box> occluders;
    for (int i = 0; i < 12; ++i) occluders.push_back(test::box_of(random, round % 3 == 0 ? 30.0f : 6.0f));
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    std::vector<float> drawn(std::size_t{view.width} * view.height);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    const std::vector<double> exact = exact_depths(ExactRays(view), view, occluders);
    const std::vector<double> front = exact_depths(ExactRays(view), view, occluders, true);
    const double slack = is_orthographic(view) ? 0.5 : 0;  // metres there, where nearness is a depth
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      ASSERT_LE(drawn[i], exact[i]) << "round " << round << " pixel " << i % view.width << ' '
                                    << i / view.width;
      covered += front[i] > ExactRays::kMiss;
      missed += front[i] > ExactRays::kMiss && drawn[i] < front[i] - slack - 0.02 * std::fabs(front[i]);
    }
  }
  EXPECT_GT(covered, 50000u);
  EXPECT_LT(static_cast<double>(missed), 0.03 * static_cast<double>(covered));
}

TEST(Occlusion, NeverHidesWhatAPixelCentreSees) {
  Random random(4);
  std::size_t hidden = 0, could_be = 0;
  for (int round = 0; round < 150; ++round) {
    const View view = test::small_view(random);
    std::vector<Box> occluders;
    for (int i = 0; i < 12; ++i) occluders.push_back(test::box_of(random, 8));
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    const ExactRays rays(view);
    const Frustum frustum = make_frustum(view);
    const std::vector<double> exact = exact_depths(rays, view, occluders);
    const std::vector<double> front = exact_depths(rays, view, occluders, true);
    Boxes queries;
    for (int i = 0; i < 21; ++i) queries.push_back(test::box_of(random, 2));
    std::vector<std::uint8_t> visible(queries.size());
    EXPECT_TRUE(buffer.may_see(queries.view(), visible));
    for (std::size_t q = 0; q < queries.size(); ++q) {
      ASSERT_EQ(visible[q] != 0, buffer.may_see(queries[q]));
      bool seen = false, seen_without_insides = false;
      for (std::uint32_t i = 0; i < exact.size() && !seen; ++i) {
        const double at = rays.hit(i % view.width + 0.5, i / view.width + 0.5, queries[q]);
        seen = at > exact[i];
        seen_without_insides = seen_without_insides || at > front[i];
      }
      if (seen) ASSERT_TRUE(visible[q]) << "round " << round << " box " << q;
      if (!overlaps(frustum, queries[q])) continue;  // for frustum culling to find
      hidden += !visible[q];
      could_be += !seen_without_insides;
    }
  }
  EXPECT_GT(hidden, 100u);
  EXPECT_GT(static_cast<double>(hidden), 0.8 * static_cast<double>(could_be));
}

TEST(Occlusion, MeshesAreTightInsideAndNeverTooLarge) {
  Random random(5);
  const scene::Shape shape = scene::sphere(2);
  const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices);
  EXPECT_EQ(mesh.triangles(), 320u);
  for (int round = 0; round < 30; ++round) {
    Camera camera;
    camera.eye = random.inside({{-6, -6, 3}, {6, 6, 12}});
    camera.forward = {-camera.eye.x, -camera.eye.y, -camera.eye.z};
    const View view = *make_view(camera, 200, 160);
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_mesh(mesh));
    std::vector<float> drawn(200 * 160);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    // The sphere of radius 1 holds the mesh and is held by the mesh grown by a fiftieth.
    std::size_t inside = 0;
    const float limit =
        1 /
        (std::sqrt(camera.eye.x * camera.eye.x + camera.eye.y * camera.eye.y + camera.eye.z * camera.eye.z) -
         1);
    for (const float nearness : drawn) {
      inside += nearness > 0;
      ASSERT_LE(nearness, limit);
    }
    const Sphere sphere{{0, 0, 0}, 1}, smaller{{0, 0, 0}, 0.97f};
    const Projector projector = make_projector(view, {{-1, -1, -1}, {1, 1, 1}});
    EXPECT_LE(static_cast<float>(inside), projected_area_bound(projector, sphere) * 1.01f + 20);
    EXPECT_GE(static_cast<float>(inside), projected_area_bound(projector, smaller) * 0.97f - 20);
    // No pinholes: what stands behind the middle is hidden.
    const float d = 1 / limit + 1;
    const auto behind = [&](float k) {
      return Vec3{-camera.eye.x / d * k, -camera.eye.y / d * k, -camera.eye.z / d * k};
    };
    const Vec3 at = behind(1.5f);
    EXPECT_FALSE(
        buffer.may_see({{at.x - 0.3f, at.y - 0.3f, at.z - 0.3f}, {at.x + 0.3f, at.y + 0.3f, at.z + 0.3f}}));
    const Vec3 before = behind(-1.5f);
    EXPECT_TRUE(buffer.may_see({{before.x - 0.3f, before.y - 0.3f, before.z - 0.3f},
                                {before.x + 0.3f, before.y + 0.3f, before.z + 0.3f}}));
  }
}

TEST(Occlusion, DrawsNothingOfWhatTransformsMakeNoNumbers) {
  const scene::Shape shape = scene::sphere(2);
  const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices);
  for (const bool orthographic : {false, true}) {
    Camera camera{.eye = {0, 0, 9}};
    camera.orthographic_height = orthographic ? 6.0f : 0;
    const View view = *make_view(camera, 64, 48);
    for (const float bad : {std::nanf(""), INFINITY, -INFINITY, 3e38f}) {
      for (int row = 0; row < 3; ++row) {
        for (const int column : {0, 1, 3}) {
          OcclusionBuffer buffer;
          ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
          Mat4 transform;
          transform.m[static_cast<std::size_t>(4 * column + row)] = bad;
          EXPECT_EQ(bool(buffer.draw_mesh(mesh, transform)), std::isfinite(bad));
          const Sphere no_number{{bad, 0, 0}, 1}, no_size{{0, 0, 0}, std::nanf("")};
          EXPECT_TRUE(buffer.draw_spheres(std::array{no_number, no_size}));
          std::vector<float> drawn(64 * 48);
          EXPECT_TRUE(buffer.read_nearness(drawn));
          for (const float nearness : drawn)
            ASSERT_FALSE(nearness > 0.2f);  // nothing before the sphere's place
        }
      }
    }
  }
}

// Thick, thin, near and far, some across the near plane.
std::array<Vec3, 3> triangle_of(Random& random) {
  const Vec3 at = random.inside(test::kRoom);
  const float size = random.below(4) == 0 ? 30.0f : 3.0f, thin = random.below(4) == 0 ? 0.003f : 1.0f;
  std::array<Vec3, 3> out{at, at, at};
  for (std::size_t k = 1; k < 3; ++k) {
    const Vec3 d = random.direction();
    const float by = k == 1 ? size : size * thin;
    out[k] = {at.x + d.x * by, at.y + d.y * by, at.z + d.z * by};
  }
  return out;
}

// A view, twelve boxes drawn as occluders, and which triangles a pixel centre sees beside them.
struct BoxesBeforeTriangles {
  View view;
  OcclusionBuffer buffer;
  std::vector<double> exact, front;  // front: but for what lies within an occluder

  BoxesBeforeTriangles(Random& random, float size) : view(test::small_view(random)) {
    std::vector<Box> occluders;
    for (int i = 0; i < 12; ++i) occluders.push_back(test::box_of(random, size));
    EXPECT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    const ExactRays rays(view);
    exact = exact_depths(rays, view, occluders);
    front = exact_depths(rays, view, occluders, true);
  }

  struct Seen {
    bool seen = false, without_insides = false;
  };
  Seen look(const std::array<Vec3, 3>& triangle) const {
    const ExactRays rays(view);
    Seen out;
    for (std::uint32_t p = 0; p < exact.size() && !out.seen; ++p) {
      const double at = rays.hit(p % view.width + 0.5, p / view.width + 0.5, triangle);
      out.seen = at > exact[p];
      out.without_insides = out.without_insides || at > front[p];
    }
    return out;
  }
};

TEST(Occlusion, NeverHidesATriangleThatAPixelCentreSees) {
  Random random(15);
  std::size_t hidden = 0, could_be = 0, seen_by_box = 0;
  for (int round = 0; round < 250; ++round) {
    BoxesBeforeTriangles trial(random, 8);
    const OcclusionBuffer& buffer = trial.buffer;
    std::vector<Vec3> all;
    bool any_seen = false;
    for (int i = 0; i < 21; ++i) {
      const std::array<Vec3, 3> triangle = triangle_of(random);
      all.insert(all.end(), triangle.begin(), triangle.end());
      const auto [seen, without_insides] = trial.look(triangle);
      const bool may_see = buffer.may_see(std::span<const Vec3>(triangle));
      if (seen) ASSERT_TRUE(may_see) << "round " << round << " triangle " << i;
      any_seen = any_seen || may_see;
      hidden += !may_see;
      could_be += !without_insides;
      Box box{triangle[0], triangle[0]};
      for (const Vec3& c : triangle) {
        box.min = {std::min(box.min.x, c.x), std::min(box.min.y, c.y), std::min(box.min.z, c.z)};
        box.max = {std::max(box.max.x, c.x), std::max(box.max.y, c.y), std::max(box.max.z, c.z)};
      }
      seen_by_box += !may_see && buffer.may_see(box);
      if (may_see) EXPECT_TRUE(buffer.may_see(box));
    }
    ASSERT_EQ(buffer.may_see(std::span<const Vec3>(all)), any_seen);
  }
  EXPECT_GT(hidden, 1000u);
  EXPECT_GT(static_cast<double>(hidden), 0.9 * static_cast<double>(could_be));
  EXPECT_GT(seen_by_box, 50u);
}

TEST(Occlusion, LooksCloselyAtTrianglesThatBeginBehindTheEye) {
  Random random(17);
  std::size_t hidden = 0, seen_count = 0, could_be = 0;
  for (int round = 0; round < 250; ++round) {
    BoxesBeforeTriangles trial(random, 12);
    const OcclusionBuffer& buffer = trial.buffer;
    const Vec3 eye = eye_position(trial.view), forward = view_direction(trial.view);
    for (int i = 0; i < 21; ++i) {
      std::array<Vec3, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 d = random.direction();
        const float side = d.x * forward.x + d.y * forward.y + d.z * forward.z;
        // The first behind the eye, the second before it.
        const float turn = (k == 0 && side > 0) || (k == 1 && side < 0) ? -1.0f : 1.0f;
        const float by = turn * (random.below(3) == 0 ? 200.0f : 20.0f);
        triangle[k] = {eye.x + d.x * by, eye.y + d.y * by, eye.z + d.z * by};
      }
      const auto [seen, without_insides] = trial.look(triangle);
      const bool may_see = buffer.may_see(std::span<const Vec3>(triangle));
      if (seen) ASSERT_TRUE(may_see) << "round " << round << " triangle " << i;
      hidden += !may_see, seen_count += seen;
      could_be += !without_insides;
    }
  }
  EXPECT_GT(seen_count, 500u);
  EXPECT_GT(hidden, 500u);
  EXPECT_GT(static_cast<double>(hidden), 0.85 * static_cast<double>(could_be));
}

TEST(Occlusion, MeshesOfManyGroupsHideTheSameHoweverTheyAreCut) {
  // One sphere in one mesh, and in pieces of 16 triangles: whole groups are left out where others hide them.
  const scene::Shape shape = scene::sphere(4);
  const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices);
  Random random(18);
  for (int round = 0; round < 20; ++round) {
    Mat4 transform;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 4; ++column)
        transform.m[4 * column + row] = column < 3 ? random.between(-3, 3) : random.between(-2, 2);
    }
    Camera camera{.eye = {random.between(-4, 4), 0, round % 4 == 0 ? 3.0f : 14.0f}};
    camera.orthographic_height = round % 5 == 4 ? 12.0f : 0;
    const View view = *make_view(camera, 150, 110);
    OcclusionBuffer whole, pieces;
    ASSERT_TRUE(whole.begin({view, {}}, {Coverage::centres}));
    ASSERT_TRUE(pieces.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(whole.draw_mesh(mesh, transform));
    for (std::size_t i = 0; i < shape.indices.size(); i += 48)
      EXPECT_TRUE(pieces.draw_mesh(
          *OccluderMesh::make(shape.positions, std::span(shape.indices).subspan(i, 48)), transform));
    std::vector<float> by_whole(150 * 110), by_pieces(by_whole.size());
    EXPECT_TRUE(whole.read_nearness(by_whole));
    EXPECT_TRUE(pieces.read_nearness(by_pieces));
    // Outlines of pieces are drawn a little smaller, so some pixels of theirs show what lies behind.
    std::size_t covered = 0, same = 0;
    for (std::size_t p = 0; p < by_whole.size(); ++p) {
      ASSERT_GE(by_whole[p], by_pieces[p]) << "round " << round << " pixel " << p;
      covered += by_whole[p] > -INFINITY;
      same += by_whole[p] == by_pieces[p];
    }
    EXPECT_GT(same, by_whole.size() * 9 / 10);
    if (camera.orthographic_height == 0 && round % 4 != 0) EXPECT_GT(covered, 0u);
  }
}

TEST(Occlusion, RectanglesOfAnySizeAreTestedByEachOfTheirPixels) {
  Random random(16);
  std::size_t one = 0, few = 0, many = 0, hidden = 0;
  for (int round = 0; round < 60; ++round) {
    const View view = *make_view(Camera{.eye = {0, 0, 60}}, 203, 117);
    std::vector<Box> occluders;
    for (int i = 0; i < 60; ++i) occluders.push_back(test::box_of(random, 12));
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    std::vector<float> drawn(203 * 117);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    for (int i = 0; i < 200; ++i) {
      // A box so thin that its rectangle is the image of one face.
      const Vec3 at = random.inside({{-60, -30, -60}, {60, 30, 10}});
      const float half = i % 3 == 0 ? 12.0f : i % 3 == 1 ? 2.0f : 0.2f;
      const Box box{{at.x - half, at.y - half, at.z - 0.001f}, {at.x + half, at.y + half, at.z}};
      const double scale = 117 / 2.0 / std::tan(0.5 * 1.04719755) / (60 - at.z);
      const auto pixels = [&](double grow, int& x0, int& y0, int& x1, int& y1) {
        x0 = std::max(0, static_cast<int>(std::ceil(101.5 + (at.x - half) * scale - grow - 0.5)));
        x1 = std::min(202, static_cast<int>(std::floor(101.5 + (at.x + half) * scale + grow - 0.5)));
        y0 = std::max(0, static_cast<int>(std::ceil(58.5 - (at.y + half) * scale - grow - 0.5)));
        y1 = std::min(116, static_cast<int>(std::floor(58.5 - (at.y - half) * scale + grow - 0.5)));
      };
      const auto least = [&](double grow) {
        int x0, y0, x1, y1;
        pixels(grow, x0, y0, x1, y1);
        double nearness = INFINITY;
        for (int y = y0; y <= y1; ++y) {
          for (int x = x0; x <= x1; ++x)
            nearness = std::min(nearness, static_cast<double>(drawn[static_cast<std::size_t>(y * 203 + x)]));
        }
        return nearness;
      };
      const bool may_see = buffer.may_see(box);
      const double nearness = 1 / (60.0 - at.z);
      if (least(-0.05) < nearness * (1 - 1e-4)) ASSERT_TRUE(may_see) << "round " << round << " box " << i;
      if (least(0.05) > nearness * (1 + 1e-3)) ASSERT_FALSE(may_see) << "round " << round << " box " << i;
      hidden += !may_see;
      int x0, y0, x1, y1;
      pixels(0, x0, y0, x1, y1);
      if (x0 > x1 || y0 > y1) continue;
      const int across = x1 / 8 - x0 / 8, down = y1 / 8 - y0 / 8;
      ++(across + down == 0 ? one : across <= 1 && down <= 1 ? few : many);
    }
  }
  EXPECT_GT(one, 1000u);
  EXPECT_GT(few, 1000u);
  EXPECT_GT(many, 1000u);
  EXPECT_GT(hidden, 1000u);
}

// One coordinate that is no number is enough, whichever it is: the least and the greatest of it and of
// numbers differ between processors.
TEST(Occlusion, CallsVisibleWhatIsNoNumber) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic_height = orthographic ? 6.0f : 0;
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({*make_view(camera, 64, 48), {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_boxes(std::array{Box{{-50, -50, -9}, {50, 50, -8}}}));
    const auto box = [&](const std::array<float, 9>& c) {
      return buffer.may_see(Box{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}});
    };
    const auto sphere = [&](const std::array<float, 9>& c) {
      std::uint8_t visible = 2;
      return buffer.may_see(SphereView::arrays(&c[0], &c[1], &c[2], &c[3], 1), {&visible, 1}) && visible == 1;
    };
    const auto triangle = [&](const std::array<float, 9>& c) {
      return buffer.may_see(
          std::array{Vec3{c[0], c[1], c[2]}, Vec3{c[3], c[4], c[5]}, Vec3{c[6], c[7], c[8]}});
    };
    const std::array<float, 9> good{-1, -1, -20, 1, 1, -19, 0, 1, -20};
    ASSERT_FALSE(box(good) || sphere(good) || triangle(good));
    for (const float none : {std::nanf(""), -std::nanf(""), INFINITY, -INFINITY}) {
      for (std::size_t at = 0; at < good.size(); ++at) {
        std::array<float, 9> bad = good;
        bad[at] = none;
        EXPECT_TRUE(at >= 6 || box(bad)) << none << " at " << at;
        EXPECT_TRUE(at >= 4 || bad[3] < 0 || sphere(bad)) << none << " at " << at;
        EXPECT_TRUE(triangle(bad)) << none << " at " << at;
      }
    }
  }
}

TEST(Occlusion, SameBitsForEveryTargetAndOrder) {
  Random random(6);
  const View view = *make_view(Camera{.eye = {0, 2, 60}}, 333, 217);
  std::vector<Box> occluders;
  for (int i = 0; i < 200; ++i) occluders.push_back(test::box_of(random, 5));
  occluders.push_back({{-3, -3, 55}, {-1, 5, 70}});  // crosses the near plane
  std::vector<Sphere> spheres;
  for (int i = 0; i < 100; ++i) spheres.push_back(test::sphere_of(random, 4));
  Boxes queries;
  for (int i = 0; i < 1000; ++i) queries.push_back(test::box_of(random, 1));
  std::vector<std::array<Vec3, 3>> triangles;
  for (int i = 0; i < 1000; ++i) triangles.push_back(triangle_of(random));
  for (int i = 0; i < 100; ++i) {
    triangles.push_back(triangle_of(random));
    triangles.back()[0] = random.inside({{-9, -9, 60}, {9, 9, 90}});  // behind the eye
  }
  const scene::Shape shape = scene::sphere(3);
  const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices);
  Mat4 crossing;  // the near plane
  for (const std::size_t i : {0, 5, 10}) crossing.m[i] = 3;
  crossing.m[12] = 2, crossing.m[14] = 60;
  const auto run = [&] {
    OcclusionBuffer buffer;
    EXPECT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_boxes(occluders));
    EXPECT_TRUE(buffer.draw_spheres(spheres));
    EXPECT_TRUE(buffer.draw_mesh(mesh, crossing));
    EXPECT_TRUE(buffer.draw_mesh(mesh));
    std::vector<float> drawn(333 * 217);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    std::vector<std::uint8_t> visible(queries.size());
    EXPECT_TRUE(buffer.may_see(queries.view(), visible));
    // The same numbers, read as spheres: half extents that are too small do no harm here.
    std::vector<std::uint8_t> by_sphere(queries.size());
    const std::vector<float> radius(queries.size(), 0.7f);
    EXPECT_TRUE(buffer.may_see(SphereView::arrays(queries.min_x.data(), queries.min_y.data(),
                                                  queries.min_z.data(), radius.data(), queries.size()),
                               by_sphere));
    visible.insert(visible.end(), by_sphere.begin(), by_sphere.end());
    for (const auto& triangle : triangles) visible.push_back(buffer.may_see(std::span<const Vec3>(triangle)));
    return std::pair(drawn, visible);
  };
  const auto expected = run();
  std::reverse(occluders.begin(), occluders.end());
  EXPECT_EQ(run(), expected);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_FALSE(hwy::GetChosenTarget().IsInitialized());  // the next dispatch chooses anew
    EXPECT_EQ(run(), expected) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace sightline
