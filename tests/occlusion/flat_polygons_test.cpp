// Meshes whose triangles make convex polygons, flat or nearly so, against rays through every pixel centre.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include <sightline/occlusion.hpp>

#include "library/occlusion/depth_tiles.hpp"
#include "support/exact_rays.hpp"
#include "support/random_views.hpp"
#include "support/rounds.hpp"
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

Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
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

// Of unshared corners, three a triangle.
OccluderMesh mesh_of(std::span<const Vec3> corners) {
  std::vector<std::uint32_t> indices(corners.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return *OccluderMesh::make(corners, indices);
}

OccluderMesh mesh_of(std::span<const Quad> quads) {
  std::vector<Vec3> corners;
  for (const Quad& q : quads) {
    for (const std::size_t corner : {0, 1, 2, 0, 2, 3}) corners.push_back(q[corner]);
  }
  return mesh_of(corners);
}

// How many triangles a mesh's polygons have, by decreasing number.
std::vector<std::size_t> polygons_of(const OccluderMesh& mesh) {
  std::vector<std::size_t> out;
  const auto& parts = OcclusionAccess::topology(mesh).parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].follows == 0)
      out.push_back(1);
    else
      ++out.back();
  }
  std::ranges::sort(out, std::greater{});
  while (!out.empty() && out.back() == 1) out.pop_back();
  return out;
}

// A wall of cells in columns, whose upper and lower sides have corners that lie on them, 1 to 4 pieces a
// side: a rectangle, but not by its corners.
struct Wall {
  Quad whole;
  std::vector<Vec3> corners;
};

