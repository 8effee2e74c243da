// native_bench FILE: the same calls as web/bench/bench.mjs, natively, on one thread and with no more than
// SSE4, which is what WebAssembly's SIMD is next to: a name and a median in ms a line. FILE has the boxes,
// the view and the walls.
#include <hwy/targets.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include <sightline/sightline.hpp>

namespace {

using namespace sightline;

struct Input {
  std::uint32_t count = 0, walls = 0;
  View view;
  std::vector<float> boxes, columns, wall_boxes;
};

void read(std::FILE* file, void* to, std::size_t bytes) {
  if (std::fread(to, 1, bytes, file) != bytes) std::fprintf(stderr, "the file is too short\n"), std::exit(1);
}

Input read_input(const char* name) {
  std::FILE* file = std::fopen(name, "rb");
  if (!file) std::perror(name), std::exit(2);
  Input in;
  read(file, &in.count, 4), read(file, &in.walls, 4);
  read(file, in.view.world_to_eye.m.data(), 64), read(file, in.view.eye_to_clip.m.data(), 64);
  in.view.width = 1280, in.view.height = 720;
  for (auto* array : {&in.boxes, &in.columns})
    array->resize(std::size_t{6} * in.count), read(file, array->data(), 4 * array->size());
  in.wall_boxes.resize(std::size_t{6} * in.walls);
  read(file, in.wall_boxes.data(), 4 * in.wall_boxes.size());
  std::fclose(file);
  return in;
}

void require(const Status& status) {
  if (!status) std::fprintf(stderr, "%s\n", status.message()), std::exit(1);
}

// Its median, as a line.
void time(const char* name, const std::function<std::size_t()>& run) {
  std::vector<double> all;
  std::size_t answer = 0;
  for (int round = 0; round < 12; ++round) {
    const auto start = std::chrono::steady_clock::now();
    answer = run();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (round >= 3) all.push_back(took.count());
  }
  std::sort(all.begin(), all.end());
  std::printf("%s,%.6f,%zu\n", name, all[all.size() / 2], answer);
}

void measure(const Input& in) {
  constexpr std::size_t kStride = 6 * sizeof(float);
  const BoxView boxes = BoxView::min_max(in.boxes.data(), kStride, in.count);
  const WorldView seen{in.view, {}};
  World world;
  std::vector<Handle> handles(in.count);
  require(world.insert(boxes, handles));
  Culler culler;
  std::vector<std::uint32_t> ids(std::max<std::size_t>(cull_capacity(world), in.count + kCullPadding));
  std::vector<std::uint8_t> masks(ids.size());
  CullView view;
  view.view = seen;
  time("World.cull", [&] { return culler.cull(world, {&view, 1}, {}, {ids, masks})->count; });
  const float* c = in.columns.data();
  const std::size_t n = in.count;
  const BoxView columns = BoxView::arrays(c, c + n, c + 2 * n, c + 3 * n, c + 4 * n, c + 5 * n, n);
  time("cullBoxes", [&] { return *cull_boxes(make_frustum(in.view), columns, ids); });
  OcclusionBuffer buffer;
  const BoxView walls = BoxView::min_max(in.wall_boxes.data(), kStride, in.walls);
  time("occluders", [&] {
    require(buffer.begin(seen, {Coverage::centres}));
    require(buffer.draw_boxes(walls));
    return std::size_t{in.walls};
  });
  const std::size_t asked = std::min<std::size_t>(in.count, 20'000);
  const BoxView some = BoxView::min_max(in.boxes.data(), kStride, asked);
  time("queries", [&] {
    require(buffer.may_see(some, {masks.data(), asked}));
    return static_cast<std::size_t>(
        std::count(masks.begin(), masks.begin() + static_cast<std::ptrdiff_t>(asked), 1));
  });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "usage: native_bench FILE\n"), 2;
  hwy::SetSupportedTargetsForTest(HWY_SSE4);
  measure(read_input(arguments[1]));
  return 0;
}
