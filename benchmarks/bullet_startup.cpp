// How long Bullet's tree of a million boxes takes to fill.
#include "bullet_tree.hpp"
#include "startup.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

void bullet_dbvt(benchmark::State& state) {
  const Boxes& boxes = case_of(1'000'000).flat;
  start_up(state, Held::counted, [&] {
    auto tree = std::make_unique<btDbvt>();
    fill(*tree, boxes);
    return tree;
  });
}
BENCHMARK(bullet_dbvt)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline::benchmarks
