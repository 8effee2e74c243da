// A forest drawn by chunk: an instance buffer in the world's order, and which parts of it to draw each frame.
#include <sightline/sightline.hpp>

#include <cstdio>
#include <random>
#include <vector>

int main() {
  std::mt19937 random(1);
  const auto between = [&](float low, float high) {
    return low + (high - low) * float(random()) / 4294967296.0f;
  };
  std::vector<sightline::Box> trees(100'000);
  for (sightline::Box& tree : trees) {
    const float x = between(-1000, 1000), z = between(-1000, 1000), height = between(3, 20);
    tree = {{x - 2, 0, z - 2}, {x + 2, height, z + 2}};
  }
  sightline::World world;
  std::vector<sightline::Handle> handles(trees.size());
  if (!world.insert(sightline::BoxView(trees), handles)) return 2;

  // What a GPU holds of each tree, slot by slot: here no more than where it stands.
  std::vector<sightline::Vec3> instance_buffer;
  sightline::ObjectOrder order;
  const auto upload = [&]() -> std::size_t {
    const auto report = order.update(world);
    if (!report) return 0;
    instance_buffer.resize(order.slot_limit());
    for (const auto& [slot, tree] : *report)
      if (tree != sightline::kNoObject) instance_buffer[slot] = trees[tree].min;
    return report->size();
  };

  sightline::RangeCuller culler;
  for (int frame = 1; frame <= 3; ++frame) {
    // A hundred trees are felled, and a hundred planted where they were: they get the same ids.
    const std::span felled = std::span(handles).first(frame == 1 ? 0 : 100);
    if (!world.remove(felled)) return 2;
    if (!world.insert(sightline::BoxView(std::span(trees).first(felled.size())), felled)) return 2;
    const std::size_t uploaded = upload();
    const auto view = sightline::make_view({.eye = {0, 20, 0}, .far_plane = 900}, 1920, 1080);
    if (!view) return 2;
    const auto exact = culler.cull(world, order, {.view = {*view, {}}});
    if (!exact) return 2;
    const std::size_t trees_in_view = exact->objects, ranges = exact->ranges.size();
    const auto seen = culler.cull(world, order, {.view = {*view, {}}}, {.whole_chunks = true});
    if (!seen) return 2;
    for (const auto& [first, count] : seen->ranges) {
      // Here: draw `count` instances, from `first` on.
      if (first + count > instance_buffer.size()) return 2;
    }
    std::printf("frame %d: %zu slots uploaded; %zu trees in %zu ranges, or %zu in %zu of whole chunks\n",
                frame, uploaded, trees_in_view, ranges, std::size_t(seen->objects), seen->ranges.size());
  }
}
