#include "workbench/report/outcome.hpp"

#include <sightline/workbench/error.hpp>

namespace sightline::report {

Snapshot take_snapshot(measure::Bench& bench, const measure::Comparison& comparison, std::size_t index,
                       std::uint32_t width, std::uint32_t height) {
  constexpr int kFrames = 4;
  Snapshot snapshot;
  snapshot.index = index;
  snapshot.camera = comparison.cameras[index];
  snapshot.view = or_throw(make_view(snapshot.camera, width, height));
  snapshot.truth = bench.oracle().look(snapshot.view);
  const View compared = or_throw(make_view(snapshot.camera, comparison.width, comparison.height));
  for (measure::Subject& subject : bench.subjects()) {
    for (int frame = 0; frame < kFrames; ++frame) bench.run(subject, compared);
    const oracle::Judgement judged = bench.judge(subject, compared);
    Snapshot::Method method{subject.name, std::vector<Outcome>(bench.scene().size(), Outcome::culled), {}};
    for (const ObjectId object : subject.frame.visible) method.outcomes[object] = Outcome::visible;
    for (const ObjectId object : judged.loss.excess) method.outcomes[object] = Outcome::excess;
    for (const ObjectId object : judged.loss.lost) method.outcomes[object] = Outcome::lost;
    for (const Outcome outcome : method.outcomes) ++method.counts[static_cast<std::size_t>(outcome)];
    snapshot.methods.push_back(std::move(method));
  }
  return snapshot;
}

}  // namespace sightline::report
