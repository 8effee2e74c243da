// A mapped snapshot: how long its first view takes, and a flight over a hundred million boxes of which a
// small part is in memory at a time. 156,000 boxes a sector of 3.2 km.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include <sightline/snapshot.hpp>

#include "library/geometry/linear.hpp"
#include "world_case.hpp"

namespace sightline::benchmarks {
namespace {

constexpr double kSector = 3200;
using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

// Bytes of memory that are no file's.
std::size_t anonymous_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "RssAnon:") return status >> word, std::stoull(word) << 10;
  return 0;
}

// Boxes on a square of sectors, saved to a file that is mapped and already has no name.
class Country {
public:
  Country(int side, std::size_t a_sector) : side(side), objects(a_sector * side * side) {
    std::string path = "/tmp/sightline-XXXXXX";
    const int file = mkstemp(path.data());
    unlink(path.c_str());
    {
      const World world = made(a_sector);
      const SnapshotSink sink{[](void* user, std::span<const std::byte> bytes) {
                                const int to = *static_cast<const int*>(user);
                                while (!bytes.empty()) {
                                  const ssize_t some = write(to, bytes.data(), bytes.size());
                                  if (some <= 0) return false;
                                  bytes = bytes.subspan(static_cast<std::size_t>(some));
                                }
                                return true;
                              },
                              const_cast<int*>(&file)};
      or_throw(save(world, sink));
    }
    malloc_trim(0);
    const auto size = static_cast<std::size_t>(lseek(file, 0, SEEK_END));
    void* at = mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (at != MAP_FAILED) bytes = {static_cast<const std::byte*>(at), size};
  }
  ~Country() { munmap(const_cast<std::byte*>(bytes.data()), bytes.size()); }
  Country(const Country&) = delete;
  Country& operator=(const Country&) = delete;

  int side;
  std::size_t objects;
  std::span<const std::byte> bytes;

private:
  World made(std::size_t a_sector) const {
    scene::Random random(1);
    World world;
    std::vector<WorldBox> boxes(a_sector);
    std::vector<Handle> handles(a_sector);
    for (int s = 0; s < side * side; ++s) {
      const double x = s % side * kSector, z = s / side * kSector;
      for (WorldBox& box : boxes) {
        const Vec3 at = random.inside({{-1598, -50, -1598}, {1598, 50, 1598}}),
                   half{random.between(0.1f, 3), random.between(0.1f, 3), random.between(0.1f, 3)};
        box = {{x + at.x - half.x, at.y - half.y, z + at.z - half.z},
               {x + at.x + half.x, at.y + half.y, z + at.z + half.z}};
      }
      or_throw(world.insert(boxes, handles));
    }
    return world;
  }
};

CullView from_the_ground(double x, double z, float heading) {
  return {.view = {looking(heading, 1), {x, 0, z}}};
}

