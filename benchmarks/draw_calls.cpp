// Twenty million triangles in cells: how long that takes to build, how much memory, and what a cull costs
// from among them. Each answer is checked: a build that lost a triangle, or a near view that draws nothing,
// fails.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

namespace sightline {
namespace {

Scene& twenty_million() {
  static Scene scene = generate_world("soup?triangles=20000000&per-object=1000&size=2000&edge=1.5");
  return scene;
}

std::unique_ptr<Method> held;
std::string held_name;

Method& method_named(const std::string& name) {
  if (held_name != name) {
    held.reset();
    held = create_method(name, twenty_million());
    held_name = name;
  }
  return *held;
}

double peak_gib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1024 * 1024);
}

void build(benchmark::State& state, const std::string& name) {
  twenty_million();
  for (auto _ : state) {
    held_name.clear();
    Method& method = method_named(name);
    if (method.geometry()->sources.size() < 20000000) state.SkipWithError("triangles are missing");
    state.counters["method_GiB"] = static_cast<double>(method.geometry()->bytes) / (1 << 30);
  }
  state.counters["peak_GiB_with_scene"] = peak_gib();
}

void cull(benchmark::State& state, const std::string& name, float far_plane) {
  Method& method = method_named(name);
  const View view = *make_view({.eye = {0, 0, 0}, .far_plane = far_plane}, 1280, 720);
  Frame frame;
  cull(method, view, frame);
  for (auto _ : state) cull(method, view, frame);
  if (frame.visible.empty()) state.SkipWithError("nothing is drawn");
  state.counters["calls"] = static_cast<double>(frame.stats.draw_calls);
  state.counters["triangles"] = static_cast<double>(frame.stats.triangles);
}

// An object of a thousand triangles to and fro.
void move_one(benchmark::State& state, const std::string& name) {
  Method& method = method_named(name);
  const std::array<ObjectId, 1> moved{7};
  float way = 1;
  for (auto _ : state) {
    Affine transform = twenty_million().transform[7];
    transform.rows[0].w += std::exchange(way, -way);
    twenty_million().move_object(7, transform);
    method.update(moved);
  }
  const Box box = twenty_million().bounds[7];
  Frame frame;
  cull(method, *make_view({.eye = {box.min.x, box.min.y, box.max.z + 50}}, 640, 360), frame);
  if (std::ranges::find(frame.visible, ObjectId{7}) == frame.visible.end())
    state.SkipWithError("what moved is not drawn");
}

void register_all() {
  for (const std::string name :
       {"drawcall-wise-octree?height=6&least=11&cells=tight", "zhang-octree?height=6&least=11&cells=tight",
        "zhang-kd-tree?height=6&least=11&cells=tight", "cluster-cone?size=128"}) {
    benchmark::RegisterBenchmark(("build/" + name).c_str(), build, name)
        ->Iterations(1)
        ->Unit(benchmark::kSecond);
    for (const float far_plane : {200.0f, 4000.0f}) {
      benchmark::RegisterBenchmark(
          (far_plane < 1000 ? "cull_near/" + name : "cull_all_the_way/" + name).c_str(), cull, name,
          far_plane)
          ->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark(("move_one/" + name).c_str(), move_one, name)->Unit(benchmark::kMillisecond);
  }
}

const int kRegistered = (register_all(), 0);

}  // namespace
}  // namespace sightline
