// Where rounding reaches farther than it does in ordinary views: over thousands of pixels, in telescopes,
// beside an orthographic near plane. What the outlines of walls hold is held against exact rays.
#include <gtest/gtest.h>

#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cmath>

#include "library/geometry/linear.hpp"
#include "support/exact_rays.hpp"
#include "support/occluder_meshes.hpp"
#include "support/rounds.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;

OccluderMesh mesh_of(const Box& wall) {
  const scene::Shape shape = test::fine_box(wall, 1);
  return *OccluderMesh::make(shape.positions, shape.indices, Sides::both);
}

std::vector<float> nearness_drawn(const OccluderMesh& mesh, const View& view) {
  OcclusionBuffer buffer;
  std::vector<float> out(std::size_t{view.width} * view.height);
  EXPECT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
  EXPECT_TRUE(buffer.draw_mesh(mesh));
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

// How many pixels are covered; none may be that the wall misses by more than a hundred-thousandth of a pixel.
std::size_t hold_outline(const Box& wall, const View& view) {
  const std::vector<float> pixels = nearness_drawn(mesh_of(wall), view);
  const ExactRays rays(view);
  const auto is_covered = [&](std::size_t p) { return pixels[p] > ExactRays::kMiss; };
  std::size_t covered = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    if (!is_covered(p)) continue;
    ++covered;
    const std::size_t column = p % view.width, row = p / view.width;
    const bool inside = column > 0 && column + 1 < view.width && row > 0 && row + 1 < view.height;
    if (inside && is_covered(p - 1) && is_covered(p + 1) && is_covered(p - view.width) &&
        is_covered(p + view.width))
      continue;
    bool hit = false;
    for (const double dx : {-1e-5, 0.0, 1e-5}) {
      for (const double dy : {-1e-5, 0.0, 1e-5}) {
        const double x = static_cast<double>(column) + 0.5 + dx, y = static_cast<double>(row) + 0.5 + dy;
        hit = hit || rays.hit(x, y, wall) > ExactRays::kMiss;
      }
    }
    EXPECT_TRUE(hit) << column << ' ' << row << " of " << view.width << 'x' << view.height;
  }
  return covered;
}

// A face seen edge on has several square pixels of area by rounding alone: its edges are outlines.
TEST(OcclusionRounding, FacesSeenEdgeOnGoOnNowhere) {
  const auto view = [](const Vec3& eye, const Vec3& forward, const Vec3& up, float fov) {
    Camera camera{.eye = eye, .forward = forward, .up = up, .vertical_fov = fov};
    camera.near_plane = 0.01f, camera.far_plane = 100;
    return *make_view(camera, 3840, 400);
  };
  // Two of the rare views in which a pixel's centre lies just there.
  std::size_t covered = hold_outline({{-1, -1, -40}, {1, 1, -0.306459546f}},
                                     view({1, 1.31244171f, 0}, {0.237860709f, -0.583918154f, -3},
                                          {0.165101856f, 0.0384725258f, -0.985525846f}, 0.99780184f));
  covered += hold_outline({{-1, -1, -40}, {1, 1, -0.0628237724f}},
                          view({1, -2.32921576f, 0}, {-0.0401555449f, 1.89885592f, -3},
                               {0.0308304038f, 0.361165166f, -0.931992054f}, 0.547865212f));
  Random random(3);
  const std::uint32_t rounds = test::rounds(50);
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const float off = std::pow(10.0f, random.between(-8, -3)) * (round % 2 == 0 ? 1.0f : -1.0f);
    const Vec3 eye{round % 4 < 2 ? 1 : 1 + off, random.between(-3, 3), 0},
        at{random.between(0.2f, 1.5f), random.between(-1, 1), -3};
    covered += hold_outline(
        {{-1, -1, -40}, {1, 1, random.between(-0.5f, -0.06f)}},
        view(eye, {at.x - eye.x, at.y - eye.y, -3}, random.direction(), random.between(0.5f, 1.4f)));
  }
  EXPECT_GT(covered, 20'000 * rounds);
}

TEST(OcclusionRounding, TelescopesSeeOutlinesWhereTheyAre) {
  Random random(4);
  std::size_t covered = 0;
  for (int round = 0; round < 120; ++round) {
    const float focal = random.between(1e5f, 5e5f), far = focal / 150;
    const Vec3 from = random.direction(), aside = random.inside({{-.7f, -.7f, -.7f}, {.7f, .7f, .7f}});
    Camera camera{.eye = {aside.x + far * from.x, aside.y + far * from.y, aside.z + far * from.z},
                  .forward = {-from.x, -from.y, -from.z}};
    camera.up = random.direction();
    camera.vertical_fov = 2 * std::atan(100 / focal);
    camera.near_plane = 1, camera.far_plane = 2 * far;
    covered += hold_outline({{-1, -1, -1}, {1, 1, 1}}, *make_view(camera, 300, 200));
  }
  EXPECT_GT(covered, 1'000'000u);
}

// A quad that the near plane of a large orthographic image cuts off by less than it rounds there.
TEST(OcclusionRounding, NothingBeforeAnOrthographicNearPlaneIsDrawn) {
  Random random(5);
  std::size_t cut_off = 0, kept = 0;
  for (int round = 0; round < 2000; ++round) {
    Camera camera{.forward = random.direction(), .near_plane = random.between(0.05f, 1), .far_plane = 5000};
    camera.up = random.direction();
    const float half = random.between(50, 2000);
    camera.orthographic_height = 2 * half;
    const View view = *make_view(camera, 32, 32);
    const glm::dmat3 axes = glm::transpose(glm::dmat3(geometry::to_double(view.world_to_eye)));
    const glm::dvec4 near = geometry::near_plane(view);
    const bool cut = round % 2 == 0;
    const double by = cut ? std::pow(10.0, double{random.between(-8.5f, -7)}) : -1e-4;
    const double depth = near.w / glm::dot(glm::dvec3(near), axes[2]) - by * double{half};
    std::array<Vec3, 4> corners;
    double least = 1e30, most = -1e30;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = geometry::to_vec3(axes * glm::dvec3(k & 1 ? half : -half, k & 2 ? half : -half, -depth));
      const double before = glm::dot(glm::dvec3(near), geometry::to_double(corners[k])) + near.w;
      least = std::min(least, before), most = std::max(most, before);
    }
    const OccluderMesh quad =
        *OccluderMesh::make(corners, std::array<std::uint32_t, 6>{0, 1, 3, 0, 3, 2}, Sides::both);
    const std::vector<float> pixels = nearness_drawn(quad, view);
    const bool some = *std::ranges::max_element(pixels) > ExactRays::kMiss;
    if (most < 0) {
      ++cut_off;
      EXPECT_FALSE(some) << round;
    } else if (least > 1e-5 * half) {
      ++kept;
      EXPECT_TRUE(some) << round;
    }
  }
  EXPECT_GT(cut_off, 50u);
  EXPECT_GT(kept, 20u);
}

}  // namespace
}  // namespace sightline
