#include <sightline/tbb.hpp>

#include <gtest/gtest.h>

#include "support/cull.hpp"
#include "workbench/scene/random.hpp"

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SIGHTLINE_TSAN
#endif
#endif

namespace sightline {
namespace {

TEST(Tbb, CullsTheSameOnItsThreads) {
#ifdef SIGHTLINE_TSAN
  GTEST_SKIP() << "Debian's oneTBB is not built for ThreadSanitizer, which cannot see it wait";
#endif
  scene::Random random(3);
  World world;
  std::vector<WorldBox> boxes(30000);
  for (WorldBox& b : boxes) {
    const Vec3 at = random.inside({{-500, 0, -500}, {500, 30, 500}});
    b = {{at.x - 1.0, at.y - 1.0, at.z - 1.0}, {at.x + 1.0, at.y + 1.0, at.z + 1.0}};
  }
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  const WorldView view{*make_view(Camera{.eye = {0, 5, 0}}, 1280, 720), {}};
  std::vector<ObjectId> alone(cull_capacity(world));
  alone.resize(test::cull(world, view, alone).count);
  Culler culler;
  EXPECT_GT(alone.size(), 1000u);
  for (const std::uint32_t threads : {0u, 1u, 2u, 8u, 1000u}) {
    const CullOptions options{.jobs = tbb_jobs(threads)};
    EXPECT_GE(options.jobs.threads, 1u);
    EXPECT_LE(options.jobs.threads, kMaxJobs);
    std::vector<ObjectId> visible(cull_capacity(world, options));
    visible.resize(test::cull(culler, world, test::cull_views({&view, 1}), visible, {}, options).count);
    EXPECT_EQ(visible, alone) << threads << " threads";
  }
}

}  // namespace
}  // namespace sightline
