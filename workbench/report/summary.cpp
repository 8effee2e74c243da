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
      sum.lost_objects += row.lost_objects;
      sum.lost_pixels += row.lost_pixels;
      sum.views_with_loss += row.lost_objects != 0;
      sum.cull.min = medians.empty() ? row.cull.min : std::min(sum.cull.min, row.cull.min);
      sum.cull.max = std::max(sum.cull.max, row.cull.max);
      medians.push_back(row.cull.median);
    }
    const double views = std::max(1.0, static_cast<double>(medians.size()));
    for (double* mean :
         {&sum.kept, &sum.tested, &sum.cull_vertices, &sum.draw_calls, &sum.triangles, &sum.excess,
          &sum.truly_visible, &sum.cpu_ms, &sum.gpu_ms, &sum.occluders_ms, &sum.frame_ms}) {
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

/// Which method drew its frames fastest without losing anything.
std::string drawn_verdict(const measure::Comparison& comparison) {
  std::vector<MethodSummary> all = summarise(comparison);
  std::erase_if(all,
                [](const MethodSummary& s) { return s.lost_objects > 0 || s.method == measure::kLimit; });
  if (all.empty()) return "Every method lost something.";
  std::ranges::stable_sort(all, {}, &MethodSummary::frame_ms);
  const MethodSummary& best = all.front();
  std::string text =
      fmt::format("On {} this path wants {}: {} ms a frame, {:.0f} objects drawn where {:.0f} are visible.",
                  comparison.device, best.method, format_ms(best.frame_ms), best.kept, best.truly_visible);
  if (all.size() > 1) {
    text += fmt::format(" Next is {}, at {:.2f} times that.", all[1].method, all[1].frame_ms / best.frame_ms);
  }
  return text;
}

}  // namespace

std::string verdict(const measure::Comparison& comparison) {
  if (comparison.drawn()) return drawn_verdict(comparison);
  const std::vector<MethodSummary> all = summarise(comparison);
  const std::size_t views = comparison.cameras.size();
  // An approximate method that lost nothing here may lose something in the next view: named, not chosen.
  std::vector<MethodSummary> safe;
  std::copy_if(all.begin(), all.end(), std::back_inserter(safe), [](const MethodSummary& s) {
    return s.lost_objects == 0 && s.guarantee != Guarantee::approximate && s.method != measure::kLimit;
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
                  "triangles", "cull ms [min–max]", "lost objects", "lost pixels", "excess"};
  table.text_columns = 2;
  for (const MethodSummary& s : summarise(comparison)) {
    table.rows.push_back(
        {s.method, std::string(to_string(s.guarantee)), format_count(s.kept), format_count(s.tested),
         format_count(s.draw_calls), format_count(s.triangles),
         fmt::format("{} [{}–{}]", format_ms(s.cull.median), format_ms(s.cull.min), format_ms(s.cull.max)),
         count(s.lost_objects), count(s.lost_pixels), format_count(s.excess)});
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
