// Occluders made of meshes, by the library alone: what is refused, what is said, and a first look at what
// they cover. tests/measure holds all of them against the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include <sightline/occlusion.hpp>

#include "support/exact_rays.hpp"
#include "support/occluder_meshes.hpp"

namespace sightline {
namespace {

using test::Form;
using test::NamedMesh;

Occluder make(const scene::Shape& shape, Sides sides = Sides::both, const OccluderOptions& options = {}) {
  const auto made = make_occluder(shape.positions, shape.indices, {&sides, 1}, options);
  EXPECT_TRUE(made) << made.error().message();
  return *made;
}

TEST(MakeOccluder, RefusesWhatOccluderMeshRefuses) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, NAN}};
  const std::vector<std::uint32_t> indices{0, 1, 2}, beyond{0, 1, 3}, two{0, 1};
  EXPECT_EQ(make_occluder(positions, indices).error().code(), StatusCode::bad_mesh);
  EXPECT_EQ(make_occluder(positions, indices).error().index(), 2u);
  const std::span sound = std::span(positions).first(2);
  EXPECT_EQ(make_occluder(sound, indices).error().code(), StatusCode::bad_mesh);
  EXPECT_EQ(make_occluder(sound, two).error().code(), StatusCode::bad_mesh);
  const std::vector<std::uint32_t> point{0, 0, 0};
  EXPECT_EQ(make_occluder(sound, point, {}, {4097, 0}).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(make_occluder(sound, point, {}, {0, 4097}).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(make_occluder(sound, point, {}, {0, 0}).error().code(), StatusCode::bad_argument);
  const auto none = static_cast<Sides>(9);
  EXPECT_EQ(make_occluder(sound, point, {&none, 1}).error().code(), StatusCode::bad_argument);
  EXPECT_EQ(make_occluder(sound, point)->yield, OccluderYield::empty);
  EXPECT_EQ(make_occluder({}, {})->yield, OccluderYield::empty);
}

TEST(MakeOccluder, SaysWhereNothingOccludes) {
  for (const NamedMesh& mesh : test::thin_meshes()) {
    const Occluder made = make(mesh.shape);
    EXPECT_EQ(made.yield, OccluderYield::thin) << mesh.name;
    EXPECT_TRUE(made.indices.empty() && made.boxes.empty()) << mesh.name;
    EXPECT_STRNE(to_string(made.yield), to_string(OccluderYield::parts));
  }
}

TEST(MakeOccluder, MergesWhatIsFlat) {
  // Walls of many quads come back as two triangles each, a window's frame around it as it is.
  const auto triangles = [](const scene::Shape& shape) { return make(shape).sides.size(); };
  EXPECT_EQ(triangles(test::fine_box({{-2, 0, 1}, {5, 3, 3}}, 20)), 12u);
  for (const NamedMesh& mesh : test::open_meshes()) {
    if (mesh.name == "card" || mesh.name == "fine wall") EXPECT_EQ(triangles(mesh.shape), 2u);
    if (mesh.name == "hut without a wall") EXPECT_EQ(triangles(mesh.shape), 10u);
    if (mesh.name == "window") EXPECT_EQ(triangles(mesh.shape), 8u);
    if (mesh.name == "window") EXPECT_EQ(make(mesh.shape).yield, OccluderYield::whole);
  }
}

TEST(MakeOccluder, MergesNothingBeyondADent) {
  // A wall a kilometre away whose upper edge has a corner 0.7 mm too low, or too high: the one stays.
  const auto wall = [](float up, float out) {
    scene::Shape wall = test::surface(8, 2, false, false, [](float u, float v) {
      return Vec3{1000 + 8 * u, 3 * v, 5};
    });
    wall.positions[9 * 2 + 4].y += up, wall.positions[9 * 2 + 4].z += out;
    return wall;
  };
  const auto covers = [](const Occluder& made, double x, double y) {
    const auto left_of = [&](std::size_t i, std::size_t j) {
      const Vec3 &a = made.positions[made.indices[i]], &b = made.positions[made.indices[j]];
      return (double{b.x} - double{a.x}) * (y - double{a.y}) >=
             (double{b.y} - double{a.y}) * (x - double{a.x});
    };
    for (std::size_t i = 0; i < made.indices.size(); i += 3)
      if (left_of(i, i + 1) && left_of(i + 1, i + 2) && left_of(i + 2, i)) return true;
    return false;
  };
  const Occluder dented = make(wall(-7e-4f, 0)), bumped = make(wall(7e-4f, 0)), bent = make(wall(0, 7e-4f));
  EXPECT_FALSE(covers(dented, 1004, 3 - 3.5e-4));
  EXPECT_TRUE(covers(dented, 1004, 3 - 8e-4));
  EXPECT_TRUE(covers(dented, 1001, 3 - 8e-4));
  EXPECT_LT(dented.sides.size(), 6u);
  EXPECT_EQ(bumped.sides.size(), 2u);
  // Nor off its plane, where one sees it from the side.
  EXPECT_TRUE(std::ranges::any_of(bent.indices, [&](std::uint32_t i) { return bent.positions[i].z > 5; }));
}

TEST(MakeOccluder, MergesNothingThatTurnsAside) {
  // Three walls that bow by 0.4 mm, far away. Along its edges a merged wall may have triangles as thin as its
  // corners lie off its plane, which would show where its front does not.
  const scene::Shape tube = test::surface(3, 10, true, false, [](float u, float v) {
    const std::array<Vec3, 3> around{Vec3{1, 0, 0}, Vec3{-0.5f, 0, -0.87f}, Vec3{-0.5f, 0, 0.87f}};
    const Vec3 way = test::scaled(around[static_cast<std::size_t>(3 * u + 0.5f)], 1 + 1.69e-3f * v * (1 - v));
    return Vec3{300 + way.x, v, way.z};
  });
  const auto normals = [](std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const auto at = [&](std::size_t k) { return geometry::to_double(positions[indices[i + k]]); };
      out.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
    }
    return out;
  };
  const Occluder made = make(tube, Sides::front);
  EXPECT_LT(made.sides.size(), tube.indices.size() / 6);
  const std::vector<glm::dvec3> walls = normals(tube.positions, tube.indices);
  for (const glm::dvec3& its : normals(made.positions, made.indices)) {
    EXPECT_TRUE(std::ranges::any_of(walls, [&](const glm::dvec3& n) { return glm::dot(n, its) > 0.89; }));
  }
}

