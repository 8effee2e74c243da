// What follows from the draw calls' measurements, and what the reproduction says of them.
#include "workbench/reproduce/draw_calls/draw_calls.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <sightline/workbench/io.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/temporary_folder.hpp"
#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"
#include "workbench/reproduce/draw_calls/least_squares.hpp"

namespace sightline::reproduce {
namespace {

using testing::HasSubstr;

TEST(LeastSquares, FindsCoefficientsWhateverTheirSize) {
  LeastSquares fit(4);
  for (int i = 0; i < 20; ++i) {
    const double x = 1e5 * i, y = 1e-4 * (i % 7);
    fit.add(std::array{1.0, x, y, 0.0}, 3 + 2e-6 * x - 500 * y);
  }
  const std::vector<double> found = fit.solve();
  EXPECT_NEAR(found[0], 3, 1e-9);
  EXPECT_NEAR(found[1], 2e-6, 1e-15);
  EXPECT_NEAR(found[2], -500, 1e-6);
  EXPECT_EQ(found[3], 0);  // no sample tells it
}

// A machine on which a frame takes 1 ms, a triangle 20 ns and a call 0.4 µs.
CallRates plain_machine() {
  CallRates rates = published_rates();
  rates.fps.clear();
  for (const double triangles : rates.triangles) {
    for (const double calls : rates.calls)
      rates.fps.push_back(1000 / (1 + 20e-6 * triangles + 0.4e-3 * calls));
  }
  return rates;
}

TEST(CallRates, TellWhatACallIsWorth) {
  const CallRates rates = plain_machine();
  EXPECT_NEAR(triangle_ns(rates), 20, 1e-9);
  for (const CallWorth& worth : calls_worth(rates)) {
    EXPECT_NEAR(worth.call_us, 0.4, 1e-9);
    EXPECT_NEAR(worth.triangles, 20, 1e-6);
  }
  EXPECT_NEAR(call_worth_of_all(rates).triangles, 20, 1e-6);
}

// "A call is worth eleven triangles" is one column of the paper's table.
TEST(CallRates, PublishedCallsAreWorthMoreWhereThereAreFew) {
  const std::vector<CallWorth> worth = calls_worth(published_rates());
  ASSERT_EQ(worth.size(), 5u);
  EXPECT_NEAR(worth[1].triangles, 813, 0.5);
  EXPECT_NEAR(worth[2].triangles, 94, 0.5);
  EXPECT_NEAR(worth[4].triangles, 11, 0.5);
  EXPECT_EQ(worth[4].calls, 100000);
}

TEST(RateFit, GoesThroughAPolynomial) {
  CallRates rates = published_rates();
  rates.fps.clear();
  const auto truth = [](double triangles, double calls) {
    const double n = triangles / 1e5, d = std::log10(calls);
    return 700 - 90 * n - 20 * d + 5 * n * n + 2 * n * d - 3 * d * d;
  };
  for (const double triangles : rates.triangles) {
    for (const double calls : rates.calls) rates.fps.push_back(truth(triangles, calls));
  }
  const RateFit fit(rates);
  EXPECT_NEAR(fit.determination(), 1, 1e-9);
  EXPECT_NEAR(fit.at(220000, 50), truth(220000, 50), 1e-6);
  ASSERT_TRUE(fit.calls_at(220000, truth(220000, 50)));
  EXPECT_NEAR(*fit.calls_at(220000, truth(220000, 50)), 50, 1e-3);
  EXPECT_FALSE(fit.calls_at(220000, 10000));
  EXPECT_LT(RateFit(published_rates()).determination(), 1);
}

TEST(Walks, BeginWithAFullTurnOnTheSpot) {
  const Scene scene = generate_world("regular?columns=8&rows=8&detail=0");
  const camera::CameraPath path = turn_and_walk(scene, 8, 5);
  ASSERT_EQ(path.cameras.size(), 13u);
  const Vec3 ahead = path.cameras[8].forward;
  for (int t = 0; t < 8; ++t) {
    const Camera& camera = path.cameras[static_cast<std::size_t>(t)];
    EXPECT_EQ(camera.eye, path.cameras[8].eye);
    const double cosine =
        (camera.forward.x * ahead.x + camera.forward.z * ahead.z) / (ahead.x * ahead.x + ahead.z * ahead.z);
    EXPECT_NEAR(cosine, std::cos(t * std::numbers::pi / 4), 1e-5) << t;
  }
}

TEST(StructureCounts, PrintedStructuresHaveMoreCellsAndCalls) {
  const Scene scene = generate_world("soup?triangles=3000&size=60&edge=0.5");
  const View view = *make_view({.eye = {0, 0, 0}}, 64, 64);
  const std::vector<StructureCount> counts = count_structures(scene, {view});
  ASSERT_EQ(counts.size(), 3u * kHighest * 3u);
  for (std::size_t c = 0; c < counts.size(); c += 3) {
    const StructureCount &printed = counts[c], &split = counts[c + 1], &ours = counts[c + 2];
    EXPECT_EQ(printed.rules, kPrintedCells);
    EXPECT_EQ(ours.rules, methods::kTightCells);
    EXPECT_LE(ours.made, split.made);
    EXPECT_LE(printed.made, printed.possible);
    EXPECT_LE(split.wise_calls, printed.wise_calls);
    EXPECT_GE(ours.ratio(), 1);
  }
  EXPECT_EQ(possible_cells("octree", 4), 4096);
}

/// A level where methods take so many milliseconds, calls and triangles by their height.
LevelWalk made_up_level() {
  LevelWalk walk;
  walk.level = "pak.pk3:maps/made_up.bsp", walk.kind = "small", walk.triangles = 1000, walk.views = 1;
  const auto add = [&](const std::string& method, std::uint32_t height, double ms, double calls,
                       double triangles) {
    WalkRow row;
    row.method = method, row.family = method.substr(0, method.find('?')), row.height = height;
    row.frame_ms = row.small_frame_ms = row.record_ms = ms, row.draw_calls = calls, row.triangles = triangles;
    row.objects = triangles == 100 ? 2 : 10;
    walk.rows.push_back(row);
  };
  add("none", 0, 10, 1, 1000);
  for (const auto variant : kWalkVariants) {
    for (const auto structure : kWalkStructures) {
      for (std::uint32_t height = 1; height <= kHighest; ++height) {
        const bool simple = variant == "simple";
        // Quickest at height 3.
        const std::string printed = fmt::format("{}-{}?height={}", variant, structure, height);
        const double ms = (simple ? 6 : variant == "zhang" ? 1.5 : 2) + std::fabs(height - 3.0);
        add(printed, height, ms, (simple ? 50.0 : 5.0) * height, variant == "zhang" ? 300 : 400);
        add(with_tight_cells(printed), height, ms - 1, 5, 200);
      }
    }
  }
  add("zhang-octree?height=4&facing=printed", 4, 2, 5, 200);
  add("drawcall-wise-octree?height=4&occlusion=masked", 4, 2, 5, 100);
  add("cluster-cone?submission=merged", 0, 2, 5, 150);
  for (const auto structure : kWalkStructures) {
    for (std::uint32_t height = 1; height <= kHighest; ++height) {
      for (const std::string_view rules : {kPrintedCells, kSplitCells, methods::kTightCells}) {
        const bool printed = rules == kPrintedCells;
        walk.counts.push_back({std::string(structure), height, std::string(rules), 1, printed ? 77.0 : 66.0,
                               printed ? 9.0 : 2.0, 5, (printed ? 7.0 : 5.0) * height, 400});
      }
    }
  }
  walk.lines = {{"none", {100, 120}}};
  walk.path.cameras.resize(2), walk.turn = 1;
  return walk;
}

const Cell& cell_of(const PaperTable& table, std::string_view key, std::size_t column) {
  for (const PaperTable::Row& row : table.rows) {
    if (row.keys[0] == key) return row.cells[column];
  }
  static const Cell none;
  return none;
}

TEST(DrawCallReproduction, SaysWhatWasMeasured) {
  DrawCallMeasurement measured;
  measured.rates = plain_machine();
  measured.walks = {made_up_level()};
  const Reproduction out = draw_calls_reproduction(measured);
  ASSERT_EQ(out.tables.size(), 2u);
  const Cell& cell = cell_of(out.tables[0], "300000", 2);
  EXPECT_EQ(cell.published, "149.34");
  EXPECT_DOUBLE_EQ(*cell.ours, measured.rates.at(4, 2));
  EXPECT_EQ(cell_of(out.tables[1], "best height over all scenes", 0).our_words, "3");
  EXPECT_EQ(cell_of(out.tables[1], "simple / others: draw calls", 0).ours, 8.4);
  EXPECT_DOUBLE_EQ(*cell_of(out.tables[1], "drawcall-wise and zhang / simple: fps", 0).ours, 7 / 2.5);
  EXPECT_EQ(cell_of(out.tables[1], "octree height 4 Manor: nodes created about", 0).our_words, "77");
  EXPECT_EQ(cell_of(out.tables[1], "octree height 4 Manor: nodes created about", 0).ours, 77);
  EXPECT_EQ(cell_of(out.tables[1], "octree Manor: nodes visited a frame mean", 0).our_words, "9");
  EXPECT_EQ(cell_of(out.tables[1], "zhang octree Manor: triangles culled more about", 0).our_words, "100");
  ASSERT_EQ(out.sentences.size(), 3u);
  EXPECT_THAT(out.sentences[1], HasSubstr("simple makes 10.0 to 10.0 × the calls"));
  EXPECT_THAT(out.sentences[1], HasSubstr("best height over all is 3"));
  EXPECT_THAT(out.sentences[2], HasSubstr("0.40 µs"));
  EXPECT_THAT(
      text(out),
      HasSubstr("With occlusion=masked 0.20 to 0.20 of the objects and 0.25 to 0.25 of the triangles"));
}

TEST(DrawCallReproduction, HasEveryFigureOfThePaperMeasuredOrNot) {
  const Reproduction empty = draw_calls_reproduction({});
  DrawCallMeasurement measured;
  measured.rates = plain_machine();
  measured.walks = {made_up_level()};
  for (const Reproduction& one : {empty, draw_calls_reproduction(measured)}) {
    std::set<std::string> names;
    for (const PaperTable& table : one.tables) names.insert(table.name);
    for (const PaperSection& section : one.sections) names.insert(section.name);
    for (const char* name : {"table 1", "text", "figure 6", "figure 8", "figure 9", "figure 10",
                             "text: 300,000 triangles in 100 calls", "text: what a call is worth",
                             "text: structures", "missing: figures 1 to 5 and 7"}) {
      EXPECT_TRUE(names.contains(name)) << name;
    }
  }
  EXPECT_EQ(empty.sentences[1], "Nothing was measured.");
}

TEST(DrawCallReproduction, EveryPictureThatThePageNamesLiesBesideIt) {
  DrawCallMeasurement measured;
  measured.walks = {made_up_level()};
  measured.walks[0].level = "pak1-maps.pk3:maps/ce1m7.bsp";
  measured.walks[0].path = turn_and_walk(load_scene(measured.walks[0].level), 2, 3);
  const test::TemporaryFolder folder;
  write_level_pictures(folder.path().string(), measured);
  const std::string html = levels_section(measured.walks).html;
  std::size_t named = 0;
  for (std::size_t at = html.find("src=\""); at != std::string::npos;
       at = html.find("src=\"", at + 5), ++named) {
    const std::string file = html.substr(at + 5, html.find('"', at + 5) - at - 5);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  }
  EXPECT_EQ(named, 5u);
}

}  // namespace
}  // namespace sightline::reproduce