Wall wall_of(Random& random, const Quad& quad) {
  const auto part = [](int of, int parts) { return static_cast<float>(of) / static_cast<float>(parts); };
  const Vec3 &a = quad[0], &b = quad[1], &d = quad[3];
  const Vec3 u = minus(b, a), v = minus(d, a);
  constexpr int kColumns = 4, kRows = 4;
  Wall out{{a, b, along(b, 0, u, 1, v), d}, {}};
  for (int column = 0; column < kColumns; ++column) {
    const int pieces = 1 + static_cast<int>(random.below(4));
    for (int row = 0; row < kRows; ++row) {
      for (int piece = 0; piece < pieces; ++piece) {
        const auto at = [&](int i, int up) {
          return along(a, part(column * pieces + i, kColumns * pieces), u, part(row + up, kRows), v);
        };
        const Vec3 p = at(piece, 0), q = at(piece + 1, 0), r = at(piece + 1, 1), s = at(piece, 1);
        out.corners.insert(out.corners.end(), {p, q, r, p, r, s});
      }
    }
  }
  return out;
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

TEST(FlatPolygons, AreJoinedWhereTheyAreFlatAndConvex) {
  const Quad flat{Vec3{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 2, 0}};
  Quad bent = flat, dented = flat, folded = flat, turned = flat, straight = flat;
  bent[1].z = 0.01f;
  dented[1] = {5, 1.5f, 0};
  folded[1] = {1, 1, 0};
  turned[3] = {2, -1, 0};  // the halves lie over each other
  straight[1] = {1.5f, 0.5f, 0}, straight[3] = {1.5f, 2, 0};
  const auto polygons = [](const Quad& q) { return polygons_of(mesh_of({{q}})); };
  const std::vector<std::size_t> none, pair{2};
  EXPECT_EQ(polygons(flat), pair);
  EXPECT_EQ(polygons(bent), none);
  EXPECT_EQ(polygons(dented), none);
  EXPECT_EQ(polygons(folded), none);
  EXPECT_EQ(polygons(turned), none);
  Quad corner{Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};  // its second corner lies on a side
  EXPECT_EQ(polygons(corner), none);                            // half of it is nothing
  std::rotate(corner.begin(), corner.begin() + 1, corner.end());
  EXPECT_EQ(polygons(corner), pair);
}

TEST(FlatPolygons, HaveNoMoreTrianglesAndSidesThanAreDrawnAtOnce) {
  // A strip of 30 squares, which together are a rectangle.
  std::vector<Quad> strip;
  for (int i = 0; i < 30; ++i) {
    const auto x = static_cast<float>(i);
    strip.push_back({Vec3{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
  }
  const std::vector<std::size_t> polygons = polygons_of(mesh_of(strip));
  EXPECT_EQ(polygons.front(), occlusion::OccluderTopology::kMostParts);
  EXPECT_EQ(std::accumulate(polygons.begin(), polygons.end(), std::size_t{0}), 60u);
  EXPECT_LE(polygons.size(), 11u);
}

TEST(FlatPolygons, KeepNeighboursAndTriangles) {
  // Walls of all sizes of polygons, and lone triangles, so that some do not fit into a group and wait.
  Random random(7);
  std::vector<Vec3> corners;
  for (int i = 0; i < 12; ++i) {
    const auto z = static_cast<float>(3 * i);
    const Wall wall = wall_of(random, {Vec3{0, 0, z}, {8, 0, z}, {8, 4, z}, {0, 4, z}});
    corners.insert(corners.end(), wall.corners.begin(), wall.corners.end());
    corners.insert(corners.end(), {{0, 0, z + 1}, {1, 0, z + 1.5f}, {0, 1, z + 2}});
  }
  const OccluderMesh mesh = mesh_of(corners);
  const occlusion::OccluderTopology& t = OcclusionAccess::topology(mesh);
  ASSERT_EQ(t.triangles.size(), corners.size() / 3);
  std::size_t inner = 0;
  for (std::uint32_t i = 0; i < t.triangles.size(); ++i) {
    const std::uint8_t follows = t.parts[i].follows;
    EXPECT_TRUE(follows == 0 || i % 16 != 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = t.neighbours[i][k];
      const bool within = t.parts[i].inner >> k & 1;
      inner += within;
      if (other == t.kNone) {
        EXPECT_FALSE(within);
        continue;
      }
      const auto& sides = t.neighbours[other];
      const auto edge = static_cast<std::size_t>(std::ranges::find(sides, i) - sides.begin());
      ASSERT_LT(edge, 3u);
      EXPECT_EQ(t.triangles[i][k], t.triangles[other][(edge + 1) % 3]);
      EXPECT_EQ(t.triangles[i][(k + 1) % 3], t.triangles[other][edge]);
      EXPECT_EQ(within, t.parts[other].inner >> edge & 1);
      if (within) EXPECT_EQ(i / 16, other / 16);
    }
  }
  // A convex polygon of n triangles around no corner has n - 1 edges within it.
  std::size_t expected = 0;
  for (const std::size_t parts : polygons_of(mesh)) expected += 2 * (parts - 1);
  EXPECT_EQ(inner, expected);
  EXPECT_GT(inner, corners.size() / 3);
}

TEST(FlatPolygons, AreNowhereDrawnNearerThanTheyAreAndAlmostEverywhereTheyAre) {
  Random random(23);
  std::size_t covered = 0, missed = 0, pairs = 0;
  const std::uint32_t rounds = test::rounds(400);
  for (std::uint32_t round = 0; round < rounds; ++round) {
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
    pairs += polygons_of(mesh).size();
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({*view, {}}, {Coverage::centres}));
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
  EXPECT_GT(pairs, 10 * rounds);
  EXPECT_GT(covered, 250 * rounds);
  EXPECT_LT(static_cast<double>(missed), 0.02 * static_cast<double>(covered));
}

// A quad of which one half lies a little behind the other's plane, seen from so near that it can be told.
TEST(FlatPolygons, AreDrawnBehindAllTheirTriangles) {
  constexpr float kBehind = 1e-5f, kHeight = 0.4f;
  const Quad quad{Vec3{0, 0, 0}, {12, 0, 0}, {10, 10, 0}, {0, 10, -kBehind}};
  const OccluderMesh mesh = mesh_of(std::span(&quad, 1));
  ASSERT_EQ(polygons_of(mesh), std::vector<std::size_t>{2});
  Camera camera;
  camera.eye = {0.1f, 9.9f, kHeight}, camera.forward = {0, 0, -1}, camera.up = {0.3f, 1, 0};
  camera.vertical_fov = 0.3f, camera.near_plane = 0.01f;
  const View view = *make_view(camera, 64, 64);
  OcclusionBuffer buffer;
  ASSERT_TRUE(buffer.begin({view, {}}, {.coverage = Coverage::centres}));
  EXPECT_TRUE(buffer.draw_mesh(mesh));
  std::vector<float> drawn(std::size_t{64} * 64);
  EXPECT_TRUE(buffer.read_nearness(drawn));
  const std::vector<double> exact = exact_depths(ExactRays(view), view, std::span(&quad, 1));
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    ASSERT_LE(double{drawn[i]}, exact[i]) << "pixel " << i;
    EXPECT_GT(double{drawn[i]}, exact[i] * (1 - 3e-4)) << "pixel " << i;
  }
}

// Eyes before walls at which corners lie on sides.
struct WallSeen {
  Wall wall;
  OccluderMesh mesh;
  View view;
};

WallSeen wall_seen(Random& random, std::uint32_t width, std::uint32_t height) {
  Wall wall = wall_of(random, quad_of(random, 0));
  const Vec3 u = minus(wall.whole[1], wall.whole[0]), v = minus(wall.whole[3], wall.whole[0]);
  Camera camera = test::random_camera(random, kRoom);
  const Vec3 at = along(wall.whole[0], random.between(0, 1), u, random.between(0, 1), v);
  camera.forward = minus(at, camera.eye);
  const Result<View> view = make_view(camera, width, height);
  if (!view) return wall_seen(random, width, height);
  OccluderMesh mesh = mesh_of(wall.corners);
  return {std::move(wall), std::move(mesh), *view};
}

std::vector<float> drawn_of(const WallSeen& seen, Coverage coverage) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({seen.view, {}}, {.coverage = coverage}));
  EXPECT_TRUE(buffer.draw_mesh(seen.mesh));
  std::vector<float> out(std::size_t{seen.view.width} * seen.view.height);
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

TEST(FlatPolygons, AreNowhereNearerThanTheyAreWhereCornersLieOnSides) {
  Random random(31);
  std::size_t covered = 0, polygons = 0;
  for (int round = 0; round < 300; ++round) {
    const WallSeen seen = wall_seen(random, 40 + random.below(90), 40 + random.below(60));
    polygons += polygons_of(seen.mesh).size();
    const std::vector<float> drawn = drawn_of(seen, round % 4 == 0 ? Coverage::area : Coverage::centres);
    const ExactRays rays(seen.view);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if (!(drawn[i] > ExactRays::kMiss)) continue;
      ++covered;
      const double x = static_cast<double>(i % seen.view.width) + 0.5,
                   y = static_cast<double>(i / seen.view.width) + 0.5;
      double nearest = ExactRays::kMiss;
      const std::vector<Vec3>& corners = seen.wall.corners;
      for (std::size_t t = 0; t < corners.size() && nearest < double{drawn[i]}; t += 3)
        nearest = std::max(nearest, rays.hit(x, y, std::array{corners[t], corners[t + 1], corners[t + 2]}));
      ASSERT_LE(double{drawn[i]}, nearest) << "round " << round << " pixel " << i;
    }
  }
  EXPECT_GT(polygons, 3000u);
  EXPECT_GT(covered, 100000u);
}

// The line of a short side is not long enough to bound all of the polygon.
TEST(FlatPolygons, HaveNoHolesWhereCornersLieOnSides) {
  Random random(5);
  std::size_t within = 0, holes = 0;
  for (int round = 0; round < 60; ++round) {
    const WallSeen seen = wall_seen(random, 1280, 720);
    const std::vector<float> drawn = drawn_of(seen, Coverage::centres);
    const ExactRays rays(seen.view);
    const std::size_t width = seen.view.width;
    const auto hit = [&](std::size_t i) { return drawn[i] > ExactRays::kMiss; };
    for (std::size_t i = width + 1; i + width + 1 < drawn.size(); ++i) {
      // Next to nothing of a wall is narrower than a pixel.
      within += hit(i);
      holes += !hit(i) && hit(i - 1) && hit(i + 1) && hit(i - width) && hit(i + width);
    }
  }
  EXPECT_GT(within, 1000000u);
  EXPECT_EQ(holes, 0u);
}

// Narrow vectors see later than wide ones which triangles of a polygon are hidden.
TEST(FlatPolygons, AreTheSameForEveryWidthOfVectors) {
  Random random(13);
  std::size_t covered = 0;
  for (int round = 0; round < 40; ++round) {
    WallSeen seen = wall_seen(random, 320, 180);
    std::vector<Vec3> corners = seen.wall.corners;
    for (int i = 0; i < 8; ++i) {
      const Wall more = wall_of(random, quad_of(random, 0));
      corners.insert(corners.end(), more.corners.begin(), more.corners.end());
    }
    seen.mesh = mesh_of(corners);
    for (const Coverage coverage : {Coverage::centres, Coverage::area}) {
      const std::vector<float> drawn = drawn_of(seen, coverage);
      covered += static_cast<std::size_t>(
          std::ranges::count_if(drawn, [](float d) { return d > ExactRays::kMiss; }));
      for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        EXPECT_EQ(drawn_of(seen, coverage), drawn) << hwy::TargetName(target) << " in round " << round;
      }
      hwy::SetSupportedTargetsForTest(0);
    }
  }
  EXPECT_GT(covered, 500000u);
}

}  // namespace
}  // namespace sightline
