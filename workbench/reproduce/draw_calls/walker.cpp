#include "workbench/reproduce/draw_calls/walker.hpp"

#include <chrono>

#include "workbench/measure/timing.hpp"
#include "workbench/measure/turns.hpp"

namespace sightline::reproduce {

Walker::Walker(device::Renderer& renderer, const std::string& specification)
    : what_(specification == "none"      ? What::everything
            : specification == "nothing" ? What::nothing
                                         : What::method) {
  row.method = specification;
  row.family = std::string(specified_name(specification));
  const std::size_t at = specification.find("height=");
  row.height = at == std::string::npos ? 0 : static_cast<std::uint32_t>(specification[at + 7] - '0');
  method_ = create_method(culls() ? specification : "simple-grid?height=1", renderer.scene());
  row.submission = method_->geometry()->submission;
  row.bytes = method_->geometry()->bytes;
  draws_ = std::make_unique<device::TriangleDraws>(renderer, *method_->geometry());
}

Walker::Times Walker::draw(device::Renderer& renderer, const View& view) {
  Times out;
  const device::FrameTimes times = renderer.frame(view, [&](device::Recorder& recorder) {
    const auto begin = std::chrono::steady_clock::now();
    if (culls()) {
      cull(*method_, view, frame_);
    } else if (what_ == What::everything) {
      const auto count = static_cast<std::uint32_t>(method_->geometry()->objects.size());
      frame_.clear();
      frame_.draws.push_back({3 * count, 1, 0, 0, 0});
      frame_.stats.draw_calls = 1, frame_.stats.triangles = count;
    }
    out.cull_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    draws_->draw(recorder, frame_.draws, method_->geometry()->submission);
  });
  method_->report_frame_time(times.frame_ms);
  out.frame_ms = times.frame_ms, out.record_ms = times.record_ms;
  return out;
}

std::vector<Walker::Times> draw_by_turns(std::span<Walker* const> walkers, device::Renderer& renderer,
                                         const View& view, std::size_t turn, std::size_t rounds) {
  struct Samples {
    std::vector<double> frame, cull, record;
  };
  std::vector<Samples> samples(walkers.size());
  measure::Turns turns(walkers.size(), 1 + turn);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const std::size_t w : turns.next()) {
      walkers[w]->draw(renderer, view);
      const Walker::Times times = walkers[w]->draw(renderer, view);
      samples[w].frame.push_back(times.frame_ms);
      samples[w].cull.push_back(times.cull_ms);
      samples[w].record.push_back(times.record_ms);
    }
  }
  std::vector<Walker::Times> medians;
  for (Samples& s : samples)
    medians.push_back({measure::timing_of(s.frame).median, measure::timing_of(s.cull).median,
                       measure::timing_of(s.record).median, measure::typical_of(s.frame)});
  return medians;
}

}  // namespace sightline::reproduce
