// The judge against what can be worked out by hand, and against every triangle in double precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::oracle {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A square in the plane z = 0, side 2, facing +z.
std::uint32_t add_square(Scene& scene) {
  const std::array<Vec3, 4> corners{Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::array<Vec3, 4> normals{Vec3{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const std::array<std::uint32_t, 6> indices{0, 1, 2, 0, 2, 3};
  return scene.add_mesh(corners, normals, indices);
}

Affine placed(const Vec3& at, float scale = 1) {
  return {{Vec4{scale, 0, 0, at.x}, {0, scale, 0, at.y}, {0, 0, scale, at.z}}};
}

View view_of(const Camera& camera, std::uint32_t width = 64, std::uint32_t height = 48) {
  return or_throw(make_view(camera, width, height));
}

Camera from_origin() {
  Camera camera;
  camera.vertical_fov = std::numbers::pi_v<float> / 2;
  camera.near_plane = 1, camera.far_plane = 100;
  return camera;
}

TEST(ItemBuffer, SquareCoversThePixelsThatGeometrySays) {
  Scene scene;
  scene.add_object(add_square(scene), placed({0, 0, -10}, 5));
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(from_origin(), 80, 80));
  // At 90° a square of half side 5 at distance 10 fills the middle half of the image: 40 × 40.
  EXPECT_EQ(buffer.pixels[0], 1600u);
  EXPECT_EQ(buffer.ids[std::size_t{20} * 80 + 20], 0u);
  EXPECT_EQ(buffer.ids[std::size_t{19} * 80 + 20], kNoObject);
  EXPECT_EQ(buffer.ids[std::size_t{59} * 80 + 59], 0u);
  EXPECT_EQ(buffer.ids[std::size_t{59} * 80 + 60], kNoObject);
  // Along the ray from the near plane at 1 to the square at 10; the middle pixel looks almost straight on.
  EXPECT_NEAR(buffer.distances[std::size_t{40} * 80 + 40], 9, 0.01);
  EXPECT_TRUE(std::isinf(buffer.distances[0]));
}

TEST(ItemBuffer, RowZeroIsUp) {
  Scene scene;
  scene.add_object(add_square(scene), placed({3, 5, -10}, 0.8f));
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(from_origin(), 80, 80));
  for (std::uint32_t y = 0; y < 80; ++y) {
    for (std::uint32_t x = 0; x < 80; ++x) {
      if (buffer.ids[y * 80 + x] == kNoObject) continue;
      EXPECT_GE(x, 40u);
      EXPECT_LT(y, 40u);
    }
  }
  EXPECT_GT(buffer.pixels[0], 0u);
}

TEST(ItemBuffer, SphereCoversItsDiscWithinTheFacets) {
  Scene scene = generate_world("regular?columns=1&rows=1");
  ASSERT_EQ(scene.size(), 1u);
  const Sphere sphere = scene.sphere(0);
  Camera camera;
  camera.eye = {sphere.centre.x, sphere.centre.y, sphere.centre.z + 4 * sphere.radius};
  camera.near_plane = 0.01f;
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(camera, 400, 400));
  const double sine = 1.0 / 4,
               radius = 200 / std::tan(0.5 * camera.vertical_fov) * sine / std::sqrt(1 - sine * sine);
  const double disc = std::numbers::pi * radius * radius;
  EXPECT_LT(buffer.pixels[0], 1.01 * disc);
  EXPECT_GT(buffer.pixels[0], 0.95 * disc);
}

