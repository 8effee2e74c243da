// Who was quickest, where frames tell; who is beaten by nobody, where nothing was drawn.
#include <fmt/format.h>

#include <algorithm>

#include "workbench/report/summary.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

namespace {

// An approximate method that lost nothing here may lose something in the next view.
bool is_safe(const MethodSummary& s) {
  return s.lost_objects == 0 && s.guarantee != Guarantee::approximate && s.method != measure::kLimit;
}

// At least as good in everything and better in something.
bool beats(const MethodSummary& a, const MethodSummary& b) {
  const bool as_good =
      a.cull.median <= b.cull.median && a.triangles <= b.triangles && a.draw_calls <= b.draw_calls;
  return as_good &&
         (a.cull.median < b.cull.median || a.triangles < b.triangles || a.draw_calls < b.draw_calls);
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out.append(out.empty() ? "" : ", ").append(name);
  return out;
}

// One line, however many broke their word.
std::string defects(const std::vector<MethodSummary>& all) {
  std::vector<std::string> lines;
  for (const MethodSummary& s : all) {
    if (s.guarantee == Guarantee::approximate || s.lost_objects == 0) continue;
    lines.push_back(fmt::format("{} promises to be {} and lost {} pixels in {} views", s.method,
                                to_string(s.guarantee), format_count(static_cast<double>(s.lost_pixels)),
                                s.views_with_loss));
  }
  return lines.empty() ? "" : "\nA defect: " + joined(lines) + ".";
}

std::string drawn_verdict(const measure::Comparison& comparison, const std::vector<MethodSummary>& all) {
  std::vector<MethodSummary> safe = all;
  std::erase_if(safe, [](const MethodSummary& s) { return !is_safe(s); });
  if (safe.empty()) return "No method both promised to lose nothing and kept that." + defects(all);
  std::ranges::stable_sort(safe, {}, &MethodSummary::frame_ms);
  const MethodSummary& best = safe.front();
  const auto tied = [&](const MethodSummary& s) {
    return s.frame_ms - best.frame_ms < std::max(best.frame_spread_ms, s.frame_spread_ms);
  };
  const bool two = safe.size() > 1 && tied(safe[1]);
  std::string text =
      two ? fmt::format(
                "Quickest on {}: {} and {}, {} and {} ms a frame; they differ by less than the frames of "
                "each do.",
                comparison.device, best.method, safe[1].method, format_ms(best.frame_ms),
                format_ms(safe[1].frame_ms))
          : fmt::format("Quickest on {}: {}, {} ms a frame, {:.0f} objects drawn where {:.0f} are visible.",
                        comparison.device, best.method, format_ms(best.frame_ms), best.kept,
                        best.truly_visible);
  const std::size_t next = two ? 2 : 1;
  if (safe.size() > next)
    text += fmt::format("\nNext: {}, at {:.2f} times that.", safe[next].method,
                        safe[next].frame_ms / best.frame_ms);
  return text + defects(all);
}

}  // namespace

std::vector<std::string> unbeaten(const std::vector<MethodSummary>& all) {
  std::vector<std::string> names;
  for (const MethodSummary& s : all) {
    const bool beaten =
        std::ranges::any_of(all, [&](const auto& other) { return is_safe(other) && beats(other, s); });
    if (is_safe(s) && !beaten) names.push_back(s.method);
  }
  return names;
}

std::string verdict(const measure::Comparison& comparison) {
  const std::vector<MethodSummary> all = summarise(comparison);
  if (comparison.drawn()) return drawn_verdict(comparison, all);
  const std::vector<std::string> names = unbeaten(all);
  if (names.empty()) return "No method both promised to lose nothing and kept that." + defects(all);
  return fmt::format(
             "Beaten by no other that keeps its promise, in culling time, triangles and draw calls together: "
             "{}.\n"
             "Nothing was drawn, so this does not say which frame is quickest: a Vulkan device draws them.",
             joined(names)) +
         defects(all);
}

}  // namespace sightline::report