// 10 M boxes on 64 sectors; the views look from a sector's middle and from where four meet.
void first_view(benchmark::State& state, double sectors_from_the_corner) {
  static const Country country(8, 156'250);
  const double at = sectors_from_the_corner * kSector;
  const CullView view = from_the_ground(at, at, 0.3f);
  double opening = 0, sectors = 0, loaded = 0, visible = 0;
  for (auto _ : state) {
    const auto begun = Clock::now();
    World world;
    Result<WorldStream> stream = WorldStream::open(country.bytes, world);
    if (!stream) return state.SkipWithError(stream.error().message());
    opening = milliseconds_since(begun);
    const auto opened = Clock::now();
    const StreamReport report = *stream->bring_in({&view, 1});
    std::vector<ObjectId> ids(cull_capacity(world));
    Culler culler;
    const CullResult seen = *culler.cull(world, view, ids);
    state.SetIterationTime(milliseconds_since(opened) / 1000);
    if (report.missing + report.damaged > 0) return state.SkipWithError("sectors in view are missing");
    sectors = static_cast<double>(report.in), loaded = static_cast<double>(world.size());
    visible = static_cast<double>(seen.count);
  }
  state.counters["open_ms"] = opening;
  state.counters["sectors"] = sectors, state.counters["loaded"] = loaded;
  state.counters["visible"] = visible;
}

// How many boxes of the world that the view surely sees are not among those culled.
std::size_t missed(const World& world, const CullView& view, std::span<const ObjectId> seen) {
  std::vector<bool> is_seen(world.id_limit());
  for (const ObjectId id : seen) is_seen[id] = true;
  const WorldPoint& origin = view.view.origin;
  const glm::dmat4 rows = glm::transpose(geometry::to_double(view.view.view.eye_to_clip) *
                                         geometry::to_double(view.view.view.world_to_eye));
  std::size_t missed = 0;
  for (std::size_t i = 0; i < world.id_limit(); ++i) {
    const Handle handle = world.handle(static_cast<ObjectId>(i));
    if (is_seen[i] || !world.contains(handle)) continue;
    const WorldBox b = world.box(handle);
    bool inside = true;
    for (const glm::dvec4& plane : {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                    rows[3] - rows[1], rows[2], rows[3] - rows[2]}) {
      const glm::dvec4 corner((plane.x >= 0 ? b.max.x : b.min.x) - origin.x,
                              (plane.y >= 0 ? b.max.y : b.min.y) - origin.y,
                              (plane.z >= 0 ? b.max.z : b.min.z) - origin.z, 1);
      inside = inside && glm::dot(plane, corner) >= 0;
    }
    missed += inside;
  }
  return missed;
}

// A frame of 4 ms every 20 m, 40 km long, while another thread reads: 100 M boxes on 625 sectors,
// 512 MiB of them in memory.
void flight(benchmark::State& state) {
  static const Country country(25, 160'000);
  constexpr std::size_t kBudget = std::size_t{512} << 20;
  constexpr double kStep = 20, kLength = 40'000;
  for (auto _ : state) {
    World world;
    const auto begun = Clock::now();
    Result<WorldStream> stream = WorldStream::open(country.bytes, world);
    if (!stream) return state.SkipWithError(stream.error().message());
    state.counters["open_ms"] = milliseconds_since(begun);
    std::vector<ObjectId> ids(20'000'000);
    std::fill(ids.begin(), ids.end(), 0);
    Culler culler;
    const std::size_t before = anonymous_memory();
    std::atomic<bool> landed{false};
    std::thread reader([&] {
      while (!landed)
        if (!stream->work()) std::this_thread::sleep_for(std::chrono::microseconds(200));
    });
    double frames = 0, complete = 0, most = 0, grown = 0, lost = 0, checked = 0, total = 0;
    std::vector<double> updates;
    for (double along = 0; along < kLength; along += kStep, ++frames) {
      const auto frame = Clock::now();
      const double x = 12 * kSector + 2000 * std::sin(along / 5000), z = 20 * kSector - along;
      const CullView view = from_the_ground(x, z, 0.3f * static_cast<float>(std::cos(along / 5000)));
      const StreamReport report = frames == 0 ? *stream->bring_in({&view, 1}, {.budget = kBudget})
                                              : *stream->update({&view, 1}, {.budget = kBudget});
      updates.push_back(milliseconds_since(frame));
      const CullResult seen = *culler.cull(world, view, ids);
      total += milliseconds_since(frame);
      complete += report.missing == 0;
      most = std::max(most, static_cast<double>(report.memory));
      if (report.memory > kBudget) return state.SkipWithError("beyond the budget");
      if (static_cast<int>(frames) % 200 == 0) {
        grown = std::max(grown, static_cast<double>(anonymous_memory()) - static_cast<double>(before));
        lost += static_cast<double>(missed(world, view, std::span(ids).first(seen.count))), ++checked;
      }
      const double rest = 4 - milliseconds_since(frame);
      if (rest > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(rest));
    }
    landed = true;
    reader.join();
    updates.erase(updates.begin());  // that of the first view
    std::sort(updates.begin(), updates.end());
    state.SetIterationTime(total / frames / 1000);
    constexpr double kMiB = 1 << 20;
    state.counters["budget_MiB"] = kBudget / kMiB, state.counters["most_MiB"] = most / kMiB;
    state.counters["grown_MiB"] = grown / kMiB;
    state.counters["frames"] = frames, state.counters["complete"] = complete;
    state.counters["missed"] = lost, state.counters["checked"] = checked;
    state.counters["update_p99_ms"] = updates[updates.size() * 99 / 100];
    state.counters["update_worst_ms"] = updates.back();
    if (lost > 0) state.SkipWithError("a visible box that is loaded was missed");
  }
}

BENCHMARK_CAPTURE(first_view, middle, 4.0)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(first_view, corner, 4.5)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(flight)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline::benchmarks
