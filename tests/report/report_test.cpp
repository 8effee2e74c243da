// The report: its files, that the page needs nothing else, and that no name breaks it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <regex>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/exact_methods.hpp"
#include "support/full_disk.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/report/canvas.hpp"
#include "workbench/report/page.hpp"
#include "workbench/report/page_folder.hpp"
#include "workbench/report/pictures.hpp"
#include "workbench/report/report.hpp"
#include "workbench/report/top_view.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::report {
namespace {

using report::Canvas;
using report::escape;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

struct Material {
  Scene scene = generate_world("regular?columns=12&rows=12");
  measure::Bench bench{scene, test::kExactMethods};
  measure::Comparison comparison;
  Snapshot snapshot;

  Material() {
    measure::MeasureOptions options;
    options.width = 96, options.height = 54, options.repeats = 1, options.warm_up = 0;
    comparison = measure::compare(bench, camera::make_path(scene, "near", 3), options);
    const std::size_t view = picture_view(comparison);
    snapshot = take_snapshot(bench, comparison, view, 192, 108);
  }
};

TEST(Report, WritesAPageThatLoadsNothingFromElsewhere) {
  const Material m;
  const TemporaryFolder folder;
  write_report(folder / "new/report", m.comparison, m.scene, m.snapshot);
  const std::string page = io::read_file(folder / "new/report/index.html", 10'000'000);
  const std::regex reference(R"((src|href|action|data)\s*=\s*"([^"]*)\")");
  std::size_t pictures = 0;
  const std::string markup = page.substr(0, page.find("<script"));
  for (std::sregex_iterator it(markup.begin(), markup.end(), reference), end; it != end; ++it) {
    const std::string target = (*it)[2];
    EXPECT_THAT(target, Not(HasSubstr(":"))) << target;
    const std::string bytes = io::read_file(folder / ("new/report/" + target), 10'000'000);
    EXPECT_THAT(bytes, testing::AnyOf(testing::StartsWith("\x89PNG"), testing::StartsWith("<svg ")));
    ++pictures;
  }
  EXPECT_EQ(pictures, 1 + test::kExactMethods.size());
  for (const char* loader :
       {"<link", "@import", "url(", "<script src", "<iframe", "fetch(", "XMLHttpRequest"}) {
    EXPECT_THAT(page, Not(HasSubstr(loader)));
  }
  EXPECT_THAT(page, HasSubstr("Chart.js v3"));
  EXPECT_THAT(page, HasSubstr("Beaten by no other"));
  for (const std::string& method : test::kExactMethods)
    EXPECT_THAT(page, HasSubstr("<td>" + method + "<td>"));
}

// Whatever the picture's size.
TEST(Report, PicturesShowWhatTheTableCounts) {
  const Material m;
  for (const measure::Row& row : m.comparison.rows) {
    if (row.view != m.snapshot.index) continue;
    const auto of = std::ranges::find(m.snapshot.methods, row.method, &Snapshot::Method::name);
    ASSERT_NE(of, m.snapshot.methods.end());
    const auto count = [&](Outcome outcome) { return of->counts[static_cast<std::size_t>(outcome)]; };
    EXPECT_EQ(count(Outcome::visible) + count(Outcome::excess), row.kept) << row.method;
    EXPECT_EQ(count(Outcome::visible) + count(Outcome::lost), row.truly_visible) << row.method;
  }
  EXPECT_NE(m.snapshot.truth.visible_count(), m.comparison.rows[0].truly_visible)
      << "sizes tell no difference";
}

TEST(Report, NamesAreEscapedEverywhere) {
  Material m;
  const std::string evil = "</script><script>alert(1)</script>&\"'";
  m.comparison.scene = m.comparison.path = evil;
  m.comparison.methods[0] = m.snapshot.methods[0].name = evil;
  for (measure::Row& row : m.comparison.rows) {
    if (row.method == "none") row.method = evil;
  }
  const std::string page = report::make_page({m.comparison, m.scene, m.snapshot, "i.png",
                                              std::vector<std::string>(m.snapshot.methods.size(), "t.png")});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>a")));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;&#39;"));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
}

TEST(Report, EscapeKeepsTextAndReplacesWhatIsNotUtf8) {
  EXPECT_EQ(escape("grün – 日本 😀"), "grün – 日本 😀");
  EXPECT_EQ(escape("a\xff"
                   "b"),
            "a\xef\xbf\xbd"
            "b");
  EXPECT_EQ(escape("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(escape("\xc0\xaf"), "\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(Report, FullDiskOrAFileInTheWayIsAnError) {
  const Material m;
  const TemporaryFolder folder;
  {
    const test::FullDisk full(2000);
    EXPECT_THAT(test::refusal([&] { write_report(folder / "full", m.comparison, m.scene, m.snapshot); }),
                testing::StartsWith((folder / "full/item-buffer.png: cannot be written").string()));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "full"));
  io::write_file(folder / "file", "in the way");
  EXPECT_THROW(write_report(folder / "file", m.comparison, m.scene, m.snapshot), Error);
  EXPECT_THROW(write_report(folder / "file/below", m.comparison, m.scene, m.snapshot), Error);
}

// A report of fewer methods leaves nothing of one of more; and what is no report of ours is left alone.
TEST(Report, ReplacesAnEarlierOneWholeAndNothingElse) {
  Material m;
  const TemporaryFolder folder;
  write_report(folder / "page", m.comparison, m.scene, m.snapshot);
  const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder / "page"), {}); };
  const auto before = files();
  {
    const test::FullDisk full(2000);
    EXPECT_THROW(write_report(folder / "page", m.comparison, m.scene, m.snapshot), Error);
  }
  EXPECT_EQ(files(), before) << "the earlier report stays whole";
  m.snapshot.methods.pop_back();
  write_report(folder / "page", m.comparison, m.scene, m.snapshot);
  EXPECT_EQ(files(), before - 1);
  std::filesystem::create_directory(folder / "mine");
  io::write_file(folder / "mine/letter", "dear");
  EXPECT_THROW(write_report(folder / "mine", m.comparison, m.scene, m.snapshot), Error);
  EXPECT_EQ(io::read_file(folder / "mine/letter", 100), "dear");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2)
      << "nothing unfinished stays";
}

