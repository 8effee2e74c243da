// A method's rows along a path, drawn together; and what they say of the methods.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "workbench/measure/compare.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// Means are over the views, losses are sums.
struct MethodSummary {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  double kept = 0, tested = 0, cull_vertices = 0, draw_calls = 0, triangles = 0, excess = 0,
         truly_visible = 0;
  measure::Timing cull;  ///< on the CPU: median of the views' medians; least and greatest over all repeats
  /// Means of the views' medians; 0 where nothing was drawn. Of the GPU's part of culling the occluders'
  /// depth stands apart.
  double cpu_ms = 0, gpu_ms = 0, occluders_ms = 0, frame_ms = 0;
  double frame_spread_ms = 0;  ///< median less least, likewise
  std::uint64_t lost_objects = 0, lost_pixels = 0;
  std::size_t views_with_loss = 0;

  [[nodiscard]] double fps() const noexcept { return frame_ms > 0 ? 1000 / frame_ms : 0; }
};

/// Which sides of triangles are drawn, in words, for whoever reads "exact".
std::string_view sides_drawn(RasterState state) noexcept;

/// In the order of the methods.
std::vector<MethodSummary> summarise(const measure::Comparison& comparison);

/// One line a method: what it kept, what that cost, what it lost.
Table summary_table(const measure::Comparison& comparison);

/// How many times as fast as the first method's frames the others' are, over the views in which less than
/// `share` of the scene's objects is visible: one line a method, the median, least and greatest. Empty where
/// nothing was drawn.
Table ratio_table(const measure::Comparison& comparison, double share = 0.2);

/// Those that promise to lose nothing, kept that, and that no other such method beats in culling time,
/// triangles and draw calls together.
std::vector<std::string> unbeaten(const std::vector<MethodSummary>& all);

/// At most three lines: whose drawn frames were quickest, with what they ran on, two names where they differ
/// by less than the spread of their frames; where nothing was drawn, who is unbeaten; and who broke a
/// promise.
std::string verdict(const measure::Comparison& comparison);

}  // namespace sightline::report
