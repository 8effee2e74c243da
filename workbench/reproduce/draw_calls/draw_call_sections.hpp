// The parts of the draw-call reproduction's page, each beside what the paper prints; of what was not measured
// only that stands there.
#pragma once

#include "workbench/reproduce/draw_calls/draw_calls.hpp"

namespace sightline::reproduce {

using LevelWalks = std::vector<LevelWalk>;

/// "pak1-maps.pk3:maps/ce1m7.bsp" as "ce1m7".
std::string short_level(const LevelWalk& walk);
/// "1.10 to 1.30": the least and the greatest, "–" for none.
std::string range_text(const std::vector<double>& values, int digits = 2);
/// simple over drawcall-wise on every level with every structure, at one height: calls, frame times, frame
/// times of the small picture, and what recording takes the CPU.
struct RivalRatios {
  std::vector<double> calls, frames, small_frames, recording;
};
RivalRatios rival_ratios(const LevelWalks& walks, std::uint32_t height);

PaperSection figure_6(const CallRates& ours);
PaperSection diagonal_section(const CallRates& ours);
PaperSection call_worth_section(const CallRates& ours);
PaperSection figure_8(const LevelWalks& walks);
PaperSection figure_9(const LevelWalks& walks);
PaperSection figure_10(const LevelWalks& walks);
PaperSection rivals_section(const LevelWalks& walks);
PaperSection structures_section(const LevelWalks& walks);
PaperSection future_work_section(const LevelWalks& walks);
PaperSection beyond_section(const LevelWalks& walks);
PaperSection outcomes_section(const LevelWalks& walks);
PaperSection levels_section(const LevelWalks& walks);

}  // namespace sightline::reproduce