// A folder that is mounted has another file system beside it, from which nothing can be renamed into it.
TEST(PageFolder, HoldsAllThatIsNotFinishedItself) {
  const TemporaryFolder folder;
  const auto beside = [&] { return std::distance(std::filesystem::directory_iterator(folder.path()), {}); };
  const auto others = folder / "page/.sightline-1-0.tmp";  // at work, too, or killed
  std::filesystem::create_directories(others);
  {
    PageFolder page(folder / "page");
    EXPECT_EQ(beside(), 1);
    io::write_file(page.path() / "index.html", "new");
    page.commit();
  }
  EXPECT_EQ(io::read_file(folder / "page/index.html", 100), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "page"), {}), 2);
  EXPECT_TRUE(std::filesystem::exists(others));
  EXPECT_EQ(beside(), 1);
}

// A pipe that nobody writes would be waited for.
TEST(PageFolder, APipeIsNoPage) {
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder / "index.html";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int open_end = open(pipe.c_str(), O_RDWR);
  std::string mark = kPageMark;
  mark.resize(4096, ' ');
  ASSERT_EQ(write(open_end, mark.data(), mark.size()), 4096);
  EXPECT_THAT(test::refusal([&] { PageFolder(folder.path()); }), HasSubstr("an earlier page of ours"));
  close(open_end);
}

TEST(PageFolder, ReplacesAPageAndNothingElse) {
  const TemporaryFolder folder;
  const auto put = [&](const std::string& picture) {
    PageFolder page(folder / "page");
    io::write_file(page.path() / "index.html", kPageMark + ("<img src=\"" + picture + "\">"));
    io::write_file(page.path() / picture, "seen");
    page.commit();
  };
  put("old.png");
  std::filesystem::create_directory(folder / "page/mine");
  for (const char* name : {"page/notes.txt", "page/mine/old.png", "page/photo.png"})
    io::write_file(folder / name, "mine");
  put("new.png");
  EXPECT_FALSE(std::filesystem::exists(folder / "page/old.png"));
  EXPECT_EQ(io::read_file(folder / "page/new.png", 100), "seen");
  for (const char* name : {"page/notes.txt", "page/mine/old.png", "page/photo.png"})
    EXPECT_EQ(io::read_file(folder / name, 100), "mine") << name;
}