TEST(MakeOccluder, KeepsSidesApart) {
  // Two halves of one wall, of which one is drawn from its front alone, are not merged.
  const scene::Shape wall = test::surface(8, 8, false, false, [](float u, float v) { return Vec3{u, v, 0}; });
  std::vector<Sides> sides(wall.indices.size() / 3, Sides::both);
  std::fill(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2), Sides::front);
  const auto made = make_occluder(wall.positions, wall.indices, sides);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->sides.size(), 4u);
  EXPECT_EQ(std::ranges::count(made->sides, Sides::front), 2);
}

TEST(MakeOccluder, KnowsWhatIsInside) {
  scene::Shape ball = scene::sphere(3), open = ball;
  EXPECT_GT(make(ball, Sides::front).solid_triangles, 0u);
  for (std::size_t i = 0; i < ball.indices.size(); i += 3)
    std::swap(ball.indices[i + 1], ball.indices[i + 2]);
  EXPECT_EQ(make(ball, Sides::front).yield, OccluderYield::thin);  // from outside nothing of it is drawn
  EXPECT_GT(make(ball, Sides::both).solid_triangles, 0u);
  open.indices.resize(open.indices.size() - 3);
  // Through a hole one sees what is inside: only what turns its back to that may occlude, and that one-sided.
  const Occluder holed = make(open);
  EXPECT_TRUE(holed.boxes.empty());
  EXPECT_EQ(std::ranges::count(holed.sides, Sides::both), 0);
  // Every triangle twice, once either way round: there is no inside.
  scene::Shape both = scene::sphere(3);
  const std::size_t count = both.indices.size();
  for (std::size_t i = 0; i < count; i += 3)
    both.indices.insert(both.indices.end(), {both.indices[i], both.indices[i + 2], both.indices[i + 1]});
  EXPECT_EQ(make(both).solid_triangles, 0u);
}

TEST(MakeOccluder, KeepsWithinItsMeans) {
  for (const OccluderOptions& most : {OccluderOptions{0, 2}, {3, 0}, {20, 5}}) {
    for (const NamedMesh& mesh : test::closed_concave_meshes()) {
      if (mesh.name != "bell") continue;
      const Occluder made = make(mesh.shape, Sides::both, most);
      EXPECT_LE(made.sides.size(), most.most_triangles) << mesh.name;
      EXPECT_EQ(made.indices.size(), 3 * made.sides.size());
      EXPECT_LE(made.boxes.size(), most.most_boxes);
      EXPECT_EQ(made.sides.empty(), most.most_triangles == 0) << mesh.name << " of " << most.most_triangles;
    }
  }
}