TEST(ItemBuffer, NearAndFarPlanesClip) {
  Scene scene;
  const std::uint32_t square = add_square(scene);
  scene.add_object(square, placed({0, 0, -0.5f}, 10));
  scene.add_object(square, placed({0, 0, -50}, 10));
  scene.add_object(square, placed({0, 0, -150}, 1000));
  EmbreeJudge judge(scene);
  Camera camera = from_origin();
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    camera.depth = depth;
    camera.far_plane = 100;
    ItemBuffer buffer = judge.render(view_of(camera));
    EXPECT_EQ(buffer.pixels[0], 0u);
    EXPECT_GT(buffer.pixels[1], 0u);
    EXPECT_EQ(buffer.pixels[2], 0u);
    camera.far_plane = kInfinity;
    buffer = judge.render(view_of(camera));
    EXPECT_EQ(buffer.pixels[0], 0u);
    EXPECT_GT(buffer.pixels[1], 0u);
    EXPECT_GT(buffer.pixels[2], buffer.pixels[1]);
  }
}

TEST(ItemBuffer, OrthographicSizeDoesNotFallWithDistance) {
  Scene scene;
  const std::uint32_t square = add_square(scene);
  scene.add_object(square, placed({-2, 0, -3}));
  scene.add_object(square, placed({2, 0, -40}));
  scene.add_object(square, placed({0, 0, 5}));
  Camera camera = from_origin();
  camera.orthographic_height = 8;
  camera.near_plane = -10;
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(camera, 80, 80));
  EXPECT_EQ(buffer.pixels[0], 400u);
  EXPECT_EQ(buffer.pixels[1], 400u);
  EXPECT_EQ(buffer.pixels[2], 400u);  // behind the eye, yet past the near plane
}

TEST(ItemBuffer, OffCentreMovesTheImage) {
  Scene scene;
  scene.add_object(add_square(scene), placed({0, 0, -10}, 1));
  EmbreeJudge judge(scene);
  Camera camera = from_origin();
  camera.shift_x = 0.5f, camera.shift_y = -0.5f;
  const ItemBuffer buffer = judge.render(view_of(camera, 80, 80));
  EXPECT_EQ(buffer.ids[std::size_t{60} * 80 + 60], 0u);
  EXPECT_EQ(buffer.ids[std::size_t{40} * 80 + 40], kNoObject);
}

TEST(ItemBuffer, TransparentObjectsCountInFrontOfOpaqueOnly) {
  Scene scene;
  const std::uint32_t square = add_square(scene);
  scene.add_object(square, placed({0, 0, -10}, 5));                        // 40 × 40
  scene.add_object(square, placed({0, 0, -5}, 1), Surface::transparent);   // 16 × 16, in front
  scene.add_object(square, placed({0, 0, -8}, 2), Surface::transparent);   // 20 × 20, behind the second
  scene.add_object(square, placed({0, 0, -20}, 9), Surface::transparent);  // 36 × 36, hidden
  scene.add_object(square, placed({0, 0, -40}, 40), Surface::transparent);
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(from_origin(), 80, 80));
  EXPECT_EQ(buffer.pixels, (std::vector<std::uint32_t>{1600, 256, 400, 0, 80 * 80 - 1600}));
  EXPECT_EQ(buffer.ids[std::size_t{40} * 80 + 40], 0u);
  EXPECT_EQ(buffer.visible_count(), 4u);
}

