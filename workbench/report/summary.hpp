// A method's rows along a path, drawn together; and which method the scene wants.
#pragma once

#include <string>
#include <vector>

#include "workbench/measure/measure.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// Means are over the views, losses are sums.
struct MethodSummary {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  double kept = 0, tested = 0, draw_calls = 0, triangles = 0, excess = 0, truly_visible = 0;
  measure::Timing cull;  ///< median of the views' medians; least and greatest over all repeats
  std::uint64_t lost_objects = 0, lost_pixels = 0;
  std::size_t views_with_loss = 0;
};

/// In the order of the methods.
std::vector<MethodSummary> summarise(const measure::Comparison& comparison);

/// What a mean frame would cost on an assumed GPU, for weighing what a method leaves to draw against the time
/// it takes to decide. An assumption, to be named beside every use.
inline constexpr double kTrianglesPerMillisecond = 1e6, kDrawCallsPerMillisecond = 1000;
double estimated_frame_ms(const MethodSummary& summary) noexcept;

/// A paragraph: which method this scene wants, and what that is based on.
std::string verdict(const measure::Comparison& comparison);

/// One line a method: what it kept, what that cost, what it lost.
Table summary_table(const measure::Comparison& comparison);

}  // namespace sightline::report