TEST(MakeOccluder, FarFromTheOriginIsStillInside) {
  // Floats there are 1/16 m apart: the ball of 8 m is made of few places, and what is made stays within them.
  const auto far = [](const Vec3& p) { return Vec3{1e6f + 8 * p.x, 8 * p.y, 8 * p.z}; };
  const Occluder made = make(test::moved(scene::sphere(2), far));
  for (const Vec3& p : made.positions) {
    const double x = (p.x - 1e6) / 8, y = p.y / 8.0, z = p.z / 8.0;
    EXPECT_LT(x * x + y * y + z * z, 1.02);
  }
  // A thousand times as far its sides are one.
  const Occluder none = make(test::moved(scene::sphere(3), [](const Vec3& p) {
    return Vec3{1e9f + p.x, p.y, p.z};
  }));
  EXPECT_EQ(none.solid_triangles, 0u);
}

TEST(MakeOccluder, CoversWhatTheMeshCoversByRaysInDoubles) {
  scene::Random random(77);
  for (const Form form : {Form::convex, Form::concave}) {
    const scene::Shape shape =
        form == Form::convex ? scene::sphere(2) : test::closed_concave_meshes()[3].shape;
    const Occluder made = make(shape, Sides::front);
    const OccluderMesh mesh = *OccluderMesh::make(made.positions, made.indices, made.sides);
    std::size_t covered = 0, all = 0;
    for (int round = 0; round < 3; ++round) {
      const Vec3 way = random.direction();
      const Camera camera{
          .eye = test::scaled(way, 6), .forward = test::scaled(way, -1), .vertical_fov = 0.7f};
      const View view = *make_view(camera, 48, 48);
      OcclusionBuffer buffer;
      ASSERT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
      ASSERT_TRUE(buffer.draw_mesh(mesh));
      std::vector<float> nearness(std::size_t{48} * 48);
      ASSERT_TRUE(buffer.read_nearness(nearness));
      const test::ExactRays rays(view);
      for (std::size_t pixel = 0; pixel < nearness.size(); ++pixel) {
        double truth = test::ExactRays::kMiss;
        for (std::size_t i = 0; i < shape.indices.size(); i += 3) {
          const auto at = [&](std::size_t k) { return shape.positions[shape.indices[i + k]]; };
          truth =
              std::max(truth, rays.hit(pixel % 48 + 0.5, pixel / 48 + 0.5, std::array{at(0), at(1), at(2)}));
        }
        ASSERT_LE(nearness[pixel], truth) << "round " << round << " pixel " << pixel;
        covered += nearness[pixel] > test::ExactRays::kMiss, all += truth > test::ExactRays::kMiss;
      }
    }
    EXPECT_GT(covered, all / 2);
  }
}

// The same bits on every machine: nothing of it depends on the processor.
TEST(MakeOccluder, IsTheSameEverywhere) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](float f) { hash = (hash ^ std::bit_cast<std::uint32_t>(f)) * 0x100000001b3u; };
  // Coordinates without sines, which every library rounds otherwise.
  scene::Shape ball = scene::sphere(3);
  for (Vec3& p : ball.positions) p = {p.x + 0.5f * p.y * p.y, p.y, p.z * (1 - 0.7f * p.x * p.x)};
  // Which corners of a disc are left out, far away, depends on where one begins.
  scene::Shape disc;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const float t = static_cast<float>(i % 32) / 16 - 1, over = 1 / (1 + t * t), half = i < 32 ? 1 : -1;
    disc.positions.push_back({20'000 + half * (1 - t * t) * over, half * 2 * t * over, 5});
    if (i > 1) disc.indices.insert(disc.indices.end(), {0, i - 1, i});
  }
  for (const scene::Shape& shape : {scene::sphere(2), ball, disc}) {
    const Occluder made = make(shape);
    for (const std::uint32_t i : made.indices)
      add(made.positions[i].x), add(made.positions[i].y), add(made.positions[i].z);
    for (const Box& b : made.boxes) add(b.min.x), add(b.min.y), add(b.max.z);
  }
  EXPECT_EQ(hash, 3729930087950473433u);
}

}  // namespace
}  // namespace sightline
