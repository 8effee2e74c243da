// Occlusion in one call, by any number of jobs.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <sightline/world.hpp>

#include "support/run_threads.hpp"
#include "support/solid_boxes.hpp"
#include "support/streets_and_rooms.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using namespace test;

TEST(AutomaticJobs, GiveTheSameBitsForAnyNumber) {
  const SolidBoxes scene(town(5, 12));
  std::vector<std::vector<Culled>> answers;
  for (const std::uint32_t threads : {1u, 2u, 8u}) {
    Culler culler;
    CullOptions options = automatic(3000);
    if (threads > 1) options.jobs = {run_threads, nullptr, threads};
    std::vector<Culled> frames;
    for (int frame = 0; frame < 24; ++frame) {
      const float t = static_cast<float>(frame);
      const View camera = looking({20, 2, 450 - t}, heading(0.02f * t)),
                 other = looking({20.1f, 2, 450 - t}, heading(0.02f * t + 0.4f));
      const std::array views{CullView{.view = {camera, {}}}, CullView{.view = {other, {}}},
                             CullView{.view = {camera, {}}}};
      frames.push_back(cull_with(culler, scene.world, views, options, frame % 3 != 0));
    }
    answers.push_back(std::move(frames));
  }
  std::size_t dropped = 0;
  for (std::size_t frame = 0; frame < answers[0].size(); ++frame) {
    dropped += answers[0][frame].result.culled_occlusion;
    for (std::size_t k = 1; k < answers.size(); ++k) {
      ASSERT_EQ(answers[k][frame].ids, answers[0][frame].ids);
      ASSERT_EQ(answers[k][frame].masks, answers[0][frame].masks);
      ASSERT_EQ(answers[k][frame].result.cost, answers[0][frame].result.cost);
    }
  }
  EXPECT_GT(dropped, 1000u);
}

TEST(AutomaticJobs, DrawPartsOfALevelAlike) {
  const Level level;
  std::vector<Culled> first;
  for (const std::uint32_t threads : {1u, 2u, 8u}) {
    Culler culler;
    CullOptions options = automatic(1000);
    if (threads > 1) options.jobs = {run_threads, nullptr, threads};
    Random random(8);
    for (std::size_t frame = 0; frame < 20; ++frame) {
      const CullView view{.view = {Level::from(random), {}}};
      const Culled seen = cull_with(culler, level.world, {&view, 1}, options);
      if (threads == 1) {
        first.push_back(seen);
        continue;
      }
      ASSERT_EQ(seen.ids, first[frame].ids);
      ASSERT_EQ(seen.result.cost, first[frame].result.cost);
    }
  }
}

}  // namespace
}  // namespace sightline
