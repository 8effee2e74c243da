// Several views of a world at once beside one of them: a camera that looks about, there and back in 600
// frames. Frame by frame all take turns, as a renderer's work comes between two culls: none finds what it
// read last in the nearest cache.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <sightline/world.hpp>

#include "judged.hpp"
#include "thread_time.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr std::size_t kFrames = 600;

// Where its views look, in widths of a view.
struct Pattern {
  const char* name;
  std::array<float, 4> turns;
  std::size_t views = 4;
};
constexpr std::array kPatterns{Pattern{"one_view", {0}, 1},
                               // Any two of the four share at least half of what they see.
                               Pattern{"four_views_sharing_half", {0, 1.0f / 6, 2.0f / 6, 3.0f / 6}},
                               // Two and two the same, the pairs sharing half.
                               Pattern{"four_views_in_two_pairs", {0, 1.0f / 2, 0, 1.0f / 2}},
                               // Each shares half with the next, and nothing with the one after that.
                               Pattern{"four_views_in_a_fan", {0, 1.0f / 2, 2.0f / 2, 3.0f / 2}}};

// What is asked and answered of a pattern.
class Asked {
public:
  explicit Asked(const Pattern& pattern)
      : pattern_(pattern),
        visible_(cull_capacity(case_of(1'000'000).world)),
        masks_(pattern.views > 1 ? visible_.size() : 0) {}

  void look(float heading) {
    const float fov = tenth_of_view(), across = 2 * std::atan(std::tan(fov / 2) * 1280 / 720);
    views_.clear(), asked_.clear();
    for (std::size_t v = 0; v < pattern_.views; ++v) {
      views_.push_back(looking(heading + pattern_.turns[v] * across, fov));
      asked_.push_back({.view = {views_.back(), {}}});
    }
  }

  double cull() {
    const auto once = [&] {
      count_ = culler_.cull(case_of(1'000'000).world, asked_, {}, {visible_, masks_})->count;
    };
    return milliseconds(once);
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  void judge_last(benchmark::State& state) const {
    judge(state, case_of(1'000'000).flat, views_, std::span(visible_).first(count_));
    if (state.counters["lost"] > 0 || state.counters["excess"] > 10) state.SkipWithError("a wrong answer");
  }

private:
  const Pattern& pattern_;
  std::vector<View> views_;
  std::vector<CullView> asked_;
  std::vector<ObjectId> visible_;
  std::vector<std::uint8_t> masks_;
  Culler culler_;
  std::size_t count_ = 0;
};

// The means over all frames of each pattern's time and of how many it sees.
struct Means {
  std::array<double, kPatterns.size()> milliseconds{}, visible{};
};

// Every run does the same work frame by frame: what a frame took beyond the least of the runs, the machine
// did.
Means race(std::span<Asked> asked) {
  constexpr int kRuns = 2;
  Means out;
  std::array<std::array<double, kPatterns.size()>, kFrames> least;
  for (auto& frame : least) frame.fill(1e9);
  for (int run = 0; run < kRuns; ++run) {
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
      const float turned = 2 * std::numbers::pi_v<float> * static_cast<float>(frame) / kFrames,
                  heading = 0.3f + 0.1f * std::sin(turned);
      for (std::size_t turn = 0; turn < kPatterns.size(); ++turn) {
        const std::size_t p = (frame + turn) % kPatterns.size();
        asked[p].look(heading);
        least[frame][p] = std::min(least[frame][p], asked[p].cull());
        out.visible[p] += static_cast<double>(asked[p].count()) / (kRuns * kFrames);
      }
    }
  }
  for (const auto& frame : least)
    for (std::size_t p = 0; p < kPatterns.size(); ++p) out.milliseconds[p] += frame[p] / kFrames;
  return out;
}

// Each repetition of a pattern tells of a race of its own, in which all of them ran.
void views(benchmark::State& state, std::size_t pattern) {
  static std::vector<Asked> asked(kPatterns.begin(), kPatterns.end());
  static std::vector<Means> races;
  static std::array<std::size_t, kPatterns.size()> told{};
  const std::size_t number = told[pattern]++;
  if (number == races.size()) races.push_back(race(asked));
  asked[pattern].judge_last(state);
  state.counters["visible"] = races[number].visible[pattern];
  for (auto _ : state) state.SetIterationTime(races[number].milliseconds[pattern] / 1e3);
}

const bool registered = [] {
  for (std::size_t p = 0; p < kPatterns.size(); ++p) {
    benchmark::RegisterBenchmark(kPatterns[p].name, views, p)
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace sightline::benchmarks
