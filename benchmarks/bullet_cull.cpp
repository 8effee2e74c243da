// Bullet's dynamic bounding volume tree: btDbvt::collideKDOP with the six planes of the frustum.
#include <benchmark/benchmark.h>

#include "bullet_tree.hpp"
#include "judged.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

struct Collect : btDbvt::ICollide {
  std::vector<ObjectId> ids;
  void Process(const btDbvtNode* leaf) override { ids.push_back(static_cast<ObjectId>(leaf->dataAsInt)); }
};

void bullet_dbvt(benchmark::State& state) {
  const Case& c = case_of(1'000'000);
  btDbvt tree;
  fill(tree, c.flat);
  tree.optimizeIncremental(static_cast<int>(c.flat.size()) / 4);
  const View view = looking(0.3f, tenth_of_view());
  const Frustum frustum = make_frustum(view);
  std::array<btVector3, 6> normals;
  std::array<btScalar, 6> offsets;
  for (std::size_t p = 0; p < 6; ++p) {
    const Plane& plane = frustum.planes[p];
    normals[p] = {plane.normal.x, plane.normal.y, plane.normal.z};
    offsets[p] = plane.distance;
  }
  Collect collect;
  for (auto _ : state) {
    collect.ids.clear();
    btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, collect);
  }
  judge(state, c.flat, {&view, 1}, collect.ids);
}
BENCHMARK(bullet_dbvt)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