TEST(ItemBuffer, TransparentObjectOfManyTrianglesCountsOnceAPixel) {
  Scene scene;
  const std::uint32_t square = add_square(scene);
  const std::array<Vec3, 4> corners{Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::array<std::uint32_t, 12> twice{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3};
  const std::uint32_t doubled = scene.add_mesh(corners, corners, twice);
  scene.add_object(square, placed({0, 0, -50}, 1));
  scene.add_object(doubled, placed({0, 0, -10}, 5), Surface::transparent);
  EXPECT_EQ(EmbreeJudge(scene).render(view_of(from_origin(), 80, 80)).pixels[1], 1600u);
}

// Single triangles, instances, mirrored instances: a front is where corners run counter-clockwise in mesh
// space.
TEST(ItemBuffer, BackFacesVanishOnlyWhenAsked) {
  Scene scene;
  const std::uint32_t square = add_square(scene), single = add_square(scene);
  const auto turned = [](const Vec3& at, float x, float z) {
    return Affine{{Vec4{x, 0, 0, at.x}, {0, 1, 0, at.y}, {0, 0, z, at.z}}};
  };
  scene.add_object(square, turned({-6, 0, -10}, 1, 1));    // front
  scene.add_object(square, turned({-3, 0, -10}, -1, -1));  // turned by 180°: back
  scene.add_object(square, turned({0, 0, -10}, -1, 1));    // mirrored in x: front
  scene.add_object(square, turned({3, 0, -10}, 1, -1));    // mirrored in z: back
  scene.add_object(single, turned({6, 0, -10}, -1, 1));    // mirrored, not instanced: front
  const View view = view_of(from_origin(), 80, 80);
  const ItemBuffer both = EmbreeJudge(scene).render(view);
  set_raster_state(scene, RasterState::front_faces);
  const EmbreeJudge judge(scene);
  const ItemBuffer front = judge.render(view);
  for (ObjectId object = 0; object < 5; ++object) EXPECT_EQ(both.pixels[object], 64u);
  EXPECT_EQ(front.pixels, (std::vector<std::uint32_t>{64, 0, 64, 0, 64}));
  const std::array<ObjectId, 5> all{0, 1, 2, 3, 4};
  EXPECT_EQ(judge.confirmed_pixels(view, both, all), front.pixels);
}

TEST(ItemBuffer, DegenerateTrianglesAreNothing) {
  Scene scene;
  const std::array<Vec3, 3> line{Vec3{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const std::array<std::uint32_t, 6> indices{0, 1, 2, 1, 1, 1};
  const std::uint32_t degenerate = scene.add_mesh(line, line, indices);
  scene.add_object(degenerate, placed({0, 0, -10}));
  const std::uint32_t square = add_square(scene);
  scene.add_object(square, placed({0, 0, -20}));
  Affine flat = placed({0, 0, -20});
  flat.rows[0].x = 0;  // collapsed: a transform that cannot be inverted
  scene.add_object(square, flat);
  const ItemBuffer buffer = EmbreeJudge(scene).render(view_of(from_origin(), 80, 80));
  EXPECT_EQ(buffer.pixels[0], 0u);
  EXPECT_EQ(buffer.pixels[1], 16u);
  EXPECT_EQ(buffer.pixels[2], 0u);
}

TEST(ItemBuffer, MovedObjectsAreSeenWhereTheyAre) {
  Scene scene;
  const std::uint32_t shared = add_square(scene), single = add_square(scene);
  for (const std::uint32_t mesh : {shared, shared, single}) scene.add_object(mesh, placed({0, 0, 10}));
  EmbreeJudge judge(scene);
  const View view = view_of(from_origin(), 80, 80);
  EXPECT_EQ(judge.render(view).visible_count(), 0u);
  scene.move_object(0, placed({-4, 0, -10}));
  scene.move_object(2, placed({4, 0, -10}));
  const std::array<ObjectId, 2> moved{0, 2};
  judge.move(moved);
  const ItemBuffer buffer = judge.render(view);
  EXPECT_EQ(buffer.pixels, (std::vector<std::uint32_t>{64, 0, 64}));
  EXPECT_EQ(buffer.ids, EmbreeJudge(scene).render(view).ids);
  const std::array<ObjectId, 1> stranger{3};
  EXPECT_THROW(judge.move(stranger), Error);
}

/// Nearest object along a ray, every triangle in double precision by solving for barycentric coordinates.
/// `margin` is the least distance to a decision: an edge, a clip plane, or a competing hit.
struct Nearest {
  ObjectId object = kNoObject;
  double margin = 1;
};

Nearest brute_force(const Scene& scene, const PixelRay& ray) {
  Nearest best;
  double best_t = std::numeric_limits<double>::infinity(), second = best_t;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Mesh& mesh = scene.meshes[scene.mesh[object]];
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      std::array<glm::dvec3, 3> p;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Vec3 v =
            transform_point(scene.transform[object],
                            scene.positions[mesh.first_vertex + scene.indices[mesh.first_index + i + k]]);
        p[k] = {v.x, v.y, v.z};
      }
      const glm::dmat3 system(p[1] - p[0], p[2] - p[0], -ray.direction);
      if (std::fabs(glm::determinant(system)) < 1e-12) continue;
      const glm::dvec3 uvt = glm::inverse(system) * (ray.origin - p[0]);
      const double edge = std::min({uvt.x, uvt.y, 1 - uvt.x - uvt.y});
      if (uvt.z > -1e-3 && uvt.z < ray.length + 1e-3) best.margin = std::min(best.margin, std::fabs(edge));
      if (edge < 0 || uvt.z < 0 || uvt.z > ray.length) continue;
      best.margin = std::min({best.margin, uvt.z, ray.length - uvt.z});
      if (uvt.z < best_t) {
        if (best.object != object) second = best_t;
        best_t = uvt.z, best.object = object;
      } else if (object != best.object) {
        second = std::min(second, uvt.z);
      }
    }
  }
  best.margin = std::min(best.margin, second - best_t);
  return best;
}

