#include "workbench/bake/bake.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/temporary_folder.hpp"
#include "workbench/bake/pvs_file.hpp"
#include "workbench/io/files.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::bake {
namespace {

const CellOptions kCoarse{.cell = 15, .target = 1e-3};

Scene forest() {
  return generate_world("forest?trees=150&size=60");
}

TEST(PvsFile, OfAnotherSceneIsRefused) {
  const Scene a = generate_world("soup?triangles=200&seed=1"),
              b = generate_world("soup?triangles=200&seed=2");
  CellPvs cells;
  cells.objects = static_cast<std::uint32_t>(a.size());
  cells.scene = fingerprint(a);
  EXPECT_NO_THROW(check_belongs(cells, "a.pvs", a));
  EXPECT_THROW(check_belongs(cells, "a.pvs", b), Error);
}

TEST(Bake, GivesTheSameBytesHoweverOftenItIsKilled) {
  const Scene scene = forest();
  const test::TemporaryFolder folder;
  const std::filesystem::path once = folder / "once.pvs", again = folder / "again.pvs";
  const BakeResult whole = bake(scene, kCoarse, once, {});
  ASSERT_TRUE(whole.finished);
  EXPECT_GT(whole.cells.visible.size(), 100u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);

  scene::Random random(3);
  std::uint32_t stops = 0;
  std::size_t reach = 0;
  BakeResult part;
  do {
    reach += 1 + random.below(4);
    part = bake(scene, kCoarse, again, {}, 0, [&](std::size_t done, std::size_t) { return done < reach; });
    ASSERT_LT(++stops, 1000u);
    if (part.finished) break;
    // A kill may cut a record off, or leave bytes that never were one.
    const std::filesystem::path journal = again.string() + ".part.0";
    if (random.below(2) == 0) {
      const auto size = std::filesystem::file_size(journal);
      std::filesystem::resize_file(journal, size - std::min<std::uintmax_t>(size, random.below(40)));
    } else {
      std::ofstream(journal, std::ios::binary | std::ios::app) << "cut off";
    }
  } while (!part.finished);
  EXPECT_GT(stops, 3u);
  EXPECT_EQ(io::read_file(again), io::read_file(once));
}

TEST(Bake, LeavesWhatIsNotItsOwnAlone) {
  const Scene scene = forest();
  const test::TemporaryFolder folder;
  const auto result = folder / "a.pvs", own = folder / "a.pvs.part.0", other = folder / "a.pvs.part.7";
  io::write_file(folder / "precious", "mine");
  const auto refuses = [&] { EXPECT_THROW(bake(scene, kCoarse, result, {}), Error); };
  std::filesystem::create_symlink(folder / "precious", own);
  refuses();
  std::filesystem::remove(own);
  io::write_file(own, "mine");
  refuses();
  EXPECT_EQ(io::read_file(own, 100), "mine");
  std::filesystem::remove(own);
  // The journal of a bake with other options, which took its time.
  CellOptions others = kCoarse;
  others.seed += 1;
  EXPECT_FALSE(
      bake(scene, others, result, {}, 0, [](std::size_t done, std::size_t) { return done < 3; }).finished);
  const std::string before = io::read_file(own, 1 << 20);
  refuses();
  EXPECT_EQ(io::read_file(own, 1 << 20), before);
  std::filesystem::rename(own, other);
  EXPECT_TRUE(bake(scene, kCoarse, result, {}).finished);
  EXPECT_FALSE(std::filesystem::exists(own));
  EXPECT_EQ(io::read_file(other, 1 << 20), before);
  EXPECT_EQ(io::read_file(folder / "precious", 100), "mine");
}

TEST(Bake, EstimatesBeforeItStartsWhatItThenDoesAtLeast) {
  const Scene scene = forest();
  const test::TemporaryFolder folder;
  std::size_t calls = 0, done = 0;
  const auto progress = [&](std::size_t cells, std::size_t) {
    done = cells;
    return true;
  };
  const auto estimated = [&](const BakeEstimate& before) {
    ++calls;
    EXPECT_EQ(done, 0u);
    EXPECT_GT(before.cells, 10u);
    EXPECT_EQ(before.open,
              static_cast<double>(before.cells));  // there is no level whose walls would close one
    EXPECT_GT(before.seconds, 0);
  };
  const BakeResult result = bake(scene, kCoarse, folder / "a.pvs", {}, 2, progress, estimated);
  EXPECT_EQ(calls, 1u);
  EXPECT_GT(static_cast<double>(result.rays),
            static_cast<double>(done) * 3 / kCoarse.target * kCoarse.rays);  // the rays it reckons with
}

TEST(Bake, LosesLittleFromAnywhereInTheCells) {
  Scene scene = forest();
  const test::TemporaryFolder folder;
  const BakeResult result = bake(scene, {.cell = 20, .target = 1e-3}, folder / "a.pvs", {});
  scene.cells = std::make_shared<CellPvs>(bake::read_pvs_file(folder / "a.pvs"));
  const auto method = create_method("baked", scene);
  const oracle::EmbreeJudge judge(scene);
  scene::Random random(5);
  std::uint64_t lost = 0, pixels = 0;
  Frame frame;
  for (int v = 0; v < 60; ++v) {
    const Vec3 eye = random.inside(result.cells.bounds);
    const float turn = random.between(0, 6.28f);
    const View view = *make_view({.eye = eye, .forward = {std::sin(turn), 0.1f, std::cos(turn)}}, 160, 120);
    cull(*method, view, frame);
    lost += oracle::compare_to_truth(judge.render(view), frame.visible).lost_pixels;
    pixels += 160 * 120;
  }
  EXPECT_LE(lost, pixels / 1000);
}

// A closed chamber that takes a five-thousandth of the cell: only from within is seen what it holds.
TEST(Bake, FindsWhatIsSeenFromANookAlone) {
  Scene scene;
  scene.name = "nook";
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  }
  const std::vector<Vec3> normals(8, Vec3{0, 1, 0});
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t axis : {1u, 2u, 4u}) {
    const std::uint32_t u = axis == 1 ? 2 : 1, v = axis == 4 ? 2 : 4;
    for (const std::uint32_t side : {0u, axis}) {
      for (const std::uint32_t corner : {side, side + u, side + u + v, side, side + u + v, side + v}) {
        faces.push_back(corner);
      }
    }
  }
  const std::uint32_t cube = scene.add_mesh(corners, normals, faces);
  const auto at = [](float x, float y, float z, float size) {
    Affine there;
    there.rows[0] = {size, 0, 0, x}, there.rows[1] = {0, size, 0, y}, there.rows[2] = {0, 0, size, z};
    return there;
  };
  scene.add_object(cube, at(0, 0, 0, 0.1f));
  scene.add_object(cube, at(9.9f, 9.9f, 9.9f, 0.1f));
  scene.add_object(cube, at(6, 3, 7, 0.6f));              // the chamber
  scene.add_object(cube, at(6.15f, 3.15f, 7.15f, 0.3f));  // what it holds
  CellOptions many{.cell = 20}, few{.cell = 20, .rays = 400, .most_viewpoints = 600};
  const CellPvs cells = make_cells(scene, many);
  ASSERT_EQ(cells.size(), 1u);
  const partition::TriangleRays rays(scene);
  std::vector<ObjectId> visible;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    many.seed = few.seed = seed;
    ASSERT_TRUE(CellBaker(scene, rays, many).bake(cells, 0, visible));
    EXPECT_EQ(visible, (std::vector<ObjectId>{0, 1, 2, 3})) << seed;
    ASSERT_TRUE(CellBaker(scene, rays, few).bake(cells, 0, visible));
    found += visible.size() == 4;
  }
  EXPECT_LT(found, 4);  // as many rays from fewer viewpoints
}

TEST(Bake, RefusesTooManyCells) {
  const Scene scene = forest();
  EXPECT_THROW(make_cells(scene, {.cell = 1e-3f}), Error);
  EXPECT_THROW(make_cells(scene, {.cell = 0}), Error);
}

// Nobody knows what is seen from outside the cells: everything is drawn.
TEST(Baked, DrawsEverythingInViewOutsideItsCells) {
  Scene scene = forest();
  auto cells = std::make_shared<CellPvs>(make_cells(scene, kCoarse));
  scene.cells = cells;
  Frame baked, all;
  const View view = *make_view({.eye = {0, 500, 0}, .forward = {0, -1, 0}, .up = {1, 0, 0}}, 200, 200);
  cull(*create_method("baked", scene), view, baked);
  cull(*create_method("vfc-vc?bounds=box", scene), view, all);
  EXPECT_EQ(baked.visible.size(), scene.size());
  EXPECT_EQ(baked.visible.size(), all.visible.size());
}

}  // namespace
}  // namespace sightline::bake
