// What follows from table 1: figure 6, the diagonal, and what a call is worth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"

namespace sightline::reproduce {

namespace {

std::string dash_or(const std::optional<double>& value, int digits = 1) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "–";
}

std::string count_or_dash(const std::optional<double>& value) {
  return value ? report::format_count(std::round(*value)) : "–";
}

// The row and column of a cell of table 1; it has all that is asked for here.
double rate_of(const CallRates& rates, double triangles, double calls) {
  const auto row = std::ranges::find(rates.triangles, triangles) - rates.triangles.begin(),
             column = std::ranges::find(rates.calls, calls) - rates.calls.begin();
  return rates.at(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
}

// A row of the table and its polynomial, as shares of the table's first cell.
void add_row_series(Chart& chart, const CallRates& rates, const RateFit& fit, std::size_t row,
                    const std::string& whose) {
  const std::string name = fmt::format("{}, {}", whose, report::format_count(rates.triangles[row]));
  Series cells{name, {}}, line{name + ", polynomial", {}};
  for (std::size_t c = 0; c < rates.calls.size(); ++c) {
    cells.values.push_back(rates.at(row, c) / rates.fps.front());
    line.values.push_back(fit.at(rates.triangles[row], rates.calls[c]) / rates.fps.front());
  }
  chart.series.push_back(std::move(cells));
  chart.series.push_back(std::move(line));
}

}  // namespace

PaperSection figure_6(const CallRates& ours) {
  PaperSection section{"figure 6", "table 1 and a polynomial through it", {}, {}, {}};
  const CallRates theirs = published_rates();
  const RateFit their_fit(theirs);
  std::optional<RateFit> our_fit;
  if (!ours.empty()) our_fit.emplace(ours);
  report::Table table;
  table.header = {"coefficient of", "published", "ours"};
  for (std::size_t t = 0; t < RateFit::kTerms.size(); ++t) {
    table.rows.push_back({RateFit::kTerms[t], fmt::format("{:.2f}", their_fit.coefficients()[t]),
                          our_fit ? fmt::format("{:.2f}", our_fit->coefficients()[t]) : "–"});
  }
  table.rows.push_back({"R²", fmt::format("{:.3f}", their_fit.determination()),
                        our_fit ? fmt::format("{:.3f}", our_fit->determination()) : "–"});
  section.tables.push_back(std::move(table));
  Chart lines{"figure-6", "draw calls", "frames/s, share of the first cell", {}, {}};
  for (const double calls : theirs.calls) lines.labels.push_back(report::format_count(calls));
  for (const std::size_t row : {std::size_t{0}, theirs.triangles.size() - 1}) {
    add_row_series(lines, theirs, their_fit, row, "published");
    if (our_fit) add_row_series(lines, ours, *our_fit, row, "ours");
  }
  section.html = chart(lines);
  section.note =
      "The paper draws the polynomial and does not print it. Both are fitted here to all cells, by least "
      "squares: frames/s over n, the triangles in 100,000, and d, the calls.";
  return section;
}

PaperSection diagonal_section(const CallRates& ours) {
  constexpr double kTriangles = 300000, kCalls = 100;
  PaperSection section{"text: 300,000 triangles in 100 calls",
                       "the diagonal of table 1 through that cell, "
                       "and what draws as quickly",
                       {},
                       {},
                       {}};
  const CallRates theirs = published_rates();
  const double their_centre = rate_of(theirs, kTriangles, kCalls),
               our_centre = ours.empty() ? 0 : rate_of(ours, kTriangles, kCalls);
  const RateFit their_fit(theirs);
  std::optional<RateFit> our_fit;
  if (!ours.empty()) our_fit.emplace(ours);
  report::Table table;
  table.header = {"triangles",
                  "calls",
                  "published fps",
                  "of the centre",
                  "our fps",
                  "of the centre",
                  "as quick as the centre in calls, published",
                  "ours"};
  for (int step = -2; step <= 2; ++step) {
    const double triangles = kTriangles + 100000 * step, calls = kCalls * std::pow(10, step);
    const double rate = rate_of(theirs, triangles, calls);
    std::optional<double> our_rate, our_share, our_calls;
    if (our_fit) {
      our_rate = rate_of(ours, triangles, calls);
      our_share = *our_rate / our_centre;
      our_calls = our_fit->calls_at(triangles, our_fit->at(kTriangles, kCalls));
    }
    table.rows.push_back({report::format_count(triangles), report::format_count(calls), dash_or(rate),
                          dash_or(rate / their_centre, 2), dash_or(our_rate), dash_or(our_share, 2),
                          count_or_dash(their_fit.calls_at(triangles, their_fit.at(kTriangles, kCalls))),
                          count_or_dash(our_calls)});
  }
  section.tables.push_back(std::move(table));
  section.note =
      "The last columns are the polynomial's: with how many calls the triangles of the row have the frame "
      "rate of the centre; \"–\" where no number of calls from 1 to 100,000 has it.";
  return section;
}

PaperSection call_worth_section(const CallRates& ours) {
  PaperSection section{
      "text: what a call is worth", "the stop rule, fitted to all cells of table 1", {}, {}, {}};
  const CallRates theirs = published_rates();
  std::vector<CallWorth> published = calls_worth(theirs), mine;
  published.push_back(call_worth_of_all(theirs));
  if (!ours.empty()) {
    mine = calls_worth(ours);
    mine.push_back(call_worth_of_all(ours));
  }
  report::Table table;
  table.header = {"calls",         "published: µs a call", "triangles", "octree stops below",
                  "kd-tree below", "ours: µs a call",      "triangles", "octree stops below",
                  "kd-tree below"};
  for (std::size_t c = 0; c < published.size(); ++c) {
    std::vector<std::string> line{published[c].calls > 0 ? report::format_count(published[c].calls)
                                                         : "all cells at once"};
    for (const std::vector<CallWorth>* side : {&published, &mine}) {
      const CallWorth* worth = side->empty() ? nullptr : &(*side)[c];
      const auto times = [&](double children) {
        return worth ? std::optional(children * std::max(0.0, worth->triangles)) : std::nullopt;
      };
      line.push_back(worth ? fmt::format("{:.3f}", worth->call_us) : "–");
      for (const double children : {1.0, 8.0, 2.0}) line.push_back(dash_or(times(children), 0));
    }
    table.rows.push_back(std::move(line));
  }
  section.tables.push_back(std::move(table));
  section.note = fmt::format(
      "What a call adds to the frame of one call, medians over the rows, in triangles of {:.1f} ns "
      "published{}. "
      "The rule that these methods stop by (least=11) is the column of 100,000 calls, in which a call costs "
      "least: frames of few calls would stop earlier.",
      triangle_ns(theirs), ours.empty() ? "" : fmt::format(" and {:.1f} ns here", triangle_ns(ours)));
  return section;
}

}  // namespace sightline::reproduce