TEST(Snapshot, OutcomesAddUpAndAgreeWithTheTruth) {
  Material m;
  const View compared = *make_view(m.snapshot.camera, m.comparison.width, m.comparison.height);
  const oracle::ItemBuffer truth = m.bench.oracle().look(compared);
  for (const Snapshot::Method& method : m.snapshot.methods) {
    ASSERT_EQ(method.outcomes.size(), m.scene.size());
    std::array<std::size_t, kOutcomes> counts{};
    for (ObjectId object = 0; object < m.scene.size(); ++object) {
      const Outcome outcome = method.outcomes[object];
      ++counts[static_cast<std::size_t>(outcome)];
      EXPECT_EQ(truth.sees(object), outcome == Outcome::visible || outcome == Outcome::lost);
    }
    EXPECT_EQ(counts, method.counts);
    EXPECT_EQ(counts[static_cast<std::size_t>(Outcome::lost)], 0u);
  }
  EXPECT_EQ(m.snapshot.methods[0].counts[static_cast<std::size_t>(Outcome::culled)], 0u);
}

TEST(PictureView, ShowsTheLossWhereThereIsOne) {
  Material m;
  const std::size_t calm = picture_view(m.comparison);
  const std::size_t other = (calm + 1) % 3;
  for (measure::Row& row : m.comparison.rows) {
    if (row.view == other) row.lost_pixels = 3;
  }
  EXPECT_EQ(picture_view(m.comparison), other);
}

TEST(Pictures, ItemBufferIsClearWhereNothingIsAndColouredByObject) {
  const Material m;
  const Canvas picture = report::draw_item_buffer(m.snapshot.view, m.snapshot.truth);
  EXPECT_EQ(picture.width(), 96u);
  EXPECT_EQ(picture.height(), 54u);
  std::size_t clear = 0, solid = 0;
  for (std::uint32_t y = 0; y < 54; ++y) {
    for (std::uint32_t x = 0; x < 96; ++x) {
      bool any = false, all = true;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const bool hit = m.snapshot.truth.ids[(2 * y + i / 2) * 192 + 2 * x + i % 2] != kNoObject;
        any |= hit, all &= hit;
      }
      EXPECT_EQ(picture.at(x, y).a == 0, !any);
      EXPECT_EQ(picture.at(x, y).a == 255, all);
      clear += !any, solid += all;
    }
  }
  EXPECT_GT(clear, 100u);
  EXPECT_GT(solid, 100u);
}

TEST(Pictures, TopViewShowsALostObjectInItsColour) {
  Scene scene = generate_world("regular?columns=3&rows=3&spacing=10");
  Snapshot snapshot;
  snapshot.camera.eye = {0, 1, 30};
  snapshot.view = or_throw(make_view(snapshot.camera, 64, 36));
  Snapshot::Method method{"m", std::vector<Outcome>(9, Outcome::culled), {}};
  const auto drawn = [&] { return report::draw_top_view(scene, snapshot, method, 300); };
  const std::string lost = "fill=\"#de265c\"";
  EXPECT_THAT(drawn(), Not(HasSubstr(lost)));
  method.outcomes[0] = Outcome::lost;
  EXPECT_THAT(drawn(), HasSubstr(lost));
  EXPECT_THAT(drawn(), testing::MatchesRegex("<svg .* width=\"[0-9]+\" .*</svg>\n"));
}

// What lies beneath is hidden by the page's own colour first: blue on amber would be some grey, as what is
// culled.
TEST(Pictures, TopViewBlendsNoTwoOutcomes) {
  Scene scene = generate_world("regular?columns=30&rows=30&spacing=10");
  Snapshot snapshot;
  snapshot.view = or_throw(make_view({}, 64, 36));
  Snapshot::Method method{"m", std::vector<Outcome>(scene.size(), Outcome::culled), {}};
  for (std::size_t i = 0; i < kOutcomes; ++i) method.outcomes[i] = static_cast<Outcome>(i);
  const std::string svg = report::draw_top_view(scene, snapshot, method, 300);
  std::size_t at = 0;
  for (const char* colour : {"#949ca8", "#e29e26", "#2084d0", "#de265c"}) {
    const std::size_t cleared = svg.find("<g fill=\"Canvas\" ", at);
    at = svg.find(std::string("fill=\"") + colour, at);
    ASSERT_NE(at, std::string::npos) << colour << ", or in another order";
    EXPECT_LT(cleared, at) << colour;
  }
  EXPECT_THAT(svg, HasSubstr("color-scheme:light dark")) << "the page's colour is its reader's";
}

