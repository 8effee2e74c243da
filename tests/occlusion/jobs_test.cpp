// A mesh that jobs draw, band by band of the image, gives the bits that one thread gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <sightline/occlusion.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "support/occluder_meshes.hpp"
#include "support/run_threads.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;

// Long triangles, small ones and slivers about the eye, many of which the near plane cuts or a band's border
// crosses; four to a strip, whose edges are seams.
OccluderMesh strips_about(Random& random, const Box& around) {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
  const Box step{{-3, -3, -3}, {3, 3, 3}};
  for (int strip = 0; strip < 400; ++strip) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    Vec3 at = random.inside(around);
    for (std::uint32_t i = 0; i < 6; ++i) {
      positions.push_back(at);
      const Vec3 by = random.inside(step);
      at = {at.x + by.x, at.y + by.y, at.z + by.z};
      if (i < 4) indices.insert(indices.end(), {first + i, first + i + 1 + i % 2, first + i + 2 - i % 2});
    }
  }
  return *OccluderMesh::make(positions, indices, Sides::both);
}

std::vector<float> drawn(const OccluderMesh& mesh, const View& view, const OcclusionOptions& options,
                         const JobSystem& jobs) {
  OcclusionBuffer buffer;
  std::vector<float> out(std::size_t{view.width} * view.height);
  EXPECT_TRUE(buffer.begin({view, {}}, options));
  EXPECT_TRUE(buffer.draw_mesh(mesh, {}, jobs));
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

// Jobs that say how many they were.
void run_and_count(void* user, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  *static_cast<std::uint32_t*>(user) = count;
  test::run_threads(nullptr, count, job, data);
}

TEST(OcclusionJobs, DrawTheBitsOfOneThread) {
  Random random(7);
  const Box around{{-20, -20, -20}, {20, 20, 20}};
  std::size_t covered = 0;
  for (int scene = 0; scene < 6; ++scene) {
    const OccluderMesh mesh = strips_about(random, around);
    Camera camera;
    camera.forward = random.inside({{-1, -1, -1}, {1, 1, 1}});
    camera.near_plane = 0.2f;
    // No whole number of tiles high.
    const View view = *make_view(camera, 250, 301);
    for (const OcclusionOptions& options :
         {OcclusionOptions{Coverage::centres}, OcclusionOptions{Coverage::area},
          OcclusionOptions{Coverage::centres, 2}}) {
      const std::vector<float> alone = drawn(mesh, view, options, {});
      for (const float nearness : alone) covered += nearness > 0;
      for (const std::uint32_t threads : {1u, 2u, 3u, 8u, 64u}) {
        std::uint32_t made = 0;
        EXPECT_EQ(drawn(mesh, view, options, {run_and_count, &made, threads}), alone) << threads;
        // As many as there are bands worth a job; a lone one is drawn without.
        EXPECT_EQ(made > 1, threads > 1) << threads;
        EXPECT_LE(made, threads);
      }
    }
  }
  EXPECT_GT(covered, 200'000u);
}

// Flat pieces that bands cut: what lies around those of their triangles that a band does not show counts
// there.
TEST(OcclusionJobs, DrawTheBitsOfOneThreadOfFlatPieces) {
  Random random(9);
  std::size_t covered = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const scene::Shape shape = test::fine_box({{-1, -1, -1}, {1, 1, 1}}, 1 + random.below(4));
    const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices, Sides::both);
    const Vec3 from = random.direction(), aside = random.inside({{-.5f, -.5f, -.5f}, {.5f, .5f, .5f}});
    const float far = random.between(1.2f, 4);
    const Camera camera{.eye = {far * from.x, far * from.y, far * from.z},
                        .forward = {aside.x - from.x, aside.y - from.y, aside.z - from.z},
                        .near_plane = 0.05f};
    const View view = *make_view(camera, 120, 200);
    for (const OcclusionOptions& options :
         {OcclusionOptions{Coverage::centres}, OcclusionOptions{Coverage::area},
          OcclusionOptions{Coverage::area, 2}}) {
      const std::vector<float> alone = drawn(mesh, view, options, {});
      for (const float nearness : alone) covered += nearness > 0;
      EXPECT_EQ(drawn(mesh, view, options, {test::run_threads, nullptr, 3}), alone) << scene;
    }
  }
  EXPECT_GT(covered, 100'000u);
}

// A camera that turns by `step` degrees a frame and sees a low heap in some of its image's rows.
Camera turning(int frame, float step) {
  const float turn = 0.0174533f * step * static_cast<float>(frame);
  return {.forward = {std::sin(turn), -0.3f, -std::cos(turn)}, .near_plane = 0.2f};
}

OccluderMesh heap(Random& random) {
  return strips_about(random, {{-60, -2, -60}, {60, 1, -20}});
}

// Bands move with what they cost the frame before.
TEST(OcclusionJobs, DrawTheBitsOfOneThreadWhereverBandsBegin) {
  Random random(12);
  const OccluderMesh mesh = heap(random);
  std::size_t covered = 0;
  for (const std::uint32_t threads : {2u, 3u, 8u}) {
    OcclusionBuffer buffer;
    for (int frame = 0; frame < 12; ++frame) {
      // Some images are higher, or by area; one is drawn by a job more.
      const View view = *make_view(turning(frame, 3), 200, frame % 5 == 4 ? 500 : 403);
      const OcclusionOptions options{frame % 4 == 3 ? Coverage::area : Coverage::centres};
      ASSERT_TRUE(buffer.begin({view, {}}, options));
      ASSERT_TRUE(buffer.draw_mesh(mesh, {}, {test::run_threads, nullptr, threads + (frame == 9)}));
      std::vector<float> pixels(std::size_t{view.width} * view.height);
      ASSERT_TRUE(buffer.read_nearness(pixels));
      ASSERT_EQ(pixels, drawn(mesh, view, options, {})) << threads << ", " << frame;
      for (const float nearness : pixels) covered += nearness > 0;
    }
  }
  EXPECT_GT(covered, 100'000u);
}

// Jobs of a buffer, and the most that one of them drew, of the mean.
struct Weighed {
  const OcclusionBuffer& buffer;
  double most_of_mean = 0;

  static void run(void* user, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
    auto& its = *static_cast<Weighed*>(user);
    test::run_threads(nullptr, count, job, data);
    double sum = 0, most = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      std::int64_t row = 0, cost = 0;
      for (const std::int64_t step : OcclusionAccess::tiles(its.buffer).mesh[i].cost_steps)
        cost += row += step;
      EXPECT_EQ(row, 0);
      sum += static_cast<double>(cost), most = std::max(most, static_cast<double>(cost));
    }
    its.most_of_mean = most * count / sum;
  }
};

// Where a mesh looks much as it did, jobs are given as much as each other; also of meshes that take turns,
// and of one that is drawn in two places.
TEST(OcclusionJobs, ShareWhatAFrameCosts) {
  if (!occlusion::kSharesByCost) GTEST_SKIP();
  Random random(13);
  const OccluderMesh low = heap(random), other = heap(random);
  Mat4 below;
  below.m[13] = -12;
  const std::array<std::pair<const OccluderMesh*, Mat4>, 3> drawn{{{&low, {}}, {&other, {}}, {&low, below}}};
  OcclusionBuffer buffer;
  Weighed weighed{buffer};
  double first = 10, later = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const View view = *make_view(turning(frame, 1), 640, 480);
    ASSERT_TRUE(buffer.begin({view, {}}));
    for (const auto& [mesh, transform] : drawn) {
      ASSERT_TRUE(buffer.draw_mesh(*mesh, transform, {Weighed::run, &weighed, 4}));
      if (frame == 0)
        first = std::min(first, weighed.most_of_mean);
      else
        later = std::max(later, weighed.most_of_mean);
    }
  }
  EXPECT_GT(first, 1.6);
  EXPECT_LT(later, 1.5);
}

// What lies beyond a job's band is none of its business, even where the mesh is drawn a second time behind
// itself.
TEST(OcclusionJobs, DrawBehindWhatIsThere) {
  Random random(8);
  const OccluderMesh mesh = strips_about(random, {{-10, -10, -30}, {10, 10, -5}});
  const View view = *make_view(Camera{}, 320, 200);
  Mat4 behind;
  behind.m[14] = -4;
  std::vector<std::vector<float>> pictures;
  for (const std::uint32_t threads : {1u, 4u}) {
    OcclusionBuffer buffer;
    const JobSystem jobs{test::run_threads, nullptr, threads};
    ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    ASSERT_TRUE(buffer.draw_mesh(mesh, {}, jobs));
    ASSERT_TRUE(buffer.draw_mesh(mesh, behind, jobs));
    ASSERT_TRUE(buffer.read_nearness(pictures.emplace_back(320 * 200)));
  }
  EXPECT_EQ(pictures[0], pictures[1]);
}

}  // namespace
}  // namespace sightline
