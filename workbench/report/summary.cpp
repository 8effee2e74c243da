#include "workbench/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "workbench/report/table.hpp"

namespace sightline::report {

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
      sum.draw_calls += static_cast<double>(row.stats.draw_calls);
      sum.triangles += static_cast<double>(row.stats.triangles);
      sum.excess += static_cast<double>(row.excess_objects);
      sum.truly_visible += static_cast<double>(row.truly_visible);
      sum.lost_objects += row.lost_objects;
      sum.lost_pixels += row.lost_pixels;
      sum.views_with_loss += row.lost_objects != 0;
      sum.cull.min = medians.empty() ? row.cull.min : std::min(sum.cull.min, row.cull.min);
      sum.cull.max = std::max(sum.cull.max, row.cull.max);
      medians.push_back(row.cull.median);
    }
    const double views = std::max(1.0, static_cast<double>(medians.size()));
    for (double* mean :
         {&sum.kept, &sum.tested, &sum.draw_calls, &sum.triangles, &sum.excess, &sum.truly_visible}) {
      *mean /= views;
    }
    sum.cull.median = measure::timing_of(medians).median;
    out.push_back(std::move(sum));
  }
  return out;
}

double estimated_frame_ms(const MethodSummary& s) noexcept {
  return s.cull.median + s.triangles / kTrianglesPerMillisecond + s.draw_calls / kDrawCallsPerMillisecond;
}

namespace {

std::string draw_calls_of(const MethodSummary& s) {
  return format_count(s.draw_calls) + (s.draw_calls == 1 ? " draw call" : " draw calls");
}

/// How the second best compares; `safe` begins with the best.
std::string next_best(const std::vector<MethodSummary>& safe) {
  if (safe.size() < 2) return "";
  const MethodSummary &best = safe[0], &next = safe[1];
  const std::string figures = fmt::format("{} ms, {} triangles and {}", format_ms(next.cull.median),
                                          format_count(next.triangles), draw_calls_of(next));
  // Timing alone does not repeat to a few percent.
  if (estimated_frame_ms(next) < 1.05 * estimated_frame_ms(best)) {
    return fmt::format(" {} comes within 5 % of that frame: {}.", next.method, figures);
  }
  return fmt::format(" Next of the {} that promise and kept as much is {}: {}.", safe.size(), next.method,
                     figures);
}

}  // namespace

std::string verdict(const measure::Comparison& comparison) {
  const std::vector<MethodSummary> all = summarise(comparison);
  const std::size_t views = comparison.cameras.size();
  // An approximate method that lost nothing here may lose something in the next view: named, not chosen.
  std::vector<MethodSummary> safe;
  std::copy_if(all.begin(), all.end(), std::back_inserter(safe), [](const MethodSummary& s) {
    return s.lost_objects == 0 && s.guarantee != Guarantee::approximate;
  });
  std::sort(safe.begin(), safe.end(), [](const MethodSummary& a, const MethodSummary& b) {
    return std::pair(estimated_frame_ms(a), a.method) < std::pair(estimated_frame_ms(b), b.method);
  });
  std::string text;
  double least_triangles = std::numeric_limits<double>::infinity();
  if (safe.empty()) {
    text =
        fmt::format("None of the {} methods both promises to lose nothing and kept that over these {} views.",
                    all.size(), views);
  } else {
    const MethodSummary& best = safe.front();
    least_triangles = best.triangles;
    text = fmt::format(
        "This scene wants {}. Over {} views it lost nothing that a pixel shows; it decides in {} ms, keeps "
        "{} objects "
        "where {} are visible, and leaves {} triangles in {}.",
        best.method, views, format_ms(best.cull.median), format_count(best.kept),
        format_count(best.truly_visible), format_count(best.triangles), draw_calls_of(best));
    text += next_best(safe);
  }
  for (const MethodSummary& s : all) {
    if (s.guarantee != Guarantee::approximate && s.lost_objects != 0) {
      text += fmt::format(" {} promises to be {} and lost {} pixels in {} views: a defect.", s.method,
                          to_string(s.guarantee), format_count(static_cast<double>(s.lost_pixels)),
                          s.views_with_loss);
    } else if (s.guarantee == Guarantee::approximate && s.triangles < least_triangles) {
      text +=
          s.lost_objects == 0
              ? fmt::format(
                    " {} would leave {} triangles and lost nothing in these views, but promises nothing for "
                    "others.",
                    s.method, format_count(s.triangles))
              : fmt::format(" {} would leave {} triangles, but lost {} pixels in {} of the views.", s.method,
                            format_count(s.triangles), format_count(static_cast<double>(s.lost_pixels)),
                            s.views_with_loss);
    }
  }
  return text +
         fmt::format(
             " The choice weighs measured culling time on this CPU against drawing on an assumed GPU of "
             "{:.0f} million triangles and {} draw calls a millisecond; nothing was drawn.",
             kTrianglesPerMillisecond / 1e6, format_count(kDrawCallsPerMillisecond));
}

Table summary_table(const measure::Comparison& comparison) {
  Table table;
  table.header = {"method",    "guarantee",         "kept",         "tested",      "draw calls",
                  "triangles", "cull ms [min–max]", "lost objects", "lost pixels", "excess"};
  table.text_columns = 2;
  for (const MethodSummary& s : summarise(comparison)) {
    table.rows.push_back(
        {s.method, std::string(to_string(s.guarantee)), format_count(s.kept), format_count(s.tested),
         format_count(s.draw_calls), format_count(s.triangles),
         fmt::format("{} [{}–{}]", format_ms(s.cull.median), format_ms(s.cull.min), format_ms(s.cull.max)),
         format_count(static_cast<double>(s.lost_objects)), format_count(static_cast<double>(s.lost_pixels)),
         format_count(s.excess)});
  }
  return table;
}

}  // namespace sightline::report
