// Culling on your own threads: a job system is one function, here of a small pool.
#include <atomic>
#include <barrier>
#include <cstdio>
#include <thread>
#include <vector>

#include <sightline/sightline.hpp>

// Two threads that take jobs one by one, beside the one that brings them.
struct Pool {
  // What the library calls.
  static void run(void* user, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
    auto& pool = *static_cast<Pool*>(user);
    pool.job = job, pool.data = data, pool.count = count, pool.next = 0;
    pool.work();
  }
  ~Pool() { stop = true, start.arrive_and_wait(); }

  bool work() {
    start.arrive_and_wait();
    if (stop) return false;
    for (std::uint32_t i = next++; i < count; i = next++) job(data, i);
    end.arrive_and_wait();
    return true;
  }
  void serve() {
    while (work()) continue;
  }

  std::barrier<> start{3}, end{3};
  std::atomic<std::uint32_t> next = 0;
  bool stop = false;
  std::uint32_t count = 0;
  void (*job)(void*, std::uint32_t);
  void* data;
  std::jthread first{&Pool::serve, this}, second{&Pool::serve, this};
};

int main() {
  std::vector<sightline::Box> boxes;
  for (int i = 0; i < 100'000; ++i) {
    const float x = static_cast<float>(i % 400) * 5 - 1000, z = static_cast<float>(i / 400) * -5;
    boxes.push_back({{x - 1, 0, z - 1}, {x + 1, 2, z + 1}});
  }
  sightline::World world;
  std::vector<sightline::Handle> handles(boxes.size());
  const auto camera = sightline::make_view({.eye = {0, 2, 10}}, 1280, 720);
  if (!camera || !world.insert(boxes, handles)) return 2;
  const sightline::CullView view{.view = {*camera, {}}};
  Pool pool;
  sightline::Culler culler;
  for (const auto& options : {sightline::CullOptions{}, {.jobs = {&Pool::run, &pool, 3}}}) {
    std::vector<std::uint32_t> ids(sightline::cull_capacity(world, options));
    const auto drawn = culler.cull(world, {&view, 1}, options, {ids, {}});
    if (!drawn) return std::fprintf(stderr, "%s\n", drawn.error().message()), 2;
    std::printf("%u jobs: draw %zu of %zu boxes\n", options.jobs.threads, drawn->count, world.size());
  }
}
