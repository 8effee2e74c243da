// Every number that the four papers print stands in their reproductions, once, in its own row and column.
#include "workbench/reproduce/published.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include <sightline/workbench/error.hpp>

#include "support/temporary_folder.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/reproduce/draw_calls/draw_calls.hpp"
#include "workbench/reproduce/object_frustum/object_frustum.hpp"
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"
#include "workbench/reproduce/reproduction.hpp"
#include "workbench/reproduce/vertex_chunk/vertex_chunk.hpp"

namespace sightline::reproduce {
namespace {

using Json = nlohmann::ordered_json;

std::string heading(std::string column) {
  std::ranges::replace(column, '_', ' ');
  return column;
}

bool says(const Json& published, const std::string& printed) {
  const auto number = number_of(printed);
  return number ? published.is_number() && published.get<double>() == *number : published == printed;
}

// How often the tables hold `printed` in the column, in rows whose keys are the CSV's row's.
int times_told(const Json& document, const Published& paper, const std::vector<std::string>& row,
               const std::set<std::string>& keys, std::size_t column) {
  int told = 0;
  for (const Json& table : document["tables"]) {
    if (keys.contains("table") && table["name"] != "table " + row[paper.column("table")]) continue;
    for (const Json& line : table["rows"]) {
      const bool same = std::ranges::all_of(keys, [&](const std::string& key) {
        const std::string& asked = row[paper.column(key)];
        return key == "table" || (asked.empty() && !line.contains(key)) ||
               (line.contains(key) && line[key] == asked);
      });
      if (!same) continue;
      const auto cell = line["cells"].find(heading(paper.header()[column]));
      told += cell != line["cells"].end() && cell->contains("published") &&
              says((*cell)["published"], row[column]);
    }
  }
  return told;
}

std::size_t published_cells(const Json& document) {
  std::size_t cells = 0;
  for (const Json& table : document["tables"]) {
    for (const Json& line : table["rows"]) {
      for (const Json& cell : line["cells"]) cells += cell.contains("published");
    }
  }
  return cells;
}

struct File {
  const char* name;
  std::set<std::string> keys;
};

// What was measured is left out: what is printed must stand there all the same. `derived` cells hold what
// follows from printed numbers.
void expect_whole(const Reproduction& reproduction, const std::vector<File>& files, std::size_t derived = 0) {
  const Json document = Json::parse(json(reproduction));
  std::size_t numbers = 0;
  for (const File& file : files) {
    const Published& paper = published(file.name);
    for (const auto& row : paper.rows()) {
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (row[c].empty() || file.keys.contains(paper.header()[c])) continue;
        ++numbers;
        EXPECT_EQ(times_told(document, paper, row, file.keys, c), 1)
            << file.name << ", " << row[0] << ": " << paper.header()[c] << " " << row[c];
      }
    }
  }
  EXPECT_EQ(published_cells(document), numbers + derived) << "a number that no file holds, or one told twice";
  EXPECT_GT(numbers, 10u);
}

TEST(Published, EveryNumberOfTheVertexChunksStandsInItsCell) {
  expect_whole(vertex_chunk_reproduction({}), {{"vertex_chunk", {"table", "world", "view", "method"}}});
}

TEST(Published, EveryNumberOfTheObjectFrustumStandsInItsCell) {
  expect_whole(object_frustum_reproduction({}), {{"object_frustum", {"run"}}},
               3);  // three ratios of its means
}

TEST(Published, EveryNumberOfTheDrawCallsStandsInItsCell) {
  expect_whole(draw_calls_reproduction({}), {{"draw_calls", {"triangles"}}, {"draw_calls_text", {"what"}}});
}

TEST(Published, EveryNumberOfTheRayPvsStandsInItsCell) {
  expect_whole(ray_pvs_reproduction({}), {{"ray_pvs_models", {"model"}}, {"ray_pvs_times", {"model"}}});
}

// What each paper has, as far as it is known here; what cannot be had is said to be missing.
TEST(Published, EveryTableAndFigureHasItsEntry) {
  const auto expect_entries = [](const Reproduction& reproduction, const std::vector<std::string>& wanted) {
    std::vector<std::string> entries;
    for (const PaperTable& table : reproduction.tables) entries.push_back(table.name);
    for (const PaperSection& section : reproduction.sections) entries.push_back(section.name);
    for (const std::string& name : wanted) {
      EXPECT_TRUE(std::ranges::any_of(entries, [&](const auto& entry) { return entry.starts_with(name); }))
          << reproduction.paper << ": " << name;
    }
  };
  expect_entries(vertex_chunk_reproduction({}), {"table 1", "table 2", "table 3", "table 4", "table 5",
                                                 "figure 2", "figure 7", "section 3.3", "text", "missing:"});
  expect_entries(object_frustum_reproduction({}),
                 {"table 2", "figures 1 and 2", "figure 4", "figure 6", "figure 7", "missing: Unity",
                  "missing: table 1, figures 3 and 5"});
  expect_entries(draw_calls_reproduction({}), {"table 1", "text", "figure 6", "figure 8", "figure 9",
                                               "figure 10", "missing: figures 1 to 5 and 7"});
  expect_entries(ray_pvs_reproduction({}),
                 {"table 4", "table 6, ready", "table 6, first PVS", "figure 6", "figure 11", "figure 12a",
                  "figure 12b", "figure 13", "break-time", "missing: the models",
                  "missing: tables 1 to 3 and 5, figures 1 to 5 and 7 to 10"});
}

TEST(Published, RefusesWhatIsNoTable) {
  EXPECT_THROW(Published("a,b\n1\n"), Error);
  EXPECT_THROW(static_cast<void>(published("nonesuch")), Error);
  const Published two("a,b\n1,2\n1,3\n");
  EXPECT_THROW(static_cast<void>(two.text({{"a", "1"}}, "b")), Error);
  EXPECT_THROW(static_cast<void>(two.text({{"b", "4"}}, "a")), Error);
  EXPECT_THROW(static_cast<void>(two.text({{"c", "4"}}, "a")), Error);
  EXPECT_EQ(two.text({{"b", "3"}}, "a"), "1");
}

TEST(Reproduction, TellsRatiosToItsBase) {
  PaperTable table;
  table.name = "table 9", table.title = "of nothing", table.keys = {"method"}, table.columns = {"ms"};
  table.rows = {{{"a"}, {{"4", 8.0, {}}}}, {{"b"}, {{"6", 2.0, {}}}}, {{"c"}, {{"", 1.0, {}}}}};
  EXPECT_FALSE(table.our_ratio(1, 0));
  table.base = PaperTable::Base::row;
  EXPECT_EQ(table.published_ratio(1, 0), 1.5);
  EXPECT_EQ(table.our_ratio(1, 0), 0.25);
  EXPECT_FALSE(table.published_ratio(2, 0));
  table.base_row = 1;
  EXPECT_EQ(table.our_ratio(0, 0), 4);
  table.base = PaperTable::Base::column;
  EXPECT_EQ(table.our_ratio(1, 0), 1);
  table.base = PaperTable::Base::row;
  const report::Table text = text_table(table);
  EXPECT_EQ(text.rows[0], (std::vector<std::string>{"a", "4 (0.67)", "8.00 (4.00)"}));
  EXPECT_EQ(text.rows[2], (std::vector<std::string>{"c", "–", "1.00 (0.50)"}));
}

TEST(Page, ChartsWhatThePaperPrintsAndOursAloneWhereItPrintsNothing) {
  PaperTable table;
  table.name = "table", table.keys = {"method"}, table.columns = {"speed", "excess"};
  table.rows = {{{"a"}, {{"4", 2, {}}, {"", 3, {}}}}, {{"b"}, {{"6", 3, {}}, {"", 5, {}}}}};
  const test::TemporaryFolder folder;
  const auto page_of = [&] {
    Reproduction one;
    one.tables = {table};
    write_reproduction(folder / "page", one);
    return io::read_file(folder / "page/index.html", 10'000'000);
  };
  EXPECT_THAT(page_of(), testing::AllOf(testing::HasSubstr("a: speed"), testing::HasSubstr("excess"),
                                        testing::Not(testing::HasSubstr("a: excess"))));
  for (PaperTable::Row& row : table.rows) row.cells[0].published.clear();
  EXPECT_THAT(page_of(), testing::AllOf(testing::HasSubstr("a: speed"), testing::HasSubstr("a: excess")));
  table.charted = false;
  EXPECT_THAT(page_of(),
              testing::AllOf(testing::HasSubstr("excess"), testing::Not(testing::HasSubstr("<canvas "))));
}

}  // namespace
}  // namespace sightline::reproduce