// The ground of a city is visible, and much that stands on it is kept in vain.
TEST(Pictures, TopViewDrawsGroundBeneathWhatStandsOnIt) {
  Scene scene;
  for (const float half : {100.0f, 8.0f, 1.0f}) {
    scene.mesh.push_back(0);
    scene.bounds.push_back({{-half, 0, -half}, {half, 1, half}});
  }
  Snapshot snapshot;
  snapshot.view = or_throw(make_view({}, 64, 36));
  const Snapshot::Method method{"m", {Outcome::culled, Outcome::visible, Outcome::excess}, {}};
  const std::string svg = report::draw_top_view(scene, snapshot, method, 300);
  const std::size_t ground = svg.find("fill=\"#2084d0"), kept = svg.find("fill=\"#e29e26");
  ASSERT_NE(kept, std::string::npos);
  EXPECT_LT(ground, kept);
  EXPECT_LT(kept, svg.find("fill=\"none\" stroke=\"#949ca8")) << "what covers all is an outline";
}

// On a narrow page they are the ones that are seen.
TEST(Report, TableBeginsWithPromisesAndLosses) {
  const Material m;
  const std::string page = report::make_page({m.comparison, m.scene, m.snapshot, "i.png",
                                              std::vector<std::string>(m.snapshot.methods.size(), "t.png")});
  EXPECT_THAT(page, HasSubstr("<tr><th>method<th>guarantee<th>lost objects<th>lost pixels<th>kept<th>"));
  EXPECT_THAT(page, HasSubstr("<tr><td>none<td>exact<td class=\"good\">0<td class=\"good\">0<td>144<td>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"hint\" hidden>"));
  // Rules beneath a cell that stays in sight while the others scroll are not drawn where borders are one.
  EXPECT_THAT(page, HasSubstr("border-collapse: separate"));
}

TEST(Pictures, TopViewOfManyObjectsStaysSmall) {
  Scene scene;
  scene::Random random(1);
  for (int i = 0; i < 300'000; ++i) {
    const Vec3 low = random.inside({{-500, 0, -500}, {500, 9, 500}});
    scene.mesh.push_back(0);
    scene.bounds.push_back({low, {low.x + 4 * random.unit(), low.y + 1, low.z + 4 * random.unit()}});
  }
  Snapshot snapshot;
  snapshot.view = or_throw(make_view({}, 64, 36));
  Snapshot::Method method{"m", {}, {}};
  for (std::size_t i = 0; i < scene.bounds.size(); ++i)
    method.outcomes.push_back(static_cast<Outcome>(i % 2 * 2));
  const std::string svg = report::draw_top_view(scene, snapshot, method, 900);
  EXPECT_LT(svg.size(), 2'000'000u);
  EXPECT_GT(svg.size(), 100'000u);
}

TEST(Pictures, BoxesBecomeAPathThatHoldsThem) {
  EXPECT_EQ(report::path_of({{3, 4, 5, 9}, {1, 2, 1, 2}, {3, 4, 5, 9}}, 9), "m1 2h1v1h-1zm2 2h2v5h-2z");
  EXPECT_EQ(report::path_of({{-3, -1, 5, 7}, {-4, -2, 6, 8}}, 1), "m-4 -2h10v10h-10z");
}

TEST(Canvas, CutsOffWhatLiesOutside) {
  Canvas canvas(8, 8);
  canvas.fill_rectangle(-100, -100, -50, -50, {255, 0, 0, 255});
  canvas.line(-1e6f, 4, 1e6f, 4, 2, {0, 255, 0, 255});
  canvas.disc(1e9f, 1e9f, 10, {0, 0, 255, 255});
  EXPECT_EQ(canvas.at(0, 0).a, 0);
  EXPECT_EQ(canvas.at(7, 4).g, 255);
  EXPECT_EQ(canvas.at(7, 7).a, 0);
}

}  // namespace
}  // namespace sightline::report
