// Ye et al. 2023: its numbers in their places, with and without ours beside them.
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"

#include <gtest/gtest.h>

#include <sightline/workbench/worlds.hpp>

#include "workbench/device/device.hpp"
#include "workbench/reproduce/published.hpp"
#include "workbench/reproduce/ray_pvs/ray_views.hpp"

namespace sightline::reproduce {
namespace {

const PaperTable& table_of(const Reproduction& reproduction, std::string_view name) {
  for (const PaperTable& table : reproduction.tables) {
    if (table.name == name) return table;
  }
  throw std::runtime_error("no such table");
}

TEST(RayModels, HaveThePublishedMeshesAndTriangles) {
  const Published& models = published("ray_pvs_models");
  ASSERT_EQ(models.rows().size(), 5u);
  for (const auto& row : models.rows()) {
    const std::string& model = row[models.column("model")];
    const scene::StrataCount full = scene::count_strata("strata?full=yes&model=" + model);
    EXPECT_EQ(static_cast<double>(full.meshes), *number_of(row[models.column("meshes")])) << model;
    const double triangles = *number_of(row[models.column("triangles")]);
    EXPECT_NEAR(static_cast<double>(full.triangles), triangles, 0.01 * triangles) << model;
  }
}

// What counts the full models is what the small ones are made by.
TEST(RayModels, HoldWhatIsCounted) {
  for (const char* world : {"strata?triangles=20000", "strata?triangles=300000&model=2",
                            "strata?model=3&seed=7", "strata?triangles=400000&model=5"}) {
    const Scene scene = generate_world(world);
    const scene::StrataCount counted = scene::count_strata(world);
    EXPECT_EQ(counted.meshes, scene.meshes.size()) << world;
    EXPECT_EQ(counted.triangles, triangle_count(scene)) << world;
    EXPECT_EQ(counted.vertices, scene.positions.size()) << world;
  }
  EXPECT_NE(scene::count_strata("strata?model=3&seed=7").triangles,
            scene::count_strata("strata?model=3&seed=8").triangles);
}

TEST(RayModels, LieAroundTheOriginAtOneDistanceFromEveryViewpoint) {
  const Scene scene = generate_world("strata?triangles=20000");
  const Vec3 v = eye_around(scene, 0, 0);
  EXPECT_EQ(v, scene.viewpoints.back().eye);
  const Vec3 up = eye_around(scene, 0, 30), side = eye_around(scene, 90, 0);
  EXPECT_NEAR(up.y, 20000, 1);
  EXPECT_NEAR(side.z, 40000, 1);
  EXPECT_NEAR(side.x, 0, 1);
}

TEST(RayPvs, OfNothingMeasuredSaysWhatIsPublishedAndNothingElse) {
  const Reproduction empty = ray_pvs_reproduction({});
  EXPECT_EQ(empty.sentences.size(), 3u);
  const PaperTable& ready = table_of(empty, "table 6, ready");
  ASSERT_EQ(ready.rows.size(), 5u);
  EXPECT_EQ(ready.rows[3].keys, std::vector<std::string>{"4"});
  EXPECT_EQ(ready.rows[3].cells[kToca].published, "");
  EXPECT_EQ(ready.rows[3].cells[kBoca].published, "2591.6");
  EXPECT_NEAR(*ready.published_ratio(3, kSaa), 87.1 / 2591.6, 1e-9);
  EXPECT_EQ(table_of(empty, "table 6, ready: improvement").rows[3].cells[1].published, "96.64");
  EXPECT_EQ(table_of(empty, "table 4").rows[4].cells[1].published, "90415179");
  for (const PaperTable& table : empty.tables) {
    for (const PaperTable::Row& row : table.rows) {
      for (const Cell& cell : row.cells) {
        EXPECT_FALSE(cell.ours) << table.name;
        EXPECT_EQ(cell.our_words, "") << table.name;
      }
    }
  }
  EXPECT_FALSE(text(empty).empty());
}

TEST(RayPvs, TakesImprovementsAndRatiosToBoca) {
  RayPvs measured;
  measured.models.resize(1);
  RayPvsModel& model = measured.models.front();
  model.model = 4;
  model.ready[kBoca].cpu = 8, model.ready[kSaa].compute = 1.5, model.ready[kSaa].read_back = 0.5;
  model.ready[kIwcpa].compute = 16;
  model.first[kBoca].frame = 10, model.first[kSaa].made = 30;
  const Reproduction found = ray_pvs_reproduction(measured);
  const PaperTable& ready = table_of(found, "table 6, ready");
  EXPECT_EQ(ready.rows[3].cells[kSaa].ours, 2.0);
  EXPECT_EQ(ready.our_ratio(3, kIwcpa), 2.0);
  const PaperTable& better = table_of(found, "table 6, ready: improvement");
  EXPECT_EQ(better.rows[3].cells[0].ours, -100.0);
  EXPECT_EQ(better.rows[3].cells[1].ours, 75.0);
  EXPECT_FALSE(better.rows[0].cells[0].ours);
  EXPECT_EQ(table_of(found, "table 6, first PVS: improvement").rows[3].cells[1].ours, -200.0);
}

TEST(RayPvs, IsMeasuredWithAllMethodsAlike) {
  device::Device device;
  RayPvsOptions options;
  options.quick = true;
  options.rays = 30, options.width = 160, options.height = 90, options.triangles = 20000;
  std::vector<RayPicture> pictures;
  const RayPvsModel model = measure_ray_model(1, device, options, pictures);
  EXPECT_TRUE(pictures.empty());
  EXPECT_TRUE(model.identical);
  EXPECT_EQ(model.meshes, 1371u);
  EXPECT_GT(model.kept, 30u);
  EXPECT_LE(model.visible, model.kept + model.lost_objects);
  EXPECT_GT(model.lost_objects, 0u);
  for (std::size_t m = 0; m < kRayMethodCount; ++m) {
    EXPECT_GT(model.ready[m].total(), 0) << kRayMethods[m];
    EXPECT_GT(model.first[m].boxes, 0) << kRayMethods[m];
    EXPECT_GT(model.first[m].frame, 0) << kRayMethods[m];
    // Who works on the device sends something, and waits for it; who does not, does not.
    const bool on_device = m != kToca && m != kBoca;
    EXPECT_EQ(model.ready[m].compute > 0, on_device) << kRayMethods[m];
  }
}

TEST(RayPvs, LosesMoreTheFartherTheSetsAheadStandApart) {
  RayPvsOptions options;
  options.quick = true;
  options.rays = 50, options.width = 160, options.height = 90, options.triangles = 20000;
  const std::vector<BreakTime> found = measure_break_time(options);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].viewpoints, static_cast<std::size_t>(90 / found[i].spacing) + 1);
    EXPECT_EQ(found[i].cast_lost_pixels, found[0].cast_lost_pixels);
    EXPECT_GT(found[i].worst_share, 0);
    if (i == 0) continue;
    EXPECT_LT(found[i].bytes, found[i - 1].bytes);
    EXPECT_GT(found[i].between_lost_pixels, found[i - 1].between_lost_pixels);
  }
}

}  // namespace
}  // namespace sightline::reproduce
