#include "page.hpp"

#include "lab/report/report.hpp"

namespace sightline::app {

void write_page(const std::string& folder, const Scene& scene, const lab::EmbreeJudge& judge,
                std::span<const lab::Contestant> contestants, const lab::Comparison& comparison) {
  const std::size_t index = lab::picture_view(comparison);
  // The item buffer is shown at half its size, smoothed.
  const lab::Snapshot snapshot =
      lab::take_snapshot(scene, judge, contestants, comparison.cameras[index], index, 1920, 1080);
  lab::write_report(folder, comparison, scene, snapshot);
}

}  // namespace sightline::app
