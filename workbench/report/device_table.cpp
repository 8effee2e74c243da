#include "workbench/report/device_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "workbench/measure/device_measure.hpp"

namespace sightline::report {

std::vector<DeviceSummary> summarise_on_device(const measure::Comparison& comparison) {
  std::vector<DeviceSummary> out;
  for (const std::string& method : comparison.methods) {
    DeviceSummary sum;
    sum.method = method;
    double views = 0;
    for (const measure::Row& row : comparison.rows) {
      if (row.method != method) continue;
      ++views;
      sum.guarantee = row.guarantee;
      sum.kept += static_cast<double>(row.kept);
      sum.visible += static_cast<double>(row.truly_visible);
      sum.excess += static_cast<double>(row.excess_objects);
      sum.cull_vertices += static_cast<double>(row.stats.cull_vertices);
      sum.draw_calls += static_cast<double>(row.stats.draw_calls);
      sum.triangles += static_cast<double>(row.stats.triangles);
      sum.cpu_ms += row.cull.median;
      sum.gpu_ms += row.cull_gpu ? row.cull_gpu->median : 0;
      sum.frame_ms += row.frame ? row.frame->median : 0;
      sum.lost_objects += row.lost_objects;
      sum.lost_pixels += row.lost_pixels;
    }
    views = std::max(views, 1.0);
    for (double* mean : {&sum.kept, &sum.visible, &sum.excess, &sum.cull_vertices, &sum.draw_calls,
                         &sum.triangles, &sum.cpu_ms, &sum.gpu_ms, &sum.frame_ms}) {
      *mean /= views;
    }
    out.push_back(std::move(sum));
  }
  return out;
}

Table device_table(const measure::Comparison& comparison) {
  Table table;
  table.header = {"method",        "guarantee",    "kept",        "visible",     "excess",
                  "cull vertices", "draw calls",   "cull CPU ms", "cull GPU ms", "frame ms",
                  "fps",           "lost objects", "lost pixels"};
  table.text_columns = 2;
  for (const DeviceSummary& s : summarise_on_device(comparison)) {
    table.rows.push_back({s.method, std::string(to_string(s.guarantee)), format_count(s.kept),
                          format_count(s.visible), format_count(s.excess), format_count(s.cull_vertices),
                          format_count(s.draw_calls), format_ms(s.cpu_ms), format_ms(s.gpu_ms),
                          format_ms(s.frame_ms), fmt::format("{:.1f}", s.fps()),
                          format_count(static_cast<double>(s.lost_objects)),
                          format_count(static_cast<double>(s.lost_pixels))});
  }
  return table;
}

std::string device_verdict(const measure::Comparison& comparison) {
  std::vector<DeviceSummary> all = summarise_on_device(comparison);
  std::erase_if(all,
                [](const DeviceSummary& s) { return s.lost_objects > 0 || s.method == measure::kLimit; });
  if (all.empty()) return "Every method lost something.";
  std::ranges::stable_sort(all, {}, &DeviceSummary::frame_ms);
  const DeviceSummary& best = all.front();
  std::string text =
      fmt::format("On {} this path wants {}: {} ms a frame, {:.0f} objects drawn where {:.0f} are visible.",
                  comparison.device, best.method, format_ms(best.frame_ms), best.kept, best.visible);
  if (all.size() > 1) {
    text += fmt::format(" Next is {}, at {:.2f} times that.", all[1].method, all[1].frame_ms / best.frame_ms);
  }
  return text;
}

Table device_ratios(const measure::Comparison& comparison, double share) {
  Table table;
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

Table verification_table(const measure::DeviceVerification& verification) {
  Table table;
  table.header = {"method",      "guarantee",        "kept",        "visible", "lost objects",
                  "lost pixels", "different pixels", "excess objs", "verdict"};
  table.text_columns = 2;
  for (std::size_t m = 0; m < verification.methods.size(); ++m) {
    const measure::MethodVerdict& v = verification.methods[m];
    const std::uint64_t different = verification.different_pixels[m];
    const bool holds = v.holds() && (v.guarantee != Guarantee::exact || different == 0);
    const auto count = [](std::uint64_t n) { return format_count(static_cast<double>(n)); };
    table.rows.push_back({v.method, std::string(to_string(v.guarantee)), count(v.kept), count(v.visible),
                          count(v.lost_objects), count(v.lost_pixels), count(different),
                          count(v.excess_objects),
                          !holds               ? "BROKEN"
                          : v.lost_objects > 0 ? "approximate"
                                               : "holds"});
  }
  return table;
}

}  // namespace sightline::report
