// Bullet's dynamic bounding volume tree: btDbvt::collideKDOP with the six planes of the frustum.
#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <benchmark/benchmark.h>

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
  for (std::size_t i = 0; i < c.flat.size(); ++i) {
    const Box b = c.flat[i];
    tree.insert(btDbvtVolume::FromMM({b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}), nullptr)
        ->dataAsInt = static_cast<int>(i);
  }
  tree.optimizeIncremental(static_cast<int>(c.flat.size()) / 4);
  const Frustum frustum =
      make_frustum(looking(0.3f, tenth_of_view()), {{-2000, -60, -2000}, {2000, 60, 2000}});
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
  state.counters["visible"] = static_cast<double>(collect.ids.size());
}
BENCHMARK(bullet_dbvt)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
