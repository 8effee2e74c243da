#include "page.hpp"

#include "workbench/report/report.hpp"

namespace sightline::app {

void write_page(const std::string& folder, const Scene& scene, const oracle::EmbreeJudge& judge,
                std::span<const measure::Contestant> contestants, const measure::Comparison& comparison) {
  const std::size_t index = report::picture_view(comparison);
  // The item buffer is shown at half its size, smoothed.
  const report::Snapshot snapshot =
      report::take_snapshot(scene, judge, contestants, comparison.cameras[index], index, 1920, 1080);
  report::write_report(folder, comparison, scene, snapshot);
}

}  // namespace sightline::app