TEST(ItemBuffer, EqualsBruteForceInDoublePrecision) {
  Scene scene = generate_world("soup?triangles=400&per-object=10&size=16&seed=5");
  EmbreeJudge judge(scene);
  const Box all = extent(scene);
  scene::Random random(11);
  std::size_t decided = 0, doubtful = 0;
  for (int v = 0; v < 24; ++v) {
    Camera camera;
    camera.eye = random.inside(all), camera.forward = random.direction(), camera.up = random.direction();
    camera.depth = v % 2 == 0 ? Depth::standard : Depth::reversed;
    camera.far_plane = v % 3 == 0 ? kInfinity : 0.5f * (all.max.x - all.min.x);
    camera.shift_x = v % 4 == 1 ? 0.4f : 0;
    if (v % 6 == 5) camera.orthographic_height = 0.5f * (all.max.y - all.min.y), camera.far_plane = 30;
    const View view = view_of(camera, 31, 22);
    const ItemBuffer buffer = judge.render(view);
    const PixelRays rays(view);
    for (std::uint32_t y = 0; y < view.height; ++y) {
      for (std::uint32_t x = 0; x < view.width; ++x) {
        const Nearest expected = brute_force(scene, rays.through(x, y));
        if (expected.margin < 1e-3) {
          ++doubtful;
          continue;
        }
        ++decided;
        ASSERT_EQ(buffer.ids[y * view.width + x], expected.object)
            << "view " << v << " pixel " << x << "," << y;
      }
    }
  }
  EXPECT_GT(decided, 20 * doubtful);
}

TEST(ItemBuffer, SameAnswerTwiceAndConfirmedByDouble) {
  Scene scene = generate_world("irregular");
  EmbreeJudge judge(scene), again(scene);
  Camera camera;
  camera.eye = {0, 2, 0}, camera.forward = {1, -0.1f, 0.4f};
  const View view = view_of(camera, 160, 90);
  const ItemBuffer first = judge.render(view), second = again.render(view);
  EXPECT_EQ(first.ids, second.ids);
  EXPECT_EQ(first.pixels, second.pixels);
  std::size_t looked_at = 0;
  for (ObjectId object = 0; object < scene.size() && looked_at < 20; ++object) {
    if (first.pixels[object] < 20) continue;
    ++looked_at;
    const std::array<ObjectId, 1> one{object};
    EXPECT_NEAR(judge.confirmed_pixels(view, first, one)[0], first.pixels[object], 2);
  }
  EXPECT_GT(looked_at, 5u);
}

TEST(ItemBuffer, RefusesWhatCannotBeSeen) {
  EXPECT_THROW(EmbreeJudge(Scene{}), Error);
  Scene scene;
  scene.add_object(add_square(scene), placed({0, 0, -10}));
  View singular;
  singular.eye_to_clip.m[0] = 0;
  EXPECT_THROW((void)EmbreeJudge(scene).render(singular), Error);
}

}  // namespace
}  // namespace sightline::oracle
