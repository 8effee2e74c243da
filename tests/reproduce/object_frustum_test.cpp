// Le Hoang Minh et al. 2022: the figures' walks, what the cells' size decides, occlusion after the frustum,
// and every printed number in its own place.
#include "workbench/reproduce/object_frustum.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <sightline/workbench/worlds.hpp>

#include "workbench/camera/random_views.hpp"
#include "workbench/measure/verify.hpp"
#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {
namespace {

using Cells = std::vector<NumberedCell>;

// Figure 4, 4 × 5 cells: the limit lies in row 3, which is the last to be looked at.
TEST(ObjectFrustumWalks, SortFigure4) {
  const WalkFigure figure = walk_figure_4();
  EXPECT_EQ(figure.printed.inside, (Cells{{1, 3}, {2, 3}}));
  EXPECT_EQ(figure.printed.crossing, (Cells{{1, 2}, {1, 4}, {2, 1}, {2, 2}, {2, 4}, {2, 5}, {3, 3}}));
  // Of row 3 the printed walk keeps the cell straight ahead: the others lie within the angle, so the limits
  // miss them. 1.3 lies on both limits, and is taken for inside.
  EXPECT_EQ(figure.repaired.inside, (Cells{{2, 3}}));
  EXPECT_EQ(
      figure.repaired.crossing,
      (Cells{
          {1, 2}, {1, 3}, {1, 4}, {2, 1}, {2, 2}, {2, 4}, {2, 5}, {3, 1}, {3, 2}, {3, 3}, {3, 4}, {3, 5}}));
}

// Figure 6, 6 × 7 cells. The text deletes "1.1 and 1.6" and "2.7" at the left, "1.2 and 1.1" and "2.1" at the
// right: misprints, for by the figure's own numbering column 1 is at the left. Meant are 1.2, 1.1 and 2.1 at
// the left, 1.6, 1.7 and 2.7 at the right, and these both walks leave out.
TEST(ObjectFrustumWalks, SortFigure6) {
  const WalkFigure figure = walk_figure_6();
  for (const NumberedCell& cell : Cells{{1, 1}, {1, 2}, {2, 1}, {1, 6}, {1, 7}, {2, 7}}) {
    for (const CellLists* lists : {&figure.printed, &figure.repaired}) {
      EXPECT_FALSE(std::ranges::count(lists->inside, cell)) << cell.first << "." << cell.second;
      EXPECT_FALSE(std::ranges::count(lists->crossing, cell)) << cell.first << "." << cell.second;
    }
  }
  EXPECT_EQ(figure.printed.inside, (Cells{{1, 4}, {2, 4}, {3, 4}, {4, 4}}));
  EXPECT_EQ(figure.printed.crossing, (Cells{{1, 3}, {1, 5}, {2, 2}, {2, 3}, {2, 5}, {2, 6}, {5, 4}}));
  EXPECT_EQ(figure.repaired.inside,
            (Cells{{2, 4}, {3, 3}, {3, 4}, {3, 5}, {4, 2}, {4, 3}, {4, 4}, {4, 5}, {4, 6}}));
  EXPECT_EQ(figure.repaired.crossing,
            (Cells{{1, 3}, {1, 4}, {1, 5}, {2, 2}, {2, 3}, {2, 5}, {2, 6}, {3, 1}, {3, 2}, {3, 6},
                   {3, 7}, {4, 1}, {4, 7}, {5, 1}, {5, 2}, {5, 3}, {5, 4}, {5, 5}, {5, 6}, {5, 7}}));
}

TEST(ObjectFrustumWalks, AsPrintedLosesWhatShowsAndRepairedNothing) {
  Scene scene = object_frustum_scene();
  const std::vector<WalkLoss> losses = measure_walk_losses(scene, 160, 90);
  ASSERT_EQ(losses.size(), 4u);
  for (const WalkLoss& loss : losses) {
    EXPECT_GT(loss.missing, loss.kept / 4) << loss.height;
    EXPECT_EQ(loss.lost_repaired, 0u) << loss.height;
  }
  EXPECT_GT(losses.back().lost_objects, 50u);
  EXPECT_GT(losses.back().lost_pixels, 50u);
}

TEST(ObjectFrustumCells, TheirSizeDecidesWhatIsKept) {
  const Scene scene = object_frustum_scene();
  const std::vector<CellSize> sizes = sweep_cell_sizes(scene, 1280, 720);
  double least = 1e9, at_5_by_5 = 0;
  for (const CellSize& size : sizes) {
    const double ratio = CellSize::ratio(size.whole);
    least = std::min(least, ratio);
    if (size.rows == 5 && size.columns == 5) at_5_by_5 = ratio;
    EXPECT_LE(size.limited.object_frustum, 0.99 * size.whole.object_frustum) << "the limit acts";
    EXPECT_EQ(size.whole.object_frustum, sizes.front().whole.object_frustum);
  }
  EXPECT_LT(least, 1.35);  // at cells of 46 m
  EXPECT_GE(at_5_by_5, 1.9);
}

// In a city most of what is in view stands behind towers.
TEST(ObjectFrustumOcclusion, LosesNothingAndKeepsAtMostHalf) {
  Scene scene = generate_world("city?objects=2000");
  measure::Bench bench(scene, std::vector<std::string>{"object-frustum", "object-frustum?occlusion=masked"});
  std::vector<Camera> cameras = camera::random_cameras(scene, 20, 7);
  for (const Viewpoint& at : scene.viewpoints) cameras.push_back({.eye = at.eye, .forward = at.forward});
  for (const double moving : {0.0, 0.1}) {
    const measure::Verification result = measure::verify(bench, cameras, 160, 90, moving);
    for (const measure::MethodVerdict& method : result.methods) {
      EXPECT_EQ(method.guarantee, Guarantee::conservative);
      EXPECT_EQ(method.lost_objects, 0u) << method.method;
    }
    if (moving == 0) EXPECT_LE(2 * result.methods[1].kept, result.methods[0].kept);
  }
}

TEST(ObjectFrustumReproduction, HoldsEveryPublishedNumberEvenWithoutAMeasurement) {
  const auto page = nlohmann::json::parse(json(object_frustum_reproduction({})));
  const Published& csv = published("object_frustum");
  const auto& rows = page["tables"][0]["rows"];
  ASSERT_EQ(rows.size(), csv.rows().size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    EXPECT_EQ(rows[r]["run"], csv.rows()[r][0]);
    for (std::size_t c = 1; c < csv.header().size(); ++c) {
      std::string column = csv.header()[c];
      std::ranges::replace(column, '_', ' ');
      const auto& cell = rows[r]["cells"][column];
      EXPECT_EQ(cell["published"], *number_of(csv.rows()[r][c])) << column;
      EXPECT_FALSE(cell.contains("ours"));
    }
  }
  EXPECT_EQ(page["sentences"].size(), 3u);
  std::string names;
  for (const auto& section : page["sections"]) names += section["name"].get<std::string>() + "; ";
  for (const char* name :
       {"figures 1 and 2", "figure 4", "figure 6", "figure 7", "missing: Unity", "missing: table 1"})
    EXPECT_NE(names.find(name), std::string::npos) << name;
}

TEST(ObjectFrustumReproduction, ComputesRatiosOfTheAverages) {
  ObjectFrustumResult result;
  for (int run = 0; run < 10; ++run) result.runs.push_back({{30, 5, 20.0}, {20, 4, 10.0}});
  const Reproduction made = object_frustum_reproduction(result);
  const std::vector<PaperTable::Row>& ratios = made.tables[1].rows;
  EXPECT_EQ(ratios[0].cells[0].published, "1.45");
  EXPECT_EQ(ratios[1].cells[0].published, "1.97");
  EXPECT_DOUBLE_EQ(*ratios[0].cells[0].ours, 1.5);
  EXPECT_DOUBLE_EQ(*ratios[1].cells[0].ours, 2);
  EXPECT_NEAR(*ratios[2].cells[0].ours, 1 / 1.5, 1e-12);
  EXPECT_DOUBLE_EQ(*made.tables[0].rows[10].cells[0].ours, 30);
}

}  // namespace
}  // namespace sightline::reproduce
