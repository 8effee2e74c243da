#include "workbench/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "workbench/report/table.hpp"

namespace sightline::report {

std::string_view sides_drawn(RasterState state) noexcept {
  switch (state) {
    case RasterState::materials:
      return "sides drawn as the materials say";
    case RasterState::both_sides:
      return "both sides drawn";
    case RasterState::front_faces:
      return "front faces drawn";
  }
  return "";
}

std::vector<MethodSummary> summarise(const measure::Comparison& comparison) {
  std::vector<MethodSummary> out;
  for (const std::string& method : comparison.methods) {
    MethodSummary sum;
    sum.method = method;
    std::vector<double> medians;
    for (const measure::Row& row : comparison.rows) {
      if (row.method != method) continue;
      sum.guarantee = row.guarantee;
      sum.kept += static_cast<double>(row.kept);
      sum.tested += static_cast<double>(row.stats.tested);
      sum.cull_vertices += static_cast<double>(row.stats.cull_vertices);
      sum.draw_calls += static_cast<double>(row.stats.draw_calls);
      sum.triangles += static_cast<double>(row.stats.triangles);
      sum.excess += static_cast<double>(row.excess_objects);
      sum.truly_visible += static_cast<double>(row.truly_visible);
      sum.cpu_ms += row.cull.median;
      sum.gpu_ms += row.cull_gpu ? row.cull_gpu->median : 0;
      sum.occluders_ms += row.occluders ? row.occluders->median : 0;
      sum.frame_ms += row.frame ? row.frame->median : 0;
      sum.frame_spread_ms += row.frame ? row.frame->median - row.frame->min : 0;
      sum.lost_objects += row.lost_objects;
      sum.lost_pixels += row.lost_pixels;
      sum.views_with_loss += row.lost_objects != 0;
      sum.cull.min = medians.empty() ? row.cull.min : std::min(sum.cull.min, row.cull.min);
      sum.cull.max = std::max(sum.cull.max, row.cull.max);
      medians.push_back(row.cull.median);
    }
    const double views = std::max(1.0, static_cast<double>(medians.size()));
    for (double* mean : {&sum.kept, &sum.tested, &sum.cull_vertices, &sum.draw_calls, &sum.triangles,
                         &sum.excess, &sum.truly_visible, &sum.cpu_ms, &sum.gpu_ms, &sum.occluders_ms,
                         &sum.frame_ms, &sum.frame_spread_ms}) {
      *mean /= views;
    }
    sum.cull.median = measure::timing_of(medians).median;
    out.push_back(std::move(sum));
  }
  return out;
}

namespace {

std::string count(std::uint64_t n) {
  return format_count(static_cast<double>(n));
}

Table drawn_table(const measure::Comparison& comparison) {
  Table table;
  table.header = {"method",        "guarantee",    "kept",        "visible",     "excess",
                  "cull vertices", "draw calls",   "cull CPU ms", "cull GPU ms", "frame ms",
                  "fps",           "lost objects", "lost pixels"};
  table.text_columns = 2;
  for (const MethodSummary& s : summarise(comparison)) {
    table.rows.push_back({s.method, std::string(to_string(s.guarantee)), format_count(s.kept),
                          format_count(s.truly_visible), format_count(s.excess),
                          format_count(s.cull_vertices), format_count(s.draw_calls), format_ms(s.cpu_ms),
                          format_ms(s.gpu_ms), format_ms(s.frame_ms), fmt::format("{:.1f}", s.fps()),
                          count(s.lost_objects), count(s.lost_pixels)});
  }
  return table;
}

}  // namespace

Table summary_table(const measure::Comparison& comparison) {
  if (comparison.drawn()) return drawn_table(comparison);
  Table table;
  table.header = {"method",    "guarantee",         "kept",         "tested",      "draw calls",
                  "triangles", "cull ms [min–max]", "lost objects", "lost pixels", "excess",
                  "unbeaten"};
  table.text_columns = 2;
  const std::vector<MethodSummary> all = summarise(comparison);
  const std::vector<std::string> best = unbeaten(all);
  for (const MethodSummary& s : all) {
    table.rows.push_back(
        {s.method, std::string(to_string(s.guarantee)), format_count(s.kept), format_count(s.tested),
         format_count(s.draw_calls), format_count(s.triangles),
         fmt::format("{} [{}–{}]", format_ms(s.cull.median), format_ms(s.cull.min), format_ms(s.cull.max)),
         count(s.lost_objects), count(s.lost_pixels), format_count(s.excess),
         std::ranges::find(best, s.method) == best.end() ? "" : "•"});
  }
  return table;
}

Table ratio_table(const measure::Comparison& comparison, double share) {
  Table table;
  if (!comparison.drawn()) return table;
  table.header = {"method", "views", "times as fast as " + comparison.methods.front(), "least", "most"};
  table.text_columns = 1;
  const auto row_of = [&](std::size_t view, std::size_t method) -> const measure::Row& {
    return comparison.rows[view * comparison.methods.size() + method];
  };
  for (std::size_t m = 1; m < comparison.methods.size(); ++m) {
    std::vector<double> ratios;
    for (std::size_t v = 0; v < comparison.cameras.size(); ++v) {
      const measure::Row &first = row_of(v, 0), &row = row_of(v, m);
      const bool few =
          static_cast<double>(row.truly_visible) < share * static_cast<double>(row.stats.objects);
      if (few && first.frame && row.frame && row.frame->median > 0)
        ratios.push_back(first.frame->median / row.frame->median);
    }
    if (ratios.empty()) continue;
    const measure::Timing t = measure::timing_of(ratios);
    table.rows.push_back({comparison.methods[m], fmt::format("{}", ratios.size()),
                          fmt::format("{:.2f}", t.median), fmt::format("{:.2f}", t.min),
                          fmt::format("{:.2f}", t.max)});
  }
  return table;
}

}  // namespace sightline::report
