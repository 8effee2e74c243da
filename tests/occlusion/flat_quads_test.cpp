// Meshes whose triangles are halves of quads, flat or nearly so, against rays through every pixel centre.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <sightline/occlusion.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "support/exact_rays.hpp"
#include "support/random_views.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;

constexpr Box kRoom{{-40, -20, -40}, {40, 20, 40}};
using Quad = std::array<Vec3, 4>;  // its diagonal goes from corner 0 to corner 2

Vec3 along(const Vec3& from, float s, const Vec3& u, float t, const Vec3& v) {
  return {from.x + s * u.x + t * v.x, from.y + s * u.y + t * v.y, from.z + s * u.z + t * v.z};
}

// Convex, of any shape; `bent` moves a corner out of the plane, as a part of the quad's size.
Quad quad_of(Random& random, float bent) {
  const Vec3 at = random.inside(kRoom), u = random.direction(), d = random.direction();
  const Vec3 normal{u.y * d.z - u.z * d.y, u.z * d.x - u.x * d.z, u.x * d.y - u.y * d.x};
  const Vec3 v{normal.y * u.z - normal.z * u.y, normal.z * u.x - normal.x * u.z,
               normal.x * u.y - normal.y * u.x};
  const float size = random.between(0.5f, 25.0f);
  const auto skew = [&] { return size * random.between(0.6f, 1.3f); };
  Quad out{at, along(at, skew(), u, 0, v), along(at, skew(), u, skew(), v), along(at, 0, u, skew(), v)};
  out[1] = along(out[1], size * bent, normal, 0, v);
  return out;
}

OccluderMesh mesh_of(std::span<const Quad> quads) {
  std::vector<Vec3> positions;
  for (const Quad& q : quads) {
    for (const std::size_t corner : {0, 1, 2, 0, 2, 3}) positions.push_back(q[corner]);
  }
  std::vector<std::uint32_t> indices(positions.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return *OccluderMesh::make(positions, indices);
}

std::size_t pairs_of(const OccluderMesh& mesh) {
  const auto& halves = OcclusionAccess::topology(mesh).first_half;
  return static_cast<std::size_t>(std::count(halves.begin(), halves.end(), 1));
}

std::vector<double> exact_depths(const ExactRays& rays, const View& view, std::span<const Quad> quads) {
  std::vector<double> out(std::size_t{view.width} * view.height, ExactRays::kMiss);
  for (std::uint32_t i = 0; i < out.size(); ++i) {
    for (const Quad& q : quads) {
      const double x = i % view.width + 0.5, y = i / view.width + 0.5;
      out[i] = std::max({out[i], rays.hit(x, y, std::array{q[0], q[1], q[2]}),
                         rays.hit(x, y, std::array{q[0], q[2], q[3]})});
    }
  }
  return out;
}

TEST(FlatQuads, ArePairedWhereTheyAreFlatAndConvex) {
  const Quad flat{Vec3{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 2, 0}};
  Quad bent = flat, dented = flat, folded = flat, turned = flat;
  bent[1].z = 0.01f;
  dented[1] = {5, 1.5f, 0};
  folded[1] = {1, 1, 0};
  turned[3] = {2, -1, 0};  // the halves lie over each other
  EXPECT_EQ(pairs_of(mesh_of({{flat}})), 1u);
  EXPECT_EQ(pairs_of(mesh_of({{bent}})), 0u);
  EXPECT_EQ(pairs_of(mesh_of({{dented}})), 0u);
  EXPECT_EQ(pairs_of(mesh_of({{folded}})), 0u);
  EXPECT_EQ(pairs_of(mesh_of({{turned}})), 0u);
}

TEST(FlatQuads, KeepNeighboursAndTriangles) {
  // A strip of quads, and after every third a lone triangle, so that pairs and others take turns.
  std::vector<Vec3> positions;
  for (int i = 0; i < 30; ++i) {
    const auto x = static_cast<float>(i);
    const Vec3 a{x, 0, 0}, b{x + 1, 0, 0}, c{x + 1, 1, 0}, d{x, 1, 0};
    positions.insert(positions.end(), {a, b, c, a, c, d});
    if (i % 3 == 0) positions.insert(positions.end(), {{x, 0, 5}, {x + 1, 0, 6}, {x, 1, 7}});
  }
  std::vector<std::uint32_t> indices(positions.size());
  std::iota(indices.begin(), indices.end(), 0u);
  const OccluderMesh mesh = *OccluderMesh::make(positions, indices);
  const occlusion::OccluderTopology& t = OcclusionAccess::topology(mesh);
  ASSERT_EQ(t.triangles.size(), 70u);
  EXPECT_EQ(pairs_of(mesh), 30u);
  std::size_t seams = 0;
  for (std::uint32_t i = 0; i < 70; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = t.neighbours[i][k];
      if (other == t.kNone) continue;
      ++seams;
      const auto& sides = t.neighbours[other];
      const auto edge = static_cast<std::size_t>(std::ranges::find(sides, i) - sides.begin());
      ASSERT_LT(edge, 3u);
      EXPECT_EQ(t.triangles[i][k], t.triangles[other][(edge + 1) % 3]);
      EXPECT_EQ(t.triangles[i][(k + 1) % 3], t.triangles[other][edge]);
    }
    if (t.first_half[i]) {
      EXPECT_EQ(i % 2, 0u);
      EXPECT_EQ(t.neighbours[i][2], i + 1);
      EXPECT_EQ(t.neighbours[i + 1][2], i);
    }
  }
  EXPECT_EQ(seams, 2u * (30 + 29));
}

TEST(FlatQuads, AreNowhereDrawnNearerThanTheyAreAndAlmostEverywhereTheyAre) {
  Random random(23);
  std::size_t covered = 0, missed = 0, pairs = 0;
  for (int round = 0; round < 400; ++round) {
    Camera camera = test::random_camera(random, kRoom);
    const std::uint32_t width = 20 + random.below(80), height = 20 + random.below(60);
    const Result<View> view = make_view(camera, width, height);
    if (!view) continue;
    std::vector<Quad> quads;
    for (int i = 0; i < 20; ++i) {
      const float most = std::array{0.0f, 1e-6f, 3e-3f}[i % 3];
      quads.push_back(quad_of(random, random.between(-most, most)));
    }
    const OccluderMesh mesh = mesh_of(quads);
    pairs += pairs_of(mesh);
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({*view, {}}));
    EXPECT_TRUE(buffer.draw_mesh(mesh));
    std::vector<float> drawn(std::size_t{view->width} * view->height);
    EXPECT_TRUE(buffer.read_nearness(drawn));
    const std::vector<double> exact = exact_depths(ExactRays(*view), *view, quads);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      ASSERT_LE(double{drawn[i]}, exact[i]) << "round " << round << " pixel " << i;
      const bool hit = exact[i] > ExactRays::kMiss;
      covered += hit, missed += hit && !(drawn[i] > ExactRays::kMiss);
    }
  }
  EXPECT_GT(pairs, 4000u);
  EXPECT_GT(covered, 100000u);
  EXPECT_LT(static_cast<double>(missed), 0.02 * static_cast<double>(covered));
}

}  // namespace
}  // namespace sightline
