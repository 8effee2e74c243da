#include "workbench/report/outcome.hpp"

#include <sightline/workbench/error.hpp>

namespace sightline::report {

Snapshot take_snapshot(measure::Bench& bench, const Camera& camera, std::size_t index, std::uint32_t width,
                       std::uint32_t height) {
  Snapshot snapshot;
  snapshot.index = index;
  snapshot.camera = camera;
  snapshot.view = or_throw(make_view(camera, width, height));
  snapshot.truth = bench.oracle().look(snapshot.view);
  for (measure::Subject& subject : bench.subjects()) {
    bench.run(subject, snapshot.view);
    const oracle::Judgement judged = bench.judge(subject, snapshot.view);
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
