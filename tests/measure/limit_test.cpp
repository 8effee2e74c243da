// The limit beside which compare shows its methods: what the item buffer sees, and nothing else.
#include "device/fixtures.hpp"
#include "workbench/measure/compare.hpp"
#include "workbench/report/summary.hpp"

namespace sightline {
namespace {

using LimitTest = DeviceTest;

measure::MeasureOptions small_and_limited() {
  measure::MeasureOptions options;
  options.width = 160, options.height = 90;
  options.warm_up = 0, options.repeats = 1;
  options.limit = true;
  return options;
}

TEST_F(LimitTest, DrawsWhatTheItemBufferSeesAndNothingElse) {
  Scene scene = generate_world("irregular?spheres=600&size=80&detail=1");
  const std::vector<std::string> names{"none", "vfc-vc"};
  measure::Bench bench(scene, names, &device());
  const camera::CameraPath path = camera::make_path(scene, "near", 4);
  const measure::MeasureOptions options = small_and_limited();
  const measure::Comparison comparison = measure::compare(bench, path, options);
  ASSERT_EQ(comparison.methods, (std::vector<std::string>{"none", "vfc-vc", "(limit)"}));
  ASSERT_EQ(comparison.rows.size(), 12u);
  std::size_t limits = 0, differ = 0, last = 0;
  for (const measure::Row& row : comparison.rows) {
    if (row.method != measure::kLimit) continue;
    ++limits;
    const View view = view_of(path.cameras[row.view], 160, 90);
    const oracle::ItemBuffer seen = bench.oracle().look(view);
    std::uint64_t objects = 0, triangles = 0;
    for (ObjectId o = 0; o < scene.size(); ++o) {
      if (seen.pixels[o] == 0) continue;
      ++objects;
      triangles += scene.meshes[scene.mesh[o]].index_count / 3;
    }
    EXPECT_GT(objects, 10u);
    EXPECT_EQ(row.kept, objects);
    EXPECT_EQ(row.stats.triangles, triangles);
    EXPECT_EQ(row.lost_objects, 0u);
    EXPECT_EQ(row.excess_objects, 0u);
    EXPECT_EQ(row.guarantee, Guarantee::exact);
    ASSERT_TRUE(row.frame);
    EXPECT_GT(row.frame->median, 0);
    differ += objects != last, last = objects;
  }
  EXPECT_EQ(limits, 4u);
  EXPECT_GT(differ, 1u);  // so that a set kept from another view would show
}

TEST_F(LimitTest, IsLeftOutUnlessAskedForAndWhereObjectsMove) {
  Scene scene = generate_world("irregular?spheres=100&size=40&detail=1");
  const std::vector<std::string> names{"none"};
  measure::Bench bench(scene, names, &device());
  const camera::CameraPath path = camera::make_path(scene, "near", 1);
  measure::MeasureOptions options = small_and_limited();
  options.moving = 0.1;
  EXPECT_THROW(measure::compare(bench, path, options), Error);
  options.limit = false;
  EXPECT_EQ(measure::compare(bench, path, options).methods, names);
}

TEST(Limit, IsNoMethodToPickButOneToMeasureBy) {
  measure::Comparison comparison;
  comparison.device = "some device";
  comparison.methods = {"slow", "fast", "(limit)"};
  comparison.cameras.resize(3);
  const double frames[3][3] = {{12, 4, 2}, {30, 5, 3}, {8, 8, 4}};
  for (std::size_t v = 0; v < 3; ++v) {
    for (std::size_t m = 0; m < 3; ++m) {
      measure::Row row;
      row.method = comparison.methods[m];
      row.view = v;
      row.stats.objects = 100;
      row.kept = row.truly_visible = v == 2 ? 20 : 19;  // a fifth is not few any more
      row.frame = measure::Timing{frames[v][m], frames[v][m], frames[v][m]};
      comparison.rows.push_back(row);
    }
  }
  const std::string verdict = report::verdict(comparison);
  EXPECT_NE(verdict.find("Quickest on some device: fast, 5.67 ms a frame"), std::string::npos) << verdict;
  EXPECT_EQ(verdict.find("limit"), std::string::npos) << verdict;
  const report::Table ratios = report::ratio_table(comparison);
  ASSERT_EQ(ratios.rows.size(), 2u);
  EXPECT_EQ(ratios.rows[0], (std::vector<std::string>{"fast", "2", "4.50", "3.00", "6.00"}));
  EXPECT_EQ(ratios.rows[1], (std::vector<std::string>{"(limit)", "2", "8.00", "6.00", "10.00"}));
}

}  // namespace
}  // namespace sightline
