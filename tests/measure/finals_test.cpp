// The finals of compare: those that may be the quickest take turns once more.
#include <algorithm>
#include <set>

#include "device/fixtures.hpp"
#include "workbench/measure/compare.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline {
namespace {

struct Entrant {
  const char* method;
  double frame_ms;
  std::uint64_t lost = 0;
  Guarantee guarantee = Guarantee::exact;
};

measure::Comparison comparison_of(std::span<const Entrant> entrants) {
  measure::Comparison out;
  out.device = "some device";
  for (const Entrant& entrant : entrants) out.methods.emplace_back(entrant.method);
  for (std::size_t view = 0; view < 2; ++view) {
    for (const Entrant& entrant : entrants) {
      measure::Row row;
      row.method = entrant.method;
      row.guarantee = entrant.guarantee;
      row.lost_objects = view == 1 ? entrant.lost : 0;
      row.frame = measure::Timing{entrant.frame_ms, entrant.frame_ms, entrant.frame_ms};
      out.rows.push_back(row);
    }
  }
  return out;
}

TEST(Finals, AreForThoseWhoLostNothingAndCameCloseAndTheLimit) {
  const std::vector<Entrant> entrants{{"slow", 14},
                                      {"close", 12},
                                      {"lossy", 5, 3},
                                      {"best", 10},
                                      {"approximate", 6, 0, Guarantee::approximate},
                                      {"(limit)", 2}};
  EXPECT_EQ(measure::finalists(comparison_of(entrants), 8), (std::vector<std::size_t>{3, 1, 5}));
  EXPECT_EQ(measure::finalists(comparison_of(entrants), 1), (std::vector<std::size_t>{3, 5}));
  const std::vector<Entrant> many(20, {"one of many", 10});
  EXPECT_EQ(measure::finalists(comparison_of(many), 8).size(), 8u);
  const std::vector<Entrant> none{{"lossy", 5, 3}, {"(limit)", 2}};
  EXPECT_TRUE(measure::finalists(comparison_of(none), 8).empty());
}

/// Draws all, and says when.
class Counted final : public Method {
public:
  Counted(const Scene& scene, Guarantee guarantee, std::size_t number, std::vector<std::size_t>& frames)
      : Method(scene), draw_list_(scene), guarantee_(guarantee), number_(number), frames_(frames) {}
  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_; }
  void do_update(std::span<const ObjectId>) override {}
  void do_record(FrameContext& context) override {
    frames_.push_back(number_);
    context.output.clear();
    for (ObjectId o = 0; o < scene_.size(); ++o) context.output.visible.push_back(o);
    draw_list_.build(scene_, context.view, context.output);
  }

private:
  submission::DrawList draw_list_;
  Guarantee guarantee_;
  std::size_t number_;
  std::vector<std::size_t>& frames_;
};

using FinalsTest = DeviceTest;

TEST_F(FinalsTest, AreFramesMore) {
  Scene scene = generate_world("irregular?spheres=300&size=40&detail=1");
  measure::Bench bench(scene, {}, &device());
  std::vector<std::size_t> frames;
  bench.add("a", std::make_unique<Counted>(scene, Guarantee::exact, 0, frames));
  bench.add("b", std::make_unique<Counted>(scene, Guarantee::exact, 1, frames));
  bench.add("c", std::make_unique<Counted>(scene, Guarantee::approximate, 2, frames));
  measure::MeasureOptions options;
  options.width = 96, options.height = 64;
  options.warm_up = 1, options.repeats = 2, options.timed_passes = 0, options.finals = 5;
  const measure::Comparison result = measure::compare(bench, camera::make_path(scene, "near", 2), options);
  const auto of = [&](std::size_t number) {
    return static_cast<std::size_t>(std::ranges::count(frames, number));
  };
  // A turn is two frames.
  const std::size_t without = 2 * (1 + 2 * 2), rounds[3]{2 * (1 + 2 * 5), 2 * (1 + 2 * 10), 2 * (1 + 2 * 20)};
  EXPECT_EQ(of(2), without);
  EXPECT_EQ(of(0), of(1));
  std::size_t finals = 0;
  for (std::size_t round = 0; round < 3 && of(0) > without + finals; ++round) finals += rounds[round];
  EXPECT_EQ(of(0), without + finals);
  ASSERT_EQ(result.rows.size(), 6u);
}

TEST(Turns, FollowEachOfTheOthers) {
  Scene scene = generate_world("irregular?spheres=30&size=40&detail=1");
  measure::Bench bench(scene, {});
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < 3; ++i)
    bench.add("one of three", std::make_unique<Counted>(scene, Guarantee::exact, i, frames));
  measure::MeasureOptions options;
  options.warm_up = 0, options.repeats = 20;
  (void)measure::compare(bench, camera::make_path(scene, "near", 1), options);
  ASSERT_EQ(frames.size(), 60u);
  std::set<std::pair<std::size_t, std::size_t>> followed;
  for (std::size_t i = 0; i < 60; i += 3) {
    const std::set<std::size_t> round(frames.begin() + i, frames.begin() + i + 3);
    EXPECT_EQ(round.size(), 3u);
    followed.emplace(frames[i], frames[i + 1]), followed.emplace(frames[i + 1], frames[i + 2]);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) EXPECT_TRUE(a == b || followed.contains({a, b})) << a << b;
  }
}

}  // namespace
}  // namespace sightline
