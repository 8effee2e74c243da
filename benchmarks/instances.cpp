// 10⁹ objects in ten thousand instances of a world of 100,000, beside a plain world of what its view
// may see, which holds the same objects each by itself.
#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

#include <sightline/instances.hpp>

#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr float kBlockSide = 632;  // as densely as case_of() has its boxes

double resident_gib() {
  double pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * 4096 / (1u << 30);
}

struct Block {
  Boxes flat;
  World world;
  Block() {
    scene::Random random(1);
    for (int i = 0; i < 100'000; ++i) {
      const Vec3 at = random.inside(
                     {{-kBlockSide / 2, -50, -kBlockSide / 2}, {kBlockSide / 2, 50, kBlockSide / 2}}),
                 half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
      flat.push_back(
          {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}});
    }
    std::vector<Handle> handles(flat.size());
    or_throw(world.insert(flat.view(), handles));
  }
};

// Ten thousand of them on a square grid, turned by quarters, or by any angle.
struct City {
  double before = resident_gib();
  Block block;
  Instances instances;
  std::vector<InstancePlacement> placements;

  explicit City(bool quarters) {
    const PlacedWorldId name = *instances.add_world(block.world);
    scene::Random random(2);
    for (int i = 0; i < 10'000; ++i) {
      const double angle = quarters ? 1.5707963267948966 * random.below(4) : random.between(0, 6.28f);
      float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
      if (quarters) c = std::round(c), s = std::round(s);
      placements.push_back({name,
                            {{c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1}},
                            {double{kBlockSide} * (i % 100), 0, double{kBlockSide} * (i / 100)}});
    }
    std::vector<Handle> handles(placements.size());
    or_throw(instances.insert(placements, handles));
  }
};

City& city_of(bool quarters) {
  static City square(true), turned(false);
  return quarters ? square : turned;
}

// In the middle of the city.
CullView seeing(float fov) {
  return {.view = {looking(0.3f, fov), {double{kBlockSide} * 50, 0, double{kBlockSide} * 50}}};
}

// The field of view that sees 100,000 objects.
float fov_of(const City& city) {
  InstanceCuller culler;
  float low = 0.05f, high = 2.5f;
  for (int i = 0; i < 30; ++i) {
    const float middle = 0.5f * (low + high);
    (culler.cull(city.instances, seeing(middle))->objects < 100'000 ? low : high) = middle;
  }
  return high;
}

// The instances within 2,500 m of the eye, each object by itself.
struct Plain {
  World world;
  explicit Plain(const City& city) {
    std::vector<WorldBox> boxes;
    for (const InstancePlacement& p : city.placements) {
      const double x = p.origin.x - 50 * double{kBlockSide}, z = p.origin.z - 50 * double{kBlockSide};
      if (std::hypot(x, z) > 2500) continue;
      for (std::size_t i = 0; i < city.block.flat.size(); ++i) boxes.push_back(placed(p, city.block.flat[i]));
    }
    std::vector<Handle> handles(boxes.size());
    or_throw(world.insert(boxes, handles));
  }
  static WorldBox placed(const InstancePlacement& p, const Box& b) {
    const auto& m = p.transform.m;
    const Vec3 low = b.min, high = b.max;
    const double c = m[0], s = m[8], cx = 0.5 * (low.x + high.x), cz = 0.5 * (low.z + high.z),
                 hx = 0.5 * (high.x - low.x), hz = 0.5 * (high.z - low.z);
    const double x = p.origin.x + c * cx + s * cz, z = p.origin.z - s * cx + c * cz,
                 wide = std::fabs(c) * hx + std::fabs(s) * hz, deep = std::fabs(s) * hx + std::fabs(c) * hz;
    return {{x - wide, low.y, z - deep}, {x + wide, high.y, z + deep}};
  }
};

void instances(benchmark::State& state, bool quarters) {
  const City& city = city_of(quarters);
  static const double gib = resident_gib() - city_of(true).before;
  const CullView view = seeing(fov_of(city));
  InstanceCuller culler;
  InstanceCullResult seen;
  for (auto _ : state) benchmark::DoNotOptimize(seen = *culler.cull(city.instances, view));
  state.counters["visible"] = static_cast<double>(seen.objects);
  state.counters["instances"] = static_cast<double>(seen.ranges.size());
  state.counters["logical"] = static_cast<double>(city.instances.objects());
  state.counters["GiB"] = gib;
}

void plain(benchmark::State& state, bool quarters) {
  const City& city = city_of(quarters);
  static const Plain square(city_of(true)), turned(city_of(false));
  const World& world = quarters ? square.world : turned.world;
  const CullView view = seeing(fov_of(city));
  std::vector<ObjectId> visible(cull_capacity(world));
  Culler culler;
  CullResult result;
  for (auto _ : state) benchmark::DoNotOptimize(result = *culler.cull(world, view, visible));
  state.counters["visible"] = static_cast<double>(result.count);
  // Turned by quarters, boxes are the same boxes: but for some on the border.
  InstanceCuller instance_culler;
  const auto seen = static_cast<double>(instance_culler.cull(city.instances, view)->objects);
  if (quarters && std::fabs(static_cast<double>(result.count) - seen) > 20)
    state.SkipWithError("a wrong answer");
}

// All of it, from above.
void everything(benchmark::State& state) {
  const City& city = city_of(true);
  Camera camera{.eye = {0, 0, 0}, .forward = {0, -1, 0}, .up = {0, 0, -1}};
  camera.vertical_fov = 1.2f, camera.far_plane = 70'000;
  const WorldPoint above{double{kBlockSide} * 50, 60'000, double{kBlockSide} * 50};
  const CullView view{.view = {*make_view(camera, 1280, 1280), above}};
  InstanceCuller culler;
  InstanceCullResult seen;
  for (auto _ : state) benchmark::DoNotOptimize(seen = *culler.cull(city.instances, view));
  state.counters["visible"] = static_cast<double>(seen.objects);
  if (seen.objects != city.instances.objects()) state.SkipWithError("a wrong answer");
}

BENCHMARK_CAPTURE(instances, quarters, true)->Name("instances/quarters")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plain, quarters, true)->Name("plain/quarters")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(instances, turned, false)->Name("instances/turned")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plain, turned, false)->Name("plain/turned")->Unit(benchmark::kMicrosecond);
BENCHMARK(everything)->Name("instances/everything")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sightline::benchmarks
