// Occluders against the oracle: they cover nothing that their meshes do not, and enough of what these do.
// SIGHTLINE_OCCLUDER_VIEWS and SIGHTLINE_OCCLUDER_PIXELS ask for more views of each mesh, and larger ones.
#include "workbench/measure/made_occluders.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include <sightline/workbench/io.hpp>

#include "io/sample_files.hpp"
#include "support/occluder_meshes.hpp"
#include "support/rounds.hpp"
#include "support/temporary_folder.hpp"

namespace sightline::measure {
namespace {

std::uint32_t asked(const char* name, std::uint32_t otherwise) {
  return static_cast<std::uint32_t>(test::number_in(name, otherwise));
}

// The least and the mean of what the meshes' occluders cover.
struct Covered {
  double least = 1, mean = 0;
};

Covered examine_all(const std::vector<test::NamedMesh>& meshes, Sides sides) {
  const auto views = asked("SIGHTLINE_OCCLUDER_VIEWS", 4), pixels = asked("SIGHTLINE_OCCLUDER_PIXELS", 256);
  Covered out;
  for (const test::NamedMesh& mesh : meshes) {
    Scene scene;
    scene.add_object(scene.add_mesh(mesh.shape.positions, {}, mesh.shape.indices), {},
                     {Surface::opaque, sides});
    const MadeOccluder made = make_occluders(scene, {})[0];
    EXPECT_LE(made.occluder.sides.size(), 64u) << mesh.name;
    const OccluderEvidence evidence = examine(scene, made, views, pixels);
    EXPECT_EQ(evidence.wrong_pixels, 0u) << mesh.name;
    EXPECT_GT(evidence.mesh_pixels, 0u) << mesh.name;
    std::printf("%-20s %6zu triangles: %2zu cover %5.1f %%, %zu boxes %5.1f %%\n", mesh.name.c_str(),
                made.triangles, made.occluder.sides.size(), 100 * evidence.covered(),
                made.occluder.boxes.size(),
                100.0 * static_cast<double>(evidence.box_pixels) / static_cast<double>(evidence.mesh_pixels));
    out.least = std::min(out.least, evidence.covered());
    out.mean += evidence.covered() / static_cast<double>(meshes.size());
  }
  std::printf("  at least %.1f %%, in the mean %.1f %%\n", 100 * out.least, 100 * out.mean);
  return out;
}

class MadeOccluders : public testing::TestWithParam<Sides> {};

TEST_P(MadeOccluders, OfClosedConvexMeshesCoverMostOfThem) {
  const Covered covered = examine_all(test::closed_convex_meshes(), GetParam());
  EXPECT_GE(covered.mean, 0.85);
  EXPECT_GE(covered.least, 0.85);
}

TEST_P(MadeOccluders, OfClosedConcaveMeshesCoverMuchOfThem) {
  const Covered covered = examine_all(test::closed_concave_meshes(), GetParam());
  EXPECT_GE(covered.mean, 0.8);
  EXPECT_GE(covered.least, 0.55);
}

TEST_P(MadeOccluders, OfOpenMeshesCoverNothingBesideThem) {
  examine_all(test::open_meshes(), GetParam());
}

// Pieces that overlap, inside out, crumpled until they pass through themselves, with holes, and twice.
scene::Shape mess(scene::Random& random) {
  scene::Shape out;
  for (std::uint32_t pieces = 1 + random.below(3); pieces > 0; --pieces) {
    scene::Shape piece = random.below(2) ? scene::sphere(2) : test::fine_box({{-1, -1, -1}, {1, 1, 1}}, 5);
    const Vec3 at = random.inside({{-1, -1, -1}, {1, 1, 1}}),
               size = random.inside({{0.2f, 0.2f, 0.2f}, {1.5f, 1.5f, 1.5f}});
    const float crumple = random.below(2) ? 3 * random.unit() : 0;
    for (Vec3& p : piece.positions) {
      const Vec3 q{p.x + crumple * p.y * p.z, p.y + crumple * p.x * p.x, p.z - crumple * p.x};
      p = {at.x + size.x * q.x, at.y + size.y * q.y, at.z + size.z * q.z};
    }
    for (std::uint32_t holes = random.below(3) ? 0 : random.below(40); holes > 0; --holes) {
      const std::size_t hole = 3 * random.below(static_cast<std::uint32_t>(piece.indices.size() / 3));
      piece.indices.erase(piece.indices.begin() + static_cast<std::ptrdiff_t>(hole),
                          piece.indices.begin() + static_cast<std::ptrdiff_t>(hole + 3));
    }
    if (random.below(4) == 0) {
      for (std::size_t i = 0; i < piece.indices.size(); i += 3)
        std::swap(piece.indices[i], piece.indices[i + 1]);
    }
    out.append(piece);
    if (random.below(6) == 0) out.append(piece);
  }
  return out;
}

TEST_P(MadeOccluders, OfMessesCoverNothingBesideThem) {
  scene::Random random(GetParam() == Sides::both ? 5 : 6);
  std::size_t some = 0;
  for (std::uint32_t round = 0; round < asked("SIGHTLINE_OCCLUDER_VIEWS", 12); ++round) {
    Scene scene;
    const scene::Shape shape = mess(random);
    scene.add_object(scene.add_mesh(shape.positions, {}, shape.indices), {}, {Surface::opaque, GetParam()});
    const MadeOccluder made = make_occluders(scene, {})[0];
    some += made.occluder.solid_triangles > 0;
    ASSERT_EQ(examine(scene, made, 6, 96).wrong_pixels, 0u) << "round " << round;
  }
  EXPECT_GT(some, 2u);
}

INSTANTIATE_TEST_SUITE_P(Sides, MadeOccluders, testing::Values(Sides::both, Sides::front),
                         [](const auto& sides) { return sides.param == Sides::both ? "both" : "front"; });

TEST(MadeOccluders, ManyTrianglesTakeLessThanASecondWhereNobodyElseWorks) {
  const test::NamedMesh ring{"ring", test::Form::concave, test::tube(400, 125, 0.4f, [](float v) {
                               return Vec3{std::cos(test::kTurn * v), 0, std::sin(test::kTurn * v)};
                             })};
  ASSERT_EQ(ring.shape.indices.size(), 300'000u);
  const auto start = std::chrono::steady_clock::now();
  const auto made = make_occluder(ring.shape.positions, ring.shape.indices);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(made);
  EXPECT_GT(made->solid_triangles, 20u);
  std::printf("100,000 triangles: %.2f s\n", took.count());  // a test does not fail by the clock
}

// A scene of what occludes and what does not: a cut-out, glass, and a ball drawn from its front.
Scene mixed_scene() {
  Scene scene;
  const scene::Shape ball = scene::sphere(3), card = scene::card(2, 3);
  const std::uint32_t round = scene.add_mesh(ball.positions, {}, ball.indices),
                      flat = scene.add_mesh(card.positions, {}, card.indices);
  scene.add_object(round, {}, {Surface::opaque, Sides::front});
  Affine beside;
  beside.rows[0].w = 5;
  scene.add_object(round, beside, {Surface::opaque, Sides::front});
  scene.add_object(round, beside, {Surface::transparent, Sides::both});
  scene.add_object(flat, {}, {Surface::cut_out, Sides::both});
  return scene;
}

TEST(MadeOccluders, AreNotMadeOfWhatCanBeLookedThrough) {
  const Scene scene = mixed_scene();
  const std::vector<MadeOccluder> made = make_occluders(scene, {});
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].mesh, 0u);
  EXPECT_EQ(made[0].sides, Sides::front);
  EXPECT_EQ(made[0].objects, 2u);
}

TEST(MadeOccluders, StandInAFileWhereTheirObjectsStand) {
  const Scene scene = mixed_scene();
  const Scene made = occluder_scene(scene, make_occluders(scene, {}));
  ASSERT_EQ(made.size(), 2u);
  for (ObjectId o = 0; o < 2; ++o) {
    EXPECT_EQ(made.triangles(o), 64u);
    EXPECT_EQ(made.sides[o], Sides::front);
    EXPECT_GT(made.bounds[o].min.x, scene.bounds[o].min.x);
    EXPECT_LT(made.bounds[o].max.x, scene.bounds[o].max.x);
  }
  const test::TemporaryFolder folder;
  write_glb(made, folder / "occluders.glb");
  EXPECT_EQ(load_scene((folder / "occluders.glb").string()).size(), 2u);
}

// What files of the readers' tests hold: patches, doors and flares of a level, a lone triangle.
TEST(MadeOccluders, OfFilesCoverNothingBesideTheirMeshes) {
  const auto views = asked("SIGHTLINE_OCCLUDER_VIEWS", 3), pixels = asked("SIGHTLINE_OCCLUDER_PIXELS", 128);
  for (const Scene& scene : {read_bsp(samples::to_bsp(samples::two_rooms()), "two rooms"),
                             read_gltf(samples::to_bytes(samples::one_triangle()), "triangle")}) {
    std::uint64_t covered = 0;
    for (const MadeOccluder& made : make_occluders(scene, {})) {
      const OccluderEvidence evidence = examine(scene, made, views, pixels);
      EXPECT_EQ(evidence.wrong_pixels, 0u) << scene.name << " mesh " << made.mesh;
      covered += evidence.covered_pixels;
    }
    EXPECT_GT(covered, 0u) << scene.name;
  }
}

// The judge must see what is wrong: an occluder that is a little larger than its mesh.
TEST(MadeOccluders, ThatStandOutAreFoundOut) {
  Scene scene;
  const scene::Shape ball = scene::sphere(3);
  scene.add_object(scene.add_mesh(ball.positions, {}, ball.indices), {}, {Surface::opaque, Sides::front});
  MadeOccluder made = make_occluders(scene, {})[0];
  EXPECT_EQ(examine(scene, made, 2, 200).wrong_pixels, 0u);
  MadeOccluder larger = made;
  for (Vec3& p : larger.occluder.positions) p = test::scaled(p, 1.05f);
  EXPECT_GT(examine(scene, larger, 2, 200).wrong_pixels, 0u);
  made.occluder.boxes = {Box{{-1, -1, -1}, {1, 1, 1}}};
  EXPECT_GT(examine(scene, made, 2, 200).wrong_pixels, 0u);
}

}  // namespace
}  // namespace sightline::measure
