#include "workbench/report/outcome.hpp"

#include <sightline/workbench/error.hpp>

#include "workbench/oracle/loss.hpp"

namespace sightline::report {

Snapshot take_snapshot(const Scene& scene, const oracle::EmbreeJudge& judge,
                       std::span<const measure::Contestant> contestants, const Camera& camera,
                       std::size_t index, std::uint32_t width, std::uint32_t height) {
  Snapshot snapshot;
  snapshot.index = index;
  snapshot.camera = camera;
  snapshot.view = or_throw(make_view(camera, width, height));
  snapshot.truth = judge.render(snapshot.view);
  Frame frame;
  for (const measure::Contestant& contestant : contestants) {
    contestant.method->cull(snapshot.view, frame);
    const oracle::Loss loss = oracle::confirmed_loss(judge, snapshot.view, snapshot.truth, frame.visible);
    Snapshot::Method method{contestant.name, std::vector<Fate>(scene.size(), Fate::culled), {}};
    for (const ObjectId object : frame.visible) method.fates[object] = Fate::visible;
    for (const ObjectId object : loss.excess) method.fates[object] = Fate::excess;
    for (const ObjectId object : loss.lost) method.fates[object] = Fate::lost;
    for (const Fate fate : method.fates) ++method.counts[static_cast<std::size_t>(fate)];
    snapshot.methods.push_back(std::move(method));
  }
  return snapshot;
}

}  // namespace sightline::report
