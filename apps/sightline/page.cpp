#include "page.hpp"

#include "workbench/report/report.hpp"

namespace sightline::app {

void write_page(const std::string& folder, measure::Bench& bench, const measure::Comparison& comparison) {
  const std::size_t index = report::picture_view(comparison);
  // The item buffer is shown at half its size, smoothed.
  const report::Snapshot snapshot = report::take_snapshot(bench, comparison, index, 1920, 1080);
  report::write_report(folder, comparison, bench.scene(), snapshot);
}

}  // namespace sightline::app
