#include "workbench/partition/triangle_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sightline/workbench/worlds.hpp>

#include "library/geometry/linear.hpp"
#include "library/rays/ray_grid.hpp"
#include "support/random_views.hpp"
#include "workbench/methods/ray_pvs/guided_rays.hpp"

namespace sightline::partition {
namespace {

using geometry::to_double;

// Distance to an object's nearest triangle in double precision; -1 for a miss.
double distance_to(const Scene& scene, ObjectId object, const Ray& ray) {
  const Mesh& mesh = scene.meshes[scene.mesh[object]];
  const glm::dvec3 origin = to_double(ray.origin), direction = to_double(ray.direction);
  double nearest = ray.max_distance;
  bool hit = false;
  for (std::uint32_t i = mesh.first_index; i < mesh.first_index + mesh.index_count; i += 3) {
    const auto corner = [&](std::uint32_t k) {
      return to_double(transform_point(scene.transform[object],
                                       scene.positions[mesh.first_vertex + scene.indices[i + k]]));
    };
    const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
    const glm::dvec3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    const double u = glm::dot(origin - a, p) / determinant;
    const glm::dvec3 q = glm::cross(origin - a, ab);
    const double v = glm::dot(direction, q) / determinant, t = glm::dot(ac, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= nearest) nearest = t, hit = true;
  }
  return hit ? nearest : -1;
}

TEST(TriangleRays, AgreeWithEveryTriangleInDoublePrecision) {
  for (const char* world :
       {"soup?triangles=2000&per-object=20&size=40", "forest?trees=60&size=40&transparent=0.3",
        "irregular?spheres=100&size=30&detail=1"}) {
    const Scene scene = generate_world(world);
    const TriangleRays rays(scene);
    scene::Random random(61);
    std::size_t hits = 0, differ = 0, cast = 0;
    for (int v = 0; v < 8; ++v) {
      rays::RayGrid grid;
      grid.make(test::random_view(random, {{-20, 0, -20}, {20, 10, 20}}), 12, 12);
      std::vector<ObjectId> nearest(grid.size());
      std::vector<std::uint8_t> seen(scene.size());
      TriangleRays::Stack stack;
      rays::RayStats stats;
      rays.cast(grid.rays, nearest, seen, stack, stats);
      EXPECT_EQ(stats.rays, grid.size());
      std::vector<std::uint8_t> expected(scene.size());
      for (std::size_t r = 0; r < grid.size(); ++r) {
        double best = grid.rays[r].max_distance;
        ObjectId object = kNoObject;
        for (ObjectId o = 0; o < scene.size(); ++o) {
          if (scene.surface[o] != Surface::opaque) continue;
          const double t = distance_to(scene, o, grid.rays[r]);
          if (t >= 0 && (t < best || object == kNoObject)) best = t, object = o;
        }
        hits += object != kNoObject, ++cast;
        differ += object != nearest[r];
        if (object != kNoObject) expected[object] = 1;
        for (ObjectId o = 0; o < scene.size(); ++o) {
          if (scene.surface[o] == Surface::opaque) continue;
          const double t = distance_to(scene, o, grid.rays[r]);
          if (t >= 0 && t <= best) expected[o] = 1;
        }
      }
      std::size_t unlike = 0;
      for (ObjectId o = 0; o < scene.size(); ++o) unlike += expected[o] != seen[o];
      EXPECT_LE(unlike, 1u) << world;  // a silhouette may round either way
    }
    EXPECT_GT(hits, cast / 20) << world;
    EXPECT_LE(differ, cast / 500) << world;
  }
}

// Which of two faces in one place a renderer shows is up to its rounding: both are seen.
TEST(TriangleRays, SeeAllThatLiesOnTheSameSpot) {
  Scene scene;
  scene.name = "coincident";
  const std::vector<Vec3> small{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
      large{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, normals(3, Vec3{0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2};
  const std::uint32_t small_mesh = scene.add_mesh(small, normals, indices),
                      large_mesh = scene.add_mesh(large, normals, indices);
  Affine hair, step;
  hair.rows[2].w = -1e-5f, step.rows[2].w = -0.02f;
  scene.add_object(large_mesh, {});
  scene.add_object(small_mesh, {});
  scene.add_object(small_mesh, hair);
  scene.add_object(small_mesh, step);  // behind them
  const TriangleRays rays(scene);
  const std::vector<Ray> ray{{{0.1f, 0, 30}, {0, 0, -1}}};
  std::vector<ObjectId> nearest(1);
  std::vector<std::uint8_t> seen(scene.size());
  TriangleRays::Stack stack;
  rays::RayStats stats;
  rays.cast(ray, nearest, seen, stack, stats);
  EXPECT_EQ(nearest[0], 0u);
  EXPECT_EQ(seen, (std::vector<std::uint8_t>{1, 1, 1, 0}));
}

TEST(TriangleRays, ARayOfNoNumbersMeetsNothing) {
  const Scene scene = generate_world("soup?triangles=50&per-object=5&size=10");
  const TriangleRays rays(scene);
  const float infinite = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  for (const Vec3 bad : {Vec3{nan, 0, 0}, Vec3{infinite, infinite, infinite}, Vec3{0, -infinite, nan}}) {
    const std::vector<Ray> cast{{bad, {0.6f, 0, 0.8f}}, {{0, 0, 0}, bad}};
    std::vector<ObjectId> nearest(cast.size());
    std::vector<std::uint8_t> seen(scene.size());
    TriangleRays::Stack stack;
    rays::RayStats stats;
    rays.cast(cast, nearest, seen, stack, stats);
    EXPECT_EQ(nearest, std::vector<ObjectId>(cast.size(), kNoObject));
    EXPECT_EQ(seen, std::vector<std::uint8_t>(scene.size()));
    for (ObjectId object = 0; object < scene.size(); ++object) {
      for (const Ray& ray : cast) EXPECT_LT(intersect(ray, scene.bounds[object]), 0);
    }
  }
}

TEST(TriangleRays, FollowMovedObjects) {
  Scene scene = generate_world("regular?columns=2&rows=1&detail=2");
  TriangleRays rays(scene);
  const std::vector<Ray> ray{{{0, 50, 0}, {0, -1, 0}}};
  std::vector<ObjectId> nearest(1);
  std::vector<std::uint8_t> seen(2);
  TriangleRays::Stack stack;
  rays::RayStats stats;
  rays.cast(ray, nearest, seen, stack, stats);
  EXPECT_EQ(nearest[0], kNoObject);
  Affine there;
  there.rows[0].w = 0.1f, there.rows[1].w = 1, there.rows[2].w = 0.1f;
  scene.move_object(1, there);
  rays.update();
  rays.cast(ray, nearest, seen, stack, stats);
  EXPECT_EQ(nearest[0], 1u);
  EXPECT_EQ(seen[1], 1);
}

// Guided rays against every pixel's ray: what they leave out covers no more than the target.
TEST(GuidedRays, LoseNoMoreThanTheirTarget) {
  for (const char* world : {"soup?triangles=4000&per-object=10&size=60", "strata?triangles=30000",
                            "forest?trees=400&size=80", "irregular?spheres=400&size=60&detail=1"}) {
    const Scene scene = generate_world(world);
    const TriangleRays rays(scene);
    methods::GuidedRays guided;
    TriangleRays::Stack stack;
    for (const Viewpoint& from : scene.viewpoints) {
      const View view = *make_view({.eye = from.eye, .forward = from.forward, .far_plane = 20000}, 400, 300);
      std::vector<std::uint8_t> seen(scene.size()), all(scene.size());
      rays::RayStats stats, full;
      guided.cast(view, rays, {.target = 1e-4}, seen, stack, stats);
      rays::RayGrid grid;
      grid.make(view, 400, 300);
      std::vector<ObjectId> nearest(grid.size());
      rays.cast(grid.rays, nearest, all, stack, full);
      const auto lost = std::count_if(nearest.begin(), nearest.end(),
                                      [&](ObjectId object) { return object != kNoObject && !seen[object]; });
      EXPECT_LE(lost, 12) << world << " " << from.name;  // 0.0001 × 120,000
      for (ObjectId o = 0; o < scene.size(); ++o) EXPECT_LE(seen[o], all[o]) << "seen by no pixel: " << o;
      EXPECT_LT(stats.rays, full.rays);
    }
  }
}

TEST(GuidedRays, StandTheSmallestImages) {
  const Scene scene = generate_world("regular?columns=3&rows=3&detail=1");
  const TriangleRays rays(scene);
  methods::GuidedRays guided;
  TriangleRays::Stack stack;
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 50u}, {17u, 1u}, {16u, 16u}, {3u, 700u}}) {
    const View view = *make_view({.eye = {0, 1, 8}}, width, height);
    std::vector<std::uint8_t> seen(scene.size());
    rays::RayStats stats;
    guided.cast(view, rays, {}, seen, stack, stats);
    EXPECT_LE(stats.rays, width * height);
    EXPECT_GE(stats.rays, 1u);
  }
}

}  // namespace
}  // namespace sightline::partition
