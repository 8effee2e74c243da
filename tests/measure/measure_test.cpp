// Rows, their JSON, the table and the verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include <sightline/version.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/exact_methods.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/measure/comparison_json.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/report/table.hpp"

namespace sightline::measure {
namespace {

using test::FullDisk;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

Row row(std::string method, Guarantee guarantee, std::size_t view, double triangles, double ms,
        std::uint64_t lost = 0) {
  Row out;
  out.method = std::move(method), out.guarantee = guarantee, out.view = view;
  out.stats.objects = 100, out.stats.tested = 50, out.stats.draw_calls = 10;
  out.stats.triangles = static_cast<std::uint64_t>(triangles);
  out.kept = 30, out.truly_visible = 20, out.excess_objects = 10;
  out.cull = {ms, 0.5 * ms, 2 * ms};
  out.lost_objects = lost, out.lost_pixels = 7 * lost;
  return out;
}

Comparison two_views(std::vector<Row> rows) {
  Comparison comparison;
  comparison.scene = "world:test", comparison.path = "near";
  comparison.cameras.resize(2);
  for (const Row& r : rows) {
    if (r.view == 0) comparison.methods.push_back(r.method);
  }
  comparison.rows = std::move(rows);
  return comparison;
}

TEST(Timing, TypicalIsTheMeanOfTheQuickerFourFifths) {
  std::vector<double> ms{9, 1, 100, 3, 2, 100, 4, 5, 6, 10};
  EXPECT_DOUBLE_EQ(typical_of(ms), 5.0);
  std::vector<double> few{3, 1, 2};
  EXPECT_DOUBLE_EQ(typical_of(few), 2.0);
  EXPECT_EQ(typical_of({}), 0.0);
}

TEST(Timing, MedianLeastAndGreatest) {
  std::array<double, 5> odd{5, 1, 9, 3, 2};
  EXPECT_EQ(timing_of(odd).median, 3);
  EXPECT_EQ(timing_of(odd).min, 1);
  EXPECT_EQ(timing_of(odd).max, 9);
  std::array<double, 4> even{4, 1, 3, 2};
  EXPECT_EQ(timing_of(even).median, 2.5);
  EXPECT_EQ(timing_of({}).median, 0);
}

TEST(Measure, RowsOfEveryMethodAndViewWithEveryField) {
  Scene scene = generate_world("regular?columns=12&rows=12");
  Bench bench(scene, test::kExactMethods);
  MeasureOptions options;
  options.width = 96, options.height = 64, options.repeats = 3, options.warm_up = 1;
  std::size_t told = 0;
  const Comparison comparison =
      compare(bench, camera::make_path(scene, "near", 4), options, [&](std::size_t done, std::size_t all) {
        EXPECT_EQ(done, ++told);
        EXPECT_EQ(all, 4u);
      });
  EXPECT_EQ(told, 4u);
  ASSERT_EQ(comparison.rows.size(), 4 * bench.subjects().size());

  const TemporaryFolder folder;
  write_json(folder / "r.json", comparison);
  const auto json = nlohmann::json::parse(io::read_file(folder / "r.json", 10'000'000));
  EXPECT_EQ(json.at("sightline"), kVersion);
  EXPECT_EQ(json.at("device"), "cpu");
  for (const char* field : {"cpu", "cores", "memory", "os", "compiler"}) {
    EXPECT_TRUE(json.at("machine").contains(field)) << field;
  }
  ASSERT_EQ(json.at("rows").size(), comparison.rows.size());
  for (const auto& r : json.at("rows")) {
    for (const char* field :
         {"scene", "method", "guarantee", "view", "objects", "tested", "visible", "culled", "draw_calls",
          "triangles", "cull_vertices", "cull_cpu_ms", "cull_cpu_ms_min", "cull_cpu_ms_max", "lost_objects",
          "lost_pixels", "excess_objects"}) {
      ASSERT_TRUE(r.contains(field)) << field;
      EXPECT_FALSE(r.at(field).is_null()) << field;
    }
    for (const char* field : {"cull_gpu_ms", "frame_ms", "fps"}) {
      ASSERT_TRUE(r.contains(field)) << field;
      EXPECT_TRUE(r.at(field).is_null()) << field;
    }
    EXPECT_EQ(r.at("objects"), 144);
    EXPECT_EQ(r.at("visible").get<int>() + r.at("culled").get<int>(), 144);
    EXPECT_EQ(r.at("lost_objects"), 0);
    EXPECT_EQ(r.at("lost_pixels"), 0);
    EXPECT_EQ(r.at("excess_objects").get<int>() + r.at("truly_visible").get<int>(),
              r.at("visible").get<int>());
    EXPECT_LE(r.at("cull_cpu_ms_min"), r.at("cull_cpu_ms"));
    EXPECT_LE(r.at("cull_cpu_ms"), r.at("cull_cpu_ms_max"));
  }
}

TEST(Measure, SceneNamesThatAreNoUtf8MakeValidJson) {
  Comparison comparison =
      two_views({row("none", Guarantee::exact, 0, 1, 1), row("none", Guarantee::exact, 1, 1, 1)});
  comparison.scene = "b\xff\"d";
  const TemporaryFolder folder;
  write_json(folder / "r.json", comparison);
  const auto json = nlohmann::json::parse(io::read_file(folder / "r.json", 100'000));
  EXPECT_EQ(json.at("rows").at(0).at("scene"), "b\xef\xbf\xbd\"d");
}

TEST(Measure, FullDiskIsAnErrorAndLeavesNoFile) {
  std::vector<Row> rows;
  for (std::size_t v = 0; v < 200; ++v) rows.push_back(row("none", Guarantee::exact, v, 1, 1));
  const Comparison comparison = two_views(std::move(rows));
  const TemporaryFolder folder;
  {
    const FullDisk full(4096);
    EXPECT_THROW(write_json(folder / "r.json", comparison), Error);
  }
  EXPECT_EQ(folder.files(), 0u);
  EXPECT_THROW(write_json("/dev/full", comparison), Error);
}

TEST(Summary, MeansOfCountsSumsOfLosses) {
  const std::vector<report::MethodSummary> sums = report::summarise(two_views(
      {row("a", Guarantee::approximate, 0, 100, 1, 2), row("a", Guarantee::approximate, 1, 300, 3, 1)}));
  ASSERT_EQ(sums.size(), 1u);
  EXPECT_EQ(sums[0].triangles, 200);
  EXPECT_EQ(sums[0].lost_objects, 3u);
  EXPECT_EQ(sums[0].lost_pixels, 21u);
  EXPECT_EQ(sums[0].views_with_loss, 2u);
  EXPECT_EQ(sums[0].cull.median, 2);
  EXPECT_EQ(sums[0].cull.min, 0.5);
  EXPECT_EQ(sums[0].cull.max, 6);
}

TEST(Verdict, WithoutFramesNamesThoseThatNobodyBeats) {
  std::vector<Row> rows;
  for (std::size_t v = 0; v < 2; ++v) {
    rows.push_back(row("everything", Guarantee::exact, v, 9e6, 0.01));
    rows.push_back(row("slow-but-tight", Guarantee::conservative, v, 1e6, 2));
    rows.push_back(row("cheap", Guarantee::conservative, v, 2e6, 0.1));
    rows.push_back(row("beaten", Guarantee::conservative, v, 2e6, 0.2));
    rows.push_back(row("liar", Guarantee::conservative, v, 1000, 0.1, 3));
    rows.push_back(row("lucky", Guarantee::approximate, v, 500, 0.1));
  }
  const Comparison comparison = two_views(std::move(rows));
  const std::string text = report::verdict(comparison);
  EXPECT_THAT(text, HasSubstr("together: everything, slow-but-tight, cheap."));
  EXPECT_THAT(text, HasSubstr("A defect: liar promises to be conservative and lost 42 pixels in 2 views."));
  EXPECT_THAT(text, HasSubstr("Nothing was drawn"));
  EXPECT_LE(std::ranges::count(text, '\n'), 2);
  const report::Table table = report::summary_table(comparison);
  std::string marks;
  for (const auto& line : table.rows) marks += line.back().empty() ? "-" : "x";
  EXPECT_EQ(marks, "xxx---");
}

TEST(Verdict, OfDrawnFramesNamesTheQuickestOrTwo) {
  const auto drawn = [](double first, double second, double spread) {
    std::vector<Row> rows;
    for (const auto& [name, ms] :
         {std::pair{"first", first}, {"second", second}, {"third", 20.0}, {"lucky", 1.0}}) {
      rows.push_back(row(name, name[0] == 'l' ? Guarantee::approximate : Guarantee::exact, 0, 1e6, 1));
      rows.back().frame = Timing{ms, ms - spread, ms + 5};
    }
    Comparison comparison = two_views(std::move(rows));
    comparison.device = "llvmpipe";
    return report::verdict(comparison);
  };
  EXPECT_THAT(drawn(10, 12, 0.5), HasSubstr("Quickest on llvmpipe: first, 10.0 ms a frame"));
  EXPECT_THAT(drawn(10, 12, 0.5), HasSubstr("\nNext: second, at 1.20 times that."));
  EXPECT_THAT(drawn(10.2, 10, 0.5), HasSubstr("Quickest on llvmpipe: second and first, 10.0 and 10.2 ms"));
  EXPECT_THAT(drawn(10.2, 10, 0.5), HasSubstr("\nNext: third, at 2.00 times that."));
}

TEST(Verdict, NamesNoneWhereAllLost) {
  const std::string text = report::verdict(two_views({row("liar", Guarantee::exact, 0, 1, 1, 1)}));
  EXPECT_THAT(text, HasSubstr("No method both promised"));
  EXPECT_THAT(text, HasSubstr("A defect: liar"));
}

TEST(Table, AlignsByCodePoints) {
  report::Table table;
  table.header = {"näme", "x"};
  table.rows = {{"a\u0301bc", "1"}, {"–", "1,000"}, {"short"}};
  EXPECT_EQ(report::render(table),
            "näme       x\n"
            "─────  ─────\n"
            "a\u0301bc        1\n"
            "–      1,000\n"
            "short\n");
}

TEST(Table, FormatsFigures) {
  EXPECT_EQ(report::format_count(0), "0");
  EXPECT_EQ(report::format_count(999), "999");
  EXPECT_EQ(report::format_count(1234567), "1,234,567");
  EXPECT_EQ(report::format_count(12.34), "12.3");
  EXPECT_EQ(report::format_count(123.6), "124");
  EXPECT_EQ(report::format_ms(0), "0");
  EXPECT_EQ(report::format_ms(0.01234), "0.0123");
  EXPECT_EQ(report::format_ms(1.234), "1.23");
  EXPECT_EQ(report::format_ms(123.4), "123");
  EXPECT_EQ(report::format_ms(12345.6), "12346");
}

TEST(Table, SummaryHasALineAMethod) {
  const Comparison comparison =
      two_views({row("a", Guarantee::exact, 0, 1000, 1), row("b", Guarantee::approximate, 0, 10, 1, 4),
                 row("a", Guarantee::exact, 1, 1000, 1), row("b", Guarantee::approximate, 1, 10, 1, 4)});
  const report::Table table = report::summary_table(comparison);
  ASSERT_EQ(table.rows.size(), 2u);
  for (const auto& cells : table.rows) EXPECT_EQ(cells.size(), table.header.size());
  EXPECT_EQ(table.rows[1][7], "8");
  EXPECT_EQ(table.rows[1][8], "56");
}

}  // namespace
}  // namespace sightline::measure
