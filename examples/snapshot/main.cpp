// A flight over a country of a million houses, of which a sixth is in memory at a time: another thread reads
// what comes next.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

#include <sightline/sightline.hpp>

// Where the bytes go: here into memory, in an engine to a file that is mapped afterwards.
bool append(void* user, std::span<const std::byte> bytes) {
  auto& file = *static_cast<std::vector<std::byte>*>(user);
  return file.insert(file.end(), bytes.begin(), bytes.end()), true;
}

std::vector<std::byte> make_country() {
  std::vector<sightline::Box> houses(1'000'000);
  for (std::size_t i = 0; i < houses.size(); ++i) {
    const float x = float(i % 1000) * 32, z = float(i / 1000) * -32;
    houses[i] = {{x, 0, z}, {x + 8, 4 + float(i % 7), z + 12}};
  }
  sightline::World country;
  std::vector<sightline::Handle> handles(houses.size());
  std::vector<std::byte> file;
  if (!country.insert(sightline::BoxView(houses), handles) || !save(country, {append, &file})) return {};
  return file;
}

int main() {
  const std::vector<std::byte> file = make_country();
  sightline::World world;
  auto stream = sightline::WorldStream::open(file, world);
  if (!stream) return std::fprintf(stderr, "%s\n", stream.error().message()), 2;

  std::atomic<bool> landed{false};
  std::thread reader([&] {
    while (!landed)
      if (!stream->work()) std::this_thread::yield();
  });
  sightline::Culler culler;
  std::vector<std::uint32_t> ids;
  std::size_t seen = 0, most = 0, frames = 0, whole = 0;
  for (float along = 0; along < 30'000; along += 50, ++frames) {
    const sightline::Camera camera{.eye = {16'000, 30, -along}, .far_plane = 2000};
    const sightline::CullView view{.view = {*sightline::make_view(camera, 1920, 1080), {}}};
    const sightline::StreamOptions options{.budget = 10u << 20};
    const auto report =
        frames == 0 ? stream->bring_in({&view, 1}, options) : stream->update({&view, 1}, options);
    if (!report) return 2;
    ids.resize(sightline::cull_capacity(world));
    seen += culler.cull(world, view, ids)->count;
    most = std::max(most, report->memory), whole += report->missing == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // here: draw
  }
  landed = true;
  reader.join();
  std::printf("%zu frames, %zu houses a frame, never more than %zu of %zu KiB, all there in %zu frames\n",
              frames, seen / frames, most >> 10, file.size() >> 10, whole);
}
